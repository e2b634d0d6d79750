//! The header of a PLY file, which describes the rows after it.
//!
//! Source: G. Turk, *The PLY Polygon File Format* (1994). Each line is a statement.
//! Names are slices of the file.
//!
//! ```text
//! ply
//! format ascii 1.0                             encoding
//! comment ..., obj_info ...                    ignored, except that of our exports
//! element face 12                              12 rows
//!   property uchar red                         one value
//!   property list uchar int vertex_indices     a count, then as many values
//! end_header
//! ```
//!
//! Version 1.0 is the only one; others are refused. A line that begins with another
//! word is left out with a warning, because some exporters forget `comment`. A
//! malformed statement is an error, because the rows would be read wrongly.

use super::super::error::{ReadError, ReadErrorKind};
use super::super::source::Source;
use super::super::words::{Words, quoted};
use super::scalar::Scalar;
use crate::format::edge_classes::STATES_CLASSES;
use crate::report::{Place, Report, WarningCode};

/// The elements that are read; each may come only once.
const READ_ELEMENTS: [&[u8]; 4] = [b"vertex", b"face", b"tristrips", b"edge"];

/// How rows are encoded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    /// Text, one row a line.
    Ascii,
    /// Binary, least significant byte first.
    LittleEndian,
    /// Binary, most significant byte first.
    BigEndian,
}

/// The header of a file.
#[derive(Debug)]
pub(super) struct Header<'a> {
    /// The encoding of the rows.
    pub(super) encoding: Encoding,
    /// The elements, in the order of their rows.
    pub(super) elements: Vec<Element<'a>>,
    /// The offset of the first row in bytes.
    pub(super) end: usize,
    /// The line of the first row, counted from 1.
    pub(super) end_line: u32,
    /// Whether edges have the classes of an export of this program.
    pub(super) states_classes: bool,
}

/// A kind of row, such as a vertex.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Element<'a> {
    /// Its name, such as `vertex`.
    pub(super) name: &'a [u8],
    /// The stated number of rows, which may be wrong.
    pub(super) count: u64,
    /// The values of a row.
    pub(super) properties: Vec<Property<'a>>,
    /// Its line in the header.
    pub(super) line: u32,
}

/// A value or a list of values in a row.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Property<'a> {
    /// Its name, such as `x`.
    pub(super) name: &'a [u8],
    /// The type of the value or values.
    pub(super) kind: Scalar,
    /// The type of a list's length; `None` for a single value.
    pub(super) length: Option<Scalar>,
}

/// Reads the header at the start of the file.
///
/// # Errors
/// Format: not PLY, or an unknown encoding or version. Syntax: a malformed statement.
/// Truncated: `end_header` is missing.
pub(super) fn read_header<'a>(
    source: &Source<'a>,
    report: &mut Report,
) -> Result<Header<'a>, ReadError> {
    let words = Words::new(source.bytes, 0, 1);
    let mut reader =
        HeaderReader { source, words, encoding: None, elements: Vec::new(), states_classes: false };
    if reader.words.take_rest_of_line() != b"ply" {
        let what = "does not begin with a line 'ply', so it is not a PLY file";
        return Err(source.error(ReadErrorKind::Format, Some(Place::Line(1)), what));
    }
    while reader.statement(report)? {}
    let Some(encoding) = reader.encoding else {
        return Err(reader.syntax("the header has no line 'format'"));
    };
    reader.words.take_rest_of_line();
    let (end, end_line) = (end_of_header(source.bytes, reader.words.at()), reader.words.line());
    let HeaderReader { elements, states_classes, .. } = reader;
    Ok(Header { encoding, elements, end, end_line, states_classes })
}

/// The offset of the first row, given that of the line after the header.
///
/// If lines end with CR alone, a line feed after the header is the first byte of the
/// rows.
fn end_of_header(bytes: &[u8], end: usize) -> usize {
    let ends_in_return = matches!(bytes, [b'p', b'l', b'y', b'\r', next, ..] if *next != b'\n');
    match bytes.get(..end) {
        Some([.., b'\r', b'\n']) if ends_in_return => end - 1,
        _ => end,
    }
}

struct HeaderReader<'s, 'a> {
    source: &'s Source<'a>,
    words: Words<'a>,
    encoding: Option<Encoding>,
    elements: Vec<Element<'a>>,
    states_classes: bool,
}

impl<'a> HeaderReader<'_, 'a> {
    /// Reads one line with its end; returns false at `end_header`, whose line end is
    /// not read.
    fn statement(&mut self, report: &mut Report) -> Result<bool, ReadError> {
        match self.words.word() {
            None if self.words.left().is_empty() => {
                let what = "the file ends within its header: 'end_header' is missing";
                return Err(self.error(ReadErrorKind::Truncated, what));
            }
            None | Some(b"obj_info") => {}
            Some(b"comment") => {
                self.states_classes |= self.words.take_rest_of_line() == STATES_CLASSES.as_bytes();
                return Ok(true);
            }
            Some(b"format") => self.encoding = Some(self.format()?),
            Some(b"element") => self.element()?,
            Some(b"property") => self.property()?,
            Some(b"end_header") => return Ok(false),
            Some(word) => {
                report.warn(WarningCode::Syntax, Some(Place::Line(self.words.line())), || {
                    format!(
                        "header lines do not begin with {}; the line was left out",
                        quoted(word)
                    )
                });
            }
        }
        self.words.take_rest_of_line();
        Ok(true)
    }

    fn format(&mut self) -> Result<Encoding, ReadError> {
        let encoding = self.word("an encoding")?;
        let version = self.word("a version")?;
        let what = match (encoding, version) {
            (b"ascii", b"1.0") => return Ok(Encoding::Ascii),
            (b"binary_little_endian", b"1.0") => return Ok(Encoding::LittleEndian),
            (b"binary_big_endian", b"1.0") => return Ok(Encoding::BigEndian),
            (_, b"1.0") => format!(
                "the encoding {} is not supported; use ascii, binary_little_endian or \
                 binary_big_endian",
                quoted(encoding)
            ),
            _ => format!("the version {} is not supported; use 1.0", quoted(version)),
        };
        Err(self.error(ReadErrorKind::Format, what))
    }

    fn element(&mut self) -> Result<(), ReadError> {
        let name = self.word("a name")?;
        let count = self.word("a count")?;
        let Some(count) = std::str::from_utf8(count).ok().and_then(|word| word.parse().ok()) else {
            return Err(self.syntax(format!("{} is not a count of rows", quoted(count))));
        };
        let is_repeated = || self.elements.iter().any(|element| element.name == name);
        if READ_ELEMENTS.contains(&name) && is_repeated() {
            return Err(self.syntax(format!("the element {} occurs twice", quoted(name))));
        }
        let line = self.words.line();
        self.elements.push(Element { name, count, properties: Vec::new(), line });
        Ok(())
    }

    fn property(&mut self) -> Result<(), ReadError> {
        let (length, kind) = match self.word("a type")? {
            b"list" => {
                let length = self.word("the type of its length")?;
                (Some(self.scalar(length)?), self.word("a type")?)
            }
            kind => (None, kind),
        };
        if length.is_some_and(Scalar::is_float) {
            return Err(self.syntax("the length of a list cannot be a float"));
        }
        let kind = self.scalar(kind)?;
        let name = self.word("a name")?;
        match self.elements.last_mut() {
            Some(element) => element.properties.push(Property { name, kind, length }),
            None => return Err(self.syntax("a property before the first element")),
        }
        Ok(())
    }

    fn scalar(&self, name: &[u8]) -> Result<Scalar, ReadError> {
        Scalar::of_name(name).ok_or_else(|| self.syntax(format!("{} is not a type", quoted(name))))
    }

    fn word(&mut self, what: &str) -> Result<&'a [u8], ReadError> {
        self.words.word().ok_or_else(|| self.syntax(format!("the line ends before {what}")))
    }

    fn syntax(&self, what: impl Into<String>) -> ReadError {
        self.error(ReadErrorKind::Syntax, what)
    }

    fn error(&self, kind: ReadErrorKind, what: impl Into<String>) -> ReadError {
        self.source.error(kind, Some(Place::Line(self.words.line())), what)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header<'a>(text: &'a str, report: &mut Report) -> Result<Header<'a>, ReadError> {
        read_header(&Source { name: "test", folder: None, bytes: text.as_bytes() }, report)
    }

    #[test]
    fn elements_come_with_their_properties() {
        let text = "ply\r\nformat binary_big_endian 1.0\r\ncomment by hand\r\nelement vertex 8\r\n\
                    property float x\r\nelement face 6\r\nobj_info 1\r\nproperty list uint8 int a\r\n\
                    end_header \r\n..";
        let mut report = Report::default();
        let header = header(text, &mut report).unwrap();
        assert_eq!(header.encoding, Encoding::BigEndian);
        assert_eq!((&text[header.end..], header.end_line), ("..", 10));
        let [vertex, face] = &header.elements[..] else { panic!("{header:?}") };
        assert_eq!((vertex.name, vertex.count, vertex.line), (&b"vertex"[..], 8, 4));
        let x = Property { name: b"x", kind: Scalar::F32, length: None };
        assert_eq!(vertex.properties, [x]);
        let list = Property { name: b"a", kind: Scalar::I32, length: Some(Scalar::U8) };
        assert_eq!(face.properties, [list]);
        assert!(report.warnings().is_empty());
    }

    #[test]
    fn rows_begin_after_one_line_end() {
        for (text, rows) in [
            ("ply\nformat ascii 1.0\nend_header\n\n", "\n"),
            ("ply\nformat ascii 1.0\nend_header\r\n\n", "\n"),
            ("ply\rformat ascii 1.0\rend_header\r\n", "\n"),
            ("ply\r\nformat ascii 1.0\r\nend_header\r\n\r\n", "\r\n"),
            ("ply\nformat ascii 1.0\nend_header", ""),
        ] {
            let header = header(text, &mut Report::default()).unwrap();
            assert_eq!(&text[header.end..], rows, "{text:?}");
        }
    }

    #[test]
    fn lines_that_are_not_statements_are_left_out() {
        let text = "ply\nformat ascii 1.0\nmade by hand\n\nwith care\nend_header\n";
        let mut report = Report::default();
        header(text, &mut report).unwrap();
        let [warning] = report.warnings() else { panic!("{report:?}") };
        assert_eq!((warning.code, warning.count), (WarningCode::Syntax, 2));
        assert_eq!(warning.place, Some(Place::Line(3)));
    }

    #[test]
    fn malformed_statements_are_errors_with_their_line() {
        use ReadErrorKind::{Format, Syntax, Truncated};
        for (lines, kind, line, what) in [
            ("format ascii 9.9", Format, 2, "the version '9.9' is not supported"),
            ("format binary 1.0", Format, 2, "the encoding 'binary' is not supported"),
            ("format ascii", Syntax, 2, "ends before a version"),
            ("element face 1\nend_header", Syntax, 3, "no line 'format'"),
            ("element", Syntax, 2, "ends before a name"),
            ("element vertex", Syntax, 2, "ends before a count"),
            ("element vertex -1", Syntax, 2, "'-1' is not a count"),
            ("element vertex 1e3", Syntax, 2, "'1e3' is not a count"),
            ("element vertex 99999999999999999999", Syntax, 2, "is not a count"),
            ("element face 1\nelement face 2", Syntax, 3, "'face' occurs twice"),
            ("property float x", Syntax, 2, "before the first element"),
            ("element a 1\nproperty real x", Syntax, 3, "'real' is not a type"),
            ("element a 1\nproperty float", Syntax, 3, "ends before a name"),
            ("element a 1\nproperty list uchar", Syntax, 3, "ends before a type"),
            ("element a 1\nproperty list list int x", Syntax, 3, "'list' is not a type"),
            ("element a 1\nproperty list float int x", Syntax, 3, "cannot be a float"),
            ("format ascii 1.0\nelement a 1", Truncated, 4, "'end_header' is missing"),
        ] {
            let text = format!("ply\n{lines}\n");
            let error = header(&text, &mut Report::default()).unwrap_err();
            let place = Some(Place::Line(line));
            assert_eq!((error.kind, &error.place), (kind, &place), "{text}");
            assert!(error.what.contains(what), "{error}");
        }
        let error = header("PLY\n", &mut Report::default()).unwrap_err();
        assert_eq!(error.kind, Format);
    }

    #[test]
    fn long_headers_take_linear_time() {
        let lines = "element other 1\nproperty float x\n".repeat(100_000);
        let text = format!("ply\nformat ascii 1.0\n{lines}end_header\n");
        let header = header(&text, &mut Report::default()).unwrap();
        assert_eq!(header.elements.len(), 100_000);
    }
}
