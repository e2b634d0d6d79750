//! The words, indices and names of statements.

use memchr::memchr;

use crate::format::read::non_finite::non_finite_prefix;
use crate::index::{MAX_INDEX, NONE};

/// An index within a block: absolute and counted from 0, or relative to the block's
/// first element, whose index [`Self::resolve`] adds.
///
/// ```text
/// bit 31   0: absolute     1: relative, with a bias, so that it can be negative
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct BlockIndex(pub(super) u32);

impl BlockIndex {
    const RELATIVE: u32 = 1 << 31;
    const BIAS: i64 = 1 << 30;

    /// An index of the file, counted from 1, with bit 31 clear.
    #[inline]
    pub(super) const fn absolute(index: u32) -> Self {
        Self(index - 1)
    }

    /// An index relative to the block's first element; negative in earlier blocks.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the bias")]
    fn relative(index: i64) -> Self {
        Self((index + Self::BIAS) as u32 | Self::RELATIVE)
    }

    /// The absolute index if the block's first element has index `base`; negative if
    /// it lies before the first element of the file.
    #[inline]
    pub(super) fn resolve(self, base: usize) -> i64 {
        if self.0 & Self::RELATIVE == 0 {
            i64::from(self.0)
        } else {
            base as i64 + i64::from(self.0 & !Self::RELATIVE) - Self::BIAS
        }
    }
}

/// Reads an index: 1 is the first element of the file, -1 the last of the `count`
/// elements that the block has listed so far.
///
/// # Errors
/// Fails if it is 0, not a whole number, or too large; the message follows the word
/// in a sentence.
pub(super) fn parse_index(word: &[u8], count: usize) -> Result<BlockIndex, String> {
    let is_whole = word.strip_prefix(b"-").or(word.strip_prefix(b"+")).unwrap_or(word);
    if is_whole.is_empty() || !is_whole.iter().all(u8::is_ascii_digit) {
        return Err("is not a whole number".into());
    }
    let text = std::str::from_utf8(word).map_err(|_| "is not a whole number".to_owned())?;
    let Ok(index) = text.parse::<i64>() else {
        return Err("is too large for an index".into());
    };
    let limit = MAX_INDEX as i64;
    match index {
        0 => Err("has index 0; indices count from 1".into()),
        // Past every possible count: the merge reports it.
        1.. => Ok(BlockIndex::absolute(u32::try_from(index.min(limit + 1)).unwrap_or(NONE))),
        _ if index < -limit => Err("reaches before the first vertex".into()),
        _ => Ok(BlockIndex::relative(count as i64 + index)),
    }
}

/// The keyword of a statement, and the text after it.
pub(super) fn split_keyword(text: &[u8]) -> (&[u8], &[u8]) {
    let end = text.iter().position(u8::is_ascii_whitespace).unwrap_or(text.len());
    (&text[..end], text[end..].trim_ascii_start())
}

/// Keywords that numbers or indices follow.
const OF_NUMBERS: [&[u8]; 8] = [b"v", b"vt", b"vn", b"vp", b"f", b"fo", b"l", b"p"];

/// Keywords that names follow, and `s`.
const OF_NAMES: [&[u8]; 5] = [b"g", b"o", b"s", b"usemtl", b"mtllib"];

/// The keyword that `keyword` is when its capitals are small letters, if that is one of a
/// statement; `None` if it has no capitals. The format has none, but some programs write
/// `V` and `F`, and no other program gives these words a meaning of their own.
pub(super) fn without_capitals(keyword: &[u8]) -> Option<&'static [u8]> {
    if !keyword.iter().any(u8::is_ascii_uppercase) {
        return None;
    }
    let mut known = OF_NUMBERS.iter().chain(&OF_NAMES);
    known.find(|known| known.eq_ignore_ascii_case(keyword)).copied()
}

/// Whether a line is a statement, if it does not continue another one: a keyword, and after it
/// a number or a name as it needs.
pub(super) fn begins_statement(line: &[u8]) -> bool {
    let (keyword, rest) = split_keyword(line);
    match rest.first() {
        Some(first) if OF_NUMBERS.contains(&keyword) => {
            first.is_ascii_digit() || b"+-.".contains(first)
        }
        Some(_) => OF_NAMES.contains(&keyword),
        None => false,
    }
}

/// The text before a comment. The `#` of a number such as `1.#INF` begins none.
pub(super) fn without_comment(text: &[u8]) -> &[u8] {
    let mut from = 0;
    while let Some(found) = memchr(b'#', &text[from..]) {
        let at = from + found;
        let before = &text[..at];
        let word = before.iter().rposition(u8::is_ascii_whitespace).map_or(0, |blank| blank + 1);
        match non_finite_prefix(&text[word..]) {
            Some((_, length)) if word + length > at => from = word + length,
            _ => return before,
        }
    }
    text
}

/// The words of a text.
pub(super) fn words(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
}

/// A name, which may hold blanks; if it is not UTF-8 it is read as Latin-1.
pub(super) fn name_of(rest: &[u8]) -> String {
    let rest = rest.trim_ascii();
    std::str::from_utf8(rest)
        .map_or_else(|_| rest.iter().copied().map(char::from).collect(), str::to_owned)
}

/// The number of a smoothing group; 0 for `off` and all other words.
pub(super) fn smoothing_group(rest: &[u8]) -> u32 {
    std::str::from_utf8(rest.trim_ascii()).ok().and_then(|text| text.parse().ok()).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_count_from_one_or_back_from_the_latest() {
        let resolved = |word: &str, count, base| {
            parse_index(word.as_bytes(), count).map(|index| index.resolve(base))
        };
        assert_eq!(resolved("1", 5, 100), Ok(0));
        assert_eq!(resolved("+7", 5, 100), Ok(6));
        assert_eq!(resolved("-1", 5, 100), Ok(104));
        assert_eq!(resolved("-6", 5, 100), Ok(99), "in the block before");
        assert_eq!(resolved("-106", 5, 100), Ok(-1), "before the first");
        assert_eq!(resolved("4000000000", 5, 100), Ok(MAX_INDEX as i64));
        for word in ["0", "", "-", "1.5", "x", "99999999999999999999", "--1", "-1073741824"] {
            assert!(parse_index(word.as_bytes(), 5).is_err(), "{word}");
        }
        assert_ne!(BlockIndex::relative(MAX_INDEX as i64 - 1).0, NONE);
    }

    #[test]
    fn comments_end_a_statement_and_numbers_that_are_not_finite_do_not() {
        for (text, before) in [
            ("1 2 3 # up", "1 2 3 "),
            ("1 2 3.#up", "1 2 3."),
            ("1.#INF -1.#IND00 0#1.#INF", "1.#INF -1.#IND00 0"),
            ("1.#QNAN # 1.#INF", "1.#QNAN "),
            ("#1.#INF", ""),
            ("1.#INF#", "1."),
            ("1.#J", "1.#J"),
            ("1 2", "1 2"),
        ] {
            assert_eq!(without_comment(text.as_bytes()), before.as_bytes(), "{text}");
        }
    }

    #[test]
    fn statements_are_known_by_their_keyword_and_what_follows() {
        for line in ["f 1 2 3", "v -1 .5 0", "l\t1 2", "vn .5 0 0", "usemtl red", "g a b", "s off"]
        {
            assert!(begins_statement(line.as_bytes()), "{line}");
        }
        for line in ["", "f", "g", "v one", "1 2 3", "face 1", "# f 1 2 3", "of 3 parts", "-1 -2"] {
            assert!(!begins_statement(line.as_bytes()), "{line}");
        }
        assert_eq!(without_capitals(b"VN"), Some(&b"vn"[..]));
        assert_eq!(without_capitals(b"UseMtl"), Some(&b"usemtl"[..]));
        assert_eq!((without_capitals(b"f"), without_capitals(b"FACE")), (None, None));
    }

    #[test]
    fn names_keep_their_blanks_and_old_letters() {
        assert_eq!(name_of(b" a b \t"), "a b");
        assert_eq!(name_of(b"gr\xfcn"), "gr\u{fc}n");
        assert_eq!(split_keyword(b"usemtl  a b"), (&b"usemtl"[..], &b"a b"[..]));
        assert_eq!((smoothing_group(b" 3 "), smoothing_group(b"off")), (3, 0));
    }
}
