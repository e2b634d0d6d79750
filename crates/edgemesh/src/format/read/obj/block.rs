//! Parses a block of an OBJ file as if it were a whole file.
//!
//! Idea: nearly every line is a `v`, `vt`, `vn` or `f` in its plainest form. The
//! plain parser reads those in place, byte by byte. At the first unusual byte it
//! hands the line to the general parser, which joins continued lines, drops
//! comments and splits words. For a plain line both give the same result, which a
//! test checks.

use memchr::memchr2;

use super::statement::{
    BlockIndex, begins_statement, name_of, parse_index, smoothing_group, split_keyword,
    without_capitals, without_comment, words,
};
use crate::format::read::error::ReadErrorKind;
use crate::format::read::firewall::LARGEST_COORDINATE;
use crate::format::read::number::{parse_number, parse_prefix};
use crate::format::read::words::quoted;
use crate::index::{NONE, to_u32};
use crate::model::{Corner, Model, Segment, WHITE};
use crate::report::{Place, Report, WarningCode};

/// The content of a block; its first line is line 1.
#[derive(Debug, Default)]
pub(super) struct ParsedBlock {
    /// Elements and polygons, with [`BlockIndex`]es.
    pub(super) model: Model,
    /// The number of lines.
    pub(super) line_count: u32,
    /// The changes of the state, in order.
    pub(super) changes: Vec<StateChange>,
    /// The `mtllib` statements, with their lines.
    pub(super) libraries: Vec<(String, u32)>,
    /// The warnings.
    pub(super) report: Report,
    /// The error that ended the parsing.
    pub(super) error: Option<BlockError>,
}

/// An error in a line of a block.
#[derive(Debug)]
pub(super) struct BlockError {
    pub(super) kind: ReadErrorKind,
    pub(super) line: u32,
    pub(super) what: String,
}

/// A change of the state that applies to the polygons after it.
#[derive(Debug)]
pub(super) struct StateChange {
    /// The first polygon of the block that has the new state.
    pub(super) polygon: u32,
    /// The first segment of the block that has the new state.
    pub(super) segment: usize,
    pub(super) state: NewState,
}

/// The part of the state that changes, with its new value.
#[derive(Debug)]
pub(super) enum NewState {
    /// The name of a material (`usemtl`).
    Material(String),
    /// The name of a group or object (`g`, `o`).
    Group(String),
    /// The number of a smoothing group, 0 for none (`s`).
    Smoothing(u32),
}

/// Parses `text`, which begins and ends with whole statements.
pub(super) fn parse_block(text: &[u8]) -> ParsedBlock {
    let mut parser =
        Parser { text, at: 0, line: 0, corners: Vec::new(), block: ParsedBlock::default() };
    // Seldom too small: 43 bytes a triangle, and two triangles a vertex.
    parser.block.model.corner_positions.reserve(text.len() / 14);
    parser.block.model.polygon_lines.reserve(text.len() / 42);
    parser.block.model.positions.reserve(text.len() / 84);
    while parser.at < text.len() {
        parser.line = parser.line.saturating_add(1);
        if let Some(next) = parser.plain_line() {
            parser.at = next;
        } else if let Err(error) = parser.any_line() {
            parser.block.error = Some(error);
            break;
        }
    }
    parser.block.line_count = parser.line;
    parser.block
}

struct Parser<'a> {
    text: &'a [u8],
    at: usize,
    /// The line of the byte `at`, counted from 1.
    line: u32,
    /// The corners of the current face.
    corners: Vec<Corner>,
    block: ParsedBlock,
}

/// The plain parser. Each function returns the offset after what it has read, or
/// `None` if the line needs the general parser; it has stored nothing then.
impl Parser<'_> {
    #[inline]
    fn plain_line(&mut self) -> Option<usize> {
        match self.text.get(self.at..self.at + 2)? {
            b"v " => {
                let (position, end) = self.plain_numbers::<3>(self.at + 2)?;
                self.keep_vertex(position, None);
                Some(end)
            }
            b"f " => self.plain_face(),
            b"vn" => {
                let (normal, end) = self.plain_numbers::<3>(self.at + 2)?;
                self.block.model.normals.push(normal.map(attribute));
                Some(end)
            }
            b"vt" => {
                let (texcoord, end) = self.plain_numbers::<2>(self.at + 2)?;
                self.block.model.texcoords.push(texcoord.map(attribute));
                Some(end)
            }
            _ => None,
        }
    }

    #[inline]
    fn plain_numbers<const N: usize>(&self, from: usize) -> Option<([f64; N], usize)> {
        let mut numbers = [0.0; N];
        let mut at = from;
        for number in &mut numbers {
            at = self.after_blanks(at);
            if self.text[at - 1] != b' ' {
                return None;
            }
            let (value, length) = parse_prefix(&self.text[at..])?;
            *number = value;
            at += length;
        }
        Some((numbers, self.line_end(at)?))
    }

    #[inline]
    fn plain_face(&mut self) -> Option<usize> {
        self.corners.clear();
        let mut at = self.at + 1;
        loop {
            let start = self.after_blanks(at);
            if let Some(end) = self.line_end(start) {
                if self.corners.len() < 3 {
                    return None;
                }
                self.block.model.push_polygon(&self.corners, self.line);
                return Some(end);
            }
            if start == at {
                return None;
            }
            let (corner, end) = self.plain_corner(start)?;
            self.corners.push(corner);
            at = end;
        }
    }

    /// `a`, `a/b`, `a//c` or `a/b/c`, counted from 1.
    #[inline]
    fn plain_corner(&self, at: usize) -> Option<(Corner, usize)> {
        let (position, mut at) = self.plain_index(at)?;
        let mut corner = Corner::at(position);
        if self.text.get(at) == Some(&b'/') {
            at += 1;
            if self.text.get(at) != Some(&b'/') {
                (corner.texcoord, at) = self.plain_index(at)?;
            }
            if self.text.get(at) == Some(&b'/') {
                (corner.normal, at) = self.plain_index(at + 1)?;
            }
        }
        Some((corner, at))
    }

    /// One to nine digits, which cannot overflow; 0 is left to the general parser.
    #[inline]
    fn plain_index(&self, from: usize) -> Option<(u32, usize)> {
        let mut index = 0_u32;
        let mut at = from;
        while let Some(digit) = self.text.get(at).map(|byte| byte.wrapping_sub(b'0'))
            && digit < 10
        {
            if at - from == 9 {
                return None;
            }
            index = index * 10 + u32::from(digit);
            at += 1;
        }
        (index > 0).then(|| (BlockIndex::absolute(index).0, at))
    }

    #[inline]
    fn after_blanks(&self, mut at: usize) -> usize {
        while self.text.get(at) == Some(&b' ') {
            at += 1;
        }
        at
    }

    /// The offset after the line end at `at`, if there is one.
    #[inline]
    fn line_end(&self, at: usize) -> Option<usize> {
        match self.text.get(at) {
            None => Some(at),
            Some(b'\n') => Some(at + 1),
            Some(b'\r') if self.text.get(at + 1) == Some(&b'\n') => Some(at + 2),
            Some(b' ') => {
                let after = self.after_blanks(at);
                if self.text.get(after) == Some(&b' ') { None } else { self.line_end(after) }
            }
            _ => None,
        }
    }
}

/// A texture coordinate, or a coordinate of a normal, in 32 bits.
#[expect(clippy::cast_possible_truncation, reason = "an attribute needs no more")]
const fn attribute(number: f64) -> f32 {
    number as f32
}

/// The general parser.
impl Parser<'_> {
    /// Reads the statement at `at`, with its continuation lines.
    fn any_line(&mut self) -> Result<(), BlockError> {
        let first_line = self.line;
        let line = self.next_line();
        let Some(start) = line.strip_suffix(b"\\") else {
            return self.statement(first_line, line);
        };
        let mut joined = start.to_vec();
        while self.at < self.text.len() {
            self.line = self.line.saturating_add(1);
            let line = self.next_line();
            self.warn_of_joined(line);
            joined.push(b' ');
            match line.strip_suffix(b"\\") {
                Some(line) => joined.extend_from_slice(line),
                None => {
                    joined.extend_from_slice(line);
                    break;
                }
            }
        }
        self.statement(first_line, &joined)
    }

    /// Warns if a line that continues the one before looks like a statement, such as a face
    /// behind a comment that ends in the backslash of a path.
    fn warn_of_joined(&mut self, line: &[u8]) {
        if !begins_statement(line) {
            return;
        }
        self.warn(WarningCode::Syntax, self.line, || {
            format!(
                "this line continues the one before, which ends in '\\', so that {} is no \
                 statement; remove the '\\' if it should be one",
                quoted(line)
            )
        });
    }

    /// The line at `at` without surrounding blanks; it ends with LF, CR LF or CR.
    fn next_line<'b>(&mut self) -> &'b [u8]
    where
        Self: 'b,
    {
        let rest = &self.text[self.at..];
        let (line, length) = match memchr2(b'\n', b'\r', rest) {
            None => (rest, rest.len()),
            Some(end) if rest[end..].starts_with(b"\r\n") => (&rest[..end], end + 2),
            Some(end) => (&rest[..end], end + 1),
        };
        self.at += length;
        line.trim_ascii()
    }

    fn statement(&mut self, line: u32, text: &[u8]) -> Result<(), BlockError> {
        let (keyword, rest) = split_keyword(text);
        let keyword = match without_capitals(keyword) {
            Some(known) => {
                self.warn(WarningCode::Syntax, line, || {
                    let [written, known] = [keyword, known].map(String::from_utf8_lossy);
                    format!("'{written}' was read as '{known}'; keywords have small letters")
                });
                known
            }
            None => keyword,
        };
        let values = without_comment(rest);
        match keyword {
            b"v" => self.vertex(line, values)?,
            b"vt" => {
                let texcoord = attributes(values);
                self.block.model.texcoords.push(texcoord);
            }
            b"vn" => {
                let normal = attributes(values);
                self.block.model.normals.push(normal);
            }
            b"f" | b"fo" => self.face(line, values)?,
            b"l" => self.polyline(line, values)?,
            b"s" => self.change(NewState::Smoothing(smoothing_group(values))),
            b"usemtl" => self.change(NewState::Material(name_of(rest))),
            b"g" | b"o" => self.change(NewState::Group(name_of(rest))),
            b"mtllib" => self.block.libraries.push((name_of(rest), line)),
            b"curv" | b"curv2" | b"surf" | b"cstype" | b"vp" | b"deg" | b"bmat" | b"parm"
            | b"trim" | b"hole" | b"end" => {
                self.warn(WarningCode::Unsupported, line, || {
                    let word = String::from_utf8_lossy(keyword);
                    format!("'{word}': free-form curves and surfaces are not supported")
                });
            }
            _ => {}
        }
        Ok(())
    }

    fn change(&mut self, state: NewState) {
        let polygon = to_u32(self.block.model.polygon_count());
        let segment = self.block.model.segments.len();
        self.block.changes.push(StateChange { polygon, segment, state });
    }

    fn warn(&mut self, code: WarningCode, line: u32, message: impl FnOnce() -> String) {
        self.block.report.warn(code, Some(Place::Line(line)), message);
    }

    fn vertex(&mut self, line: u32, values: &[u8]) -> Result<(), BlockError> {
        let mut numbers = [1.0; 6];
        let mut count = 0;
        for (number, word) in numbers.iter_mut().zip(words(values)) {
            match self.number(line, word) {
                Some(value) => *number = value,
                // Whatever follows the position.
                None if count >= 3 => break,
                None => {
                    let what = format!("'{}' is not a number", String::from_utf8_lossy(word));
                    return Err(BlockError { kind: ReadErrorKind::Number, line, what });
                }
            }
            count += 1;
        }
        let [x, y, z, r, g, b] = numbers;
        if count < 3 {
            let what = format!("a vertex needs three numbers, this one has {count}");
            return Err(BlockError { kind: ReadErrorKind::Number, line, what });
        }
        // Four numbers are a point and its weight; six or seven have a color.
        self.keep_vertex(
            [x, y, z],
            (count == 6).then(|| [attribute(r), attribute(g), attribute(b), 1.0]),
        );
        Ok(())
    }

    /// A number; a broken exponent is left out with a warning.
    fn number(&mut self, line: u32, word: &[u8]) -> Option<f64> {
        if let Some(number) = parse_number(word) {
            return Some(number);
        }
        let (number, length) = parse_prefix(word).filter(|(number, _)| number.is_finite())?;
        let is_exponent = matches!(word[length..], [b'+' | b'-', b'e' | b'E', ..]);
        if is_exponent {
            self.warn(WarningCode::Syntax, line, || {
                let word = String::from_utf8_lossy(word);
                format!("'{word}' has a broken exponent; it was read as {number}")
            });
        }
        is_exponent.then_some(number)
    }

    #[inline]
    fn keep_vertex(&mut self, position: [f64; 3], color: Option<[f32; 4]>) {
        // False for NaN.
        let is_finite = position.iter().all(|coordinate| coordinate.abs() <= LARGEST_COORDINATE);
        if !is_finite {
            self.warn(WarningCode::NonFinite, self.line, || {
                "a vertex is not finite; faces that use it were dropped".into()
            });
        }
        let model = &mut self.block.model;
        if color.is_some() || !model.colors.is_empty() {
            model.colors.resize(model.positions.len(), WHITE);
            model.colors.push(color.unwrap_or(WHITE));
        }
        model.positions.push(if is_finite { position } else { [f64::NAN; 3] });
    }

    fn face(&mut self, line: u32, values: &[u8]) -> Result<(), BlockError> {
        let mut corners = std::mem::take(&mut self.corners);
        corners.clear();
        for word in words(values) {
            corners.push(self.corner(line, word)?);
        }
        if corners.len() < 3 {
            self.warn(WarningCode::Degenerate, line, || {
                format!(
                    "a face needs three corners, this one has {}; it was dropped",
                    corners.len()
                )
            });
        } else {
            self.block.model.push_polygon(&corners, line);
        }
        self.corners = corners;
        Ok(())
    }

    fn corner(&mut self, line: u32, word: &[u8]) -> Result<Corner, BlockError> {
        let mut parts = word.split(|&byte| byte == b'/');
        let [position, texcoord, normal] = [(); 3].map(|()| parts.next().unwrap_or_default());
        let wrong = |why: &str| {
            let word = String::from_utf8_lossy(word);
            BlockError {
                kind: ReadErrorKind::Index,
                line,
                what: format!("face corner '{word}' {why}"),
            }
        };
        if parts.next().is_some() {
            return Err(wrong("has too many slashes"));
        }
        let model = &self.block.model;
        let counts = [model.texcoords.len(), model.normals.len()];
        let position = parse_index(position, model.positions.len()).map_err(|why| wrong(&why))?.0;
        let texcoord = self.attribute_index(line, texcoord, counts[0]);
        let normal = self.attribute_index(line, normal, counts[1]);
        Ok(Corner { texcoord, normal, ..Corner::at(position) })
    }

    fn attribute_index(&mut self, line: u32, word: &[u8], count: usize) -> u32 {
        if word.is_empty() {
            return NONE;
        }
        parse_index(word, count).map_or_else(
            |why| {
                self.warn(WarningCode::Index, line, || {
                    let word = String::from_utf8_lossy(word);
                    format!("attribute '{word}' {why}; it was left out, the face is kept")
                });
                NONE
            },
            |index| index.0,
        )
    }

    /// `l`: a segment from each vertex to the next; texture coordinates are ignored.
    fn polyline(&mut self, line: u32, values: &[u8]) -> Result<(), BlockError> {
        let mut last = None;
        for word in words(values) {
            let index = word.split(|&byte| byte == b'/').next().unwrap_or_default();
            let end = parse_index(index, self.block.model.positions.len()).map_err(|why| {
                let word = String::from_utf8_lossy(word);
                BlockError {
                    kind: ReadErrorKind::Index,
                    line,
                    what: format!("line vertex '{word}' {why}"),
                }
            })?;
            if let Some(start) = last.replace(end.0) {
                self.block.model.segments.push(Segment { ends: [start, end.0], line });
            }
        }
        Ok(())
    }
}

/// A texture coordinate or normal; a missing or malformed number becomes 0, because
/// the geometry does not depend on it.
fn attributes<const N: usize>(values: &[u8]) -> [f32; N] {
    let mut numbers = [0.0; N];
    for (number, word) in numbers.iter_mut().zip(words(values)) {
        *number = parse_number(word).map_or(0.0, attribute);
    }
    numbers
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Parses without the plain parser.
    fn parse_in_general(text: &[u8]) -> ParsedBlock {
        let mut parser =
            Parser { text, at: 0, line: 0, corners: vec![], block: ParsedBlock::default() };
        while parser.at < text.len() {
            parser.line += 1;
            parser.any_line().unwrap();
        }
        parser.block.line_count = parser.line;
        parser.block
    }

    #[test]
    fn both_parsers_give_the_same() {
        let lines = [
            "v 1 2 3",
            "v  1.5  -2e3 .25 ",
            "v 1 2 3 0.5 0.5 0.5",
            "vt 0.5 1",
            "vt 0 1 0",
            "vn 0 0 1",
            "vn 0 0 1 # up",
            "f 1 2 3",
            "f 1 2 3 4 ",
            "f  1/1 2/2 3/3",
            "f 1//1 2//1 3//1",
            "f 1/1/1 2/1/1 3/1/1",
            "f 1/ 2/ 3/",
            "f 1 2",
            "f -1 -2 -3",
            "v 1 2 3\\",
            "v\t1 2 3",
            "f 1 2 3 # 4",
            "f 999999999 1 2",
            "f 1234567890 1 2",
            "v nan 0 0",
            "",
            "# text",
            "f 1  2  3",
        ];
        let mut cases = 0;
        for end in ["\n", "\r\n", "\r"] {
            for (first, second) in lines.iter().flat_map(|a| lines.map(|b| (a, b))) {
                let text = format!("{first}{end}{second}");
                let (plain, general) =
                    (parse_block(text.as_bytes()), parse_in_general(text.as_bytes()));
                assert_eq!(
                    format!("{:?}", plain.model),
                    format!("{:?}", general.model),
                    "{text:?}"
                );
                assert_eq!(plain.report, general.report, "{text:?}");
                assert_eq!(plain.line_count, general.line_count, "{text:?}");
                cases += 1;
            }
        }
        assert!(cases > 1000, "{cases} cases");
    }

    #[test]
    fn numbers_without_a_blank_between_are_not_plain() {
        let block = parse_block(b"v 1-2 3\n");
        assert!(block.error.is_some_and(|error| error.what.contains("'1-2'")));
    }
}
