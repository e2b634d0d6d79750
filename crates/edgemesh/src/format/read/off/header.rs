//! The keyword of an OFF file, which says what a vertex has.
//!
//! ```text
//! [ST] [C] [N] [4] [n] OFF [BINARY]
//!  |    |   |   |   '-- vertices of any dimension: refused
//!  |    |   |   '------ a fourth, homogeneous coordinate: refused
//!  |    |   '---------- normals
//!  |    '-------------- colors
//!  '------------------- texture coordinates
//! ```
//!
//! The letters may come in any order, as some programs write them. The order of the
//! values is always that of Geomview: position, normal, color, texture coordinates.

use super::super::byte_order_mark::without_mark;
use super::super::error::{ReadError, ReadErrorKind};
use super::super::source::Source;
use super::super::words::{Words, quoted};
use crate::report::Place;

/// The start of a file.
#[derive(Debug)]
pub(super) struct Header<'a> {
    /// What each vertex has.
    pub(super) layout: VertexLayout,
    /// Whether counts, vertices and faces are binary.
    pub(super) is_binary: bool,
    /// A cursor behind the keyword; the counts are next.
    pub(super) rest: Words<'a>,
}

/// What each vertex has besides its position.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct VertexLayout {
    pub(super) has_normal: bool,
    pub(super) has_color: bool,
    pub(super) has_texcoord: bool,
}

/// A keyword and what it says.
#[derive(Debug, Default, PartialEq, Eq)]
struct Keyword {
    layout: VertexLayout,
    /// Whether vertices have a fourth coordinate or a stated dimension.
    has_dimension: bool,
    /// Its length in bytes.
    length: usize,
}

/// Whether the first word that is not a comment is a keyword of OFF.
pub(in crate::format::read) fn begins_with_keyword(head: &[u8]) -> bool {
    let mut words = Words::new(without_mark(head), 0, 1);
    skip_comments(&mut words);
    keyword(words.left()).is_some()
}

/// Reads the keyword, if there is one.
///
/// # Errors
/// Format: the file begins with another word, or its vertices have more than three
/// dimensions.
pub(super) fn read_header<'a>(source: &Source<'a>) -> Result<Header<'a>, ReadError> {
    let start = source.bytes.len() - without_mark(source.bytes).len();
    let mut words = Words::new(source.bytes, start, 1);
    skip_comments(&mut words);
    let fail = |line, what| Err(source.error(ReadErrorKind::Format, Some(Place::Line(line)), what));
    let Some(Keyword { layout, has_dimension, length }) = keyword(words.left()) else {
        let mut first = words.clone();
        if matches!(first.number(), Some(Ok(_))) {
            // Geomview needs no keyword in a file whose name ends in `.off`.
            let layout = VertexLayout::default();
            return Ok(Header { layout, is_binary: false, rest: words });
        }
        let what = "begins neither with the word 'OFF' nor with counts, so it is not an OFF file";
        return fail(words.line(), what.into());
    };
    let line = words.line();
    if has_dimension {
        let word = quoted(words.left().get(..length).unwrap_or_default());
        let what = format!(
            "{word} has vertices of other than three dimensions, which is not supported; \
             save it as OFF with three coordinates a vertex"
        );
        return fail(line, what);
    }
    let mut rest = Words::new(source.bytes, words.at() + length, line);
    let mut second = rest.clone();
    let is_binary = second.word() == Some(b"BINARY");
    if is_binary {
        second.take_rest_of_line();
        rest = second;
    }
    Ok(Header { layout, is_binary, rest })
}

/// Moves to the next word that is not in a comment.
fn skip_comments(words: &mut Words) {
    words.skip_space();
    while words.left().first() == Some(&b'#') {
        words.take_rest_of_line();
        words.skip_space();
    }
}

/// The keyword at the start of `text`. A blank, a count or a comment follows it.
fn keyword(text: &[u8]) -> Option<Keyword> {
    let mut keyword = Keyword::default();
    loop {
        let rest = text.get(keyword.length..)?;
        let layout = &mut keyword.layout;
        let (is_repeated, length) = match rest {
            [b'O' | b'o', b'F' | b'f', b'F' | b'f', ..] => {
                keyword.length += 3;
                let next = text.get(keyword.length);
                let ends = |byte: &u8| {
                    byte.is_ascii_whitespace() || byte.is_ascii_digit() || *byte == b'#'
                };
                return next.is_none_or(ends).then_some(keyword);
            }
            [b'S', b'T', ..] => (std::mem::replace(&mut layout.has_texcoord, true), 2),
            [b'C', ..] => (std::mem::replace(&mut layout.has_color, true), 1),
            [b'N', ..] => (std::mem::replace(&mut layout.has_normal, true), 1),
            [b'4' | b'n', ..] if keyword.length < 8 => {
                keyword.has_dimension = true;
                (false, 1)
            }
            _ => return None,
        };
        if is_repeated {
            return None;
        }
        keyword.length += length;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keywords_say_what_a_vertex_has() {
        for (text, normal, color, texcoord) in [
            ("OFF", false, false, false),
            ("COFF\n", false, true, false),
            ("NOFF ", true, false, false),
            ("STOFF#", false, false, true),
            ("STCNOFF\r\n", true, true, true),
            ("NCSTOFF\n", true, true, true),
            ("OFF8 6 12", false, false, false),
            ("Coff\n", false, true, false),
        ] {
            let found = keyword(text.as_bytes()).unwrap();
            let layout =
                VertexLayout { has_normal: normal, has_color: color, has_texcoord: texcoord };
            assert_eq!((found.layout, found.has_dimension), (layout, false), "{text}");
        }
        for text in ["4OFF\n", "nOFF\n", "C4nOFF\n"] {
            assert!(keyword(text.as_bytes()).unwrap().has_dimension, "{text}");
        }
        for text in ["", "OF", "OFFICE", "off-white", "CCOFF", "NNOFF", "XOFF", "N", "4", "SOFF"] {
            assert_eq!(keyword(text.as_bytes()), None, "{text}");
        }
        assert_eq!(keyword(&[b'4'; 1000]), None);
    }

    #[test]
    fn keywords_come_after_comments() {
        assert!(begins_with_keyword(b"# made by hand\n\n # twice\nOFF\n"));
        assert!(begins_with_keyword(b"\xef\xbb\xbfOFF\n"));
        assert!(!begins_with_keyword(b"# OFF\nv 0 0 0\n"));
        assert!(!begins_with_keyword(b"8 6 12\n"), "needs the name of the file");
    }
}
