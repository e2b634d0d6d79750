//! Parses a part of an OBJ file as if it were all of it.
//!
//! Idea: nearly every line is `v`, `vt`, `vn` or `f` in its plainest form. Those
//! are read in place, byte by byte; the first thing out of the ordinary sends
//! the line to the general way, which joins continued lines, drops comments
//! and splits words. Both give the same for a plain line, and a test says so.

use memchr::memchr2;

use super::statement::{
    ChunkIndex, name_of, parse_index, smoothing_group, split_keyword, without_comment, words,
};
use crate::format::read::error::ReadErrorKind;
use crate::format::read::firewall::LARGEST_COORDINATE;
use crate::format::read::number::{parse_number, parse_prefix};
use crate::index::{NONE, to_u32};
use crate::model::{Corner, Model, Segment};
use crate::report::{Place, Report, WarningCode};

/// What a chunk says; lines count from its own first, which is 1.
#[derive(Debug, Default)]
pub(super) struct Part {
    /// Elements and polygons; all indices are [`ChunkIndex`]es.
    pub(super) model: Model,
    /// How many lines it has.
    pub(super) line_count: u32,
    /// Statements that change the state, in order.
    pub(super) changes: Vec<Change>,
    /// Files that `mtllib` names, with the line.
    pub(super) libraries: Vec<(String, u32)>,
    /// What was found and kept.
    pub(super) report: Report,
    /// What ended the parsing, with its line.
    pub(super) error: Option<PartError>,
}

/// What cannot be kept.
#[derive(Debug)]
pub(super) struct PartError {
    pub(super) kind: ReadErrorKind,
    pub(super) line: u32,
    pub(super) what: String,
}

/// A change of the state from one polygon on.
#[derive(Debug)]
pub(super) struct Change {
    /// The first polygon of the chunk that it is for.
    pub(super) polygon: u32,
    pub(super) what: ChangeKind,
}

/// What changes.
#[derive(Debug)]
pub(super) enum ChangeKind {
    Material(String),
    Group(String),
    Smoothing(u32),
}

/// Parses `text`, which begins and ends with whole statements.
pub(super) fn parse_chunk(text: &[u8]) -> Part {
    let mut parser = Parser { text, at: 0, line: 0, corners: Vec::new(), part: Part::default() };
    // A guess that is seldom too small: 43 bytes a triangle, two a vertex.
    parser.part.model.corner_positions.reserve(text.len() / 14);
    parser.part.model.polygon_lines.reserve(text.len() / 42);
    parser.part.model.positions.reserve(text.len() / 84);
    while parser.at < text.len() {
        parser.line = parser.line.saturating_add(1);
        if let Some(next) = parser.plain_line() {
            parser.at = next;
        } else if let Err((kind, line, what)) = parser.any_line() {
            parser.part.error = Some(PartError { kind, line, what });
            break;
        }
    }
    parser.part.line_count = parser.line;
    parser.part
}

type Failure = (ReadErrorKind, u32, String);

struct Parser<'a> {
    text: &'a [u8],
    at: usize,
    /// The line at `at`, counted from 1.
    line: u32,
    /// The corners of the face at hand.
    corners: Vec<Corner>,
    part: Part,
}

/// The plain way. Each function gives the place behind the line, or `None`
/// where the line takes the general way; nothing has been kept then.
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
                self.part.model.normals.push(normal.map(attribute));
                Some(end)
            }
            b"vt" => {
                let (texcoord, end) = self.plain_numbers::<2>(self.at + 2)?;
                self.part.model.texcoords.push(texcoord.map(attribute));
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
            at = self.behind_blanks(at);
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
            let start = self.behind_blanks(at);
            if let Some(end) = self.line_end(start) {
                if self.corners.len() < 3 {
                    return None;
                }
                self.part.model.push_polygon(&self.corners, self.line);
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
        let mut corner = Corner { position, texcoord: NONE, normal: NONE };
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

    /// One to nine digits, which cannot overflow; 0 is not plain.
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
        (index > 0).then(|| (ChunkIndex::absolute(index).0, at))
    }

    #[inline]
    fn behind_blanks(&self, mut at: usize) -> usize {
        while self.text.get(at) == Some(&b' ') {
            at += 1;
        }
        at
    }

    /// The place behind the line end at `at`, if there is one.
    #[inline]
    fn line_end(&self, at: usize) -> Option<usize> {
        match self.text.get(at) {
            None => Some(at),
            Some(b'\n') => Some(at + 1),
            Some(b'\r') if self.text.get(at + 1) == Some(&b'\n') => Some(at + 2),
            Some(b' ') => {
                let behind = self.behind_blanks(at);
                if self.text.get(behind) == Some(&b' ') { None } else { self.line_end(behind) }
            }
            _ => None,
        }
    }
}

/// A texture coordinate or part of a normal in 32 bits.
#[expect(clippy::cast_possible_truncation, reason = "an attribute needs no more")]
const fn attribute(number: f64) -> f32 {
    number as f32
}

/// The general way.
impl Parser<'_> {
    /// Reads the statement at `at`, with the lines that it goes on in.
    fn any_line(&mut self) -> Result<(), Failure> {
        let first_line = self.line;
        let line = self.next_line();
        let Some(start) = line.strip_suffix(b"\\") else {
            return self.statement(first_line, line);
        };
        let mut joined = start.to_vec();
        while self.at < self.text.len() {
            self.line = self.line.saturating_add(1);
            let line = self.next_line();
            joined.push(b' ');
            match line.strip_suffix(b"\\") {
                Some(part) => joined.extend_from_slice(part),
                None => {
                    joined.extend_from_slice(line);
                    break;
                }
            }
        }
        self.statement(first_line, &joined)
    }

    /// The line at `at` without blanks around it; LF, CRLF and a lone CR end it.
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

    fn statement(&mut self, line: u32, text: &[u8]) -> Result<(), Failure> {
        let (keyword, rest) = split_keyword(text);
        let values = without_comment(rest);
        match keyword {
            b"v" => self.vertex(line, values)?,
            b"vt" => {
                let texcoord = attributes(values);
                self.part.model.texcoords.push(texcoord);
            }
            b"vn" => {
                let normal = attributes(values);
                self.part.model.normals.push(normal);
            }
            b"f" | b"fo" => self.face(line, values)?,
            b"l" => self.polyline(line, values)?,
            b"s" => self.change(ChangeKind::Smoothing(smoothing_group(values))),
            b"usemtl" => self.change(ChangeKind::Material(name_of(rest))),
            b"g" | b"o" => self.change(ChangeKind::Group(name_of(rest))),
            b"mtllib" => self.part.libraries.push((name_of(rest), line)),
            b"curv" | b"curv2" | b"surf" | b"cstype" | b"vp" | b"deg" | b"bmat" | b"parm"
            | b"trim" | b"hole" | b"end" => {
                self.warn(WarningCode::Unsupported, line, || {
                    let word = String::from_utf8_lossy(keyword);
                    format!("'{word}': free-form curves and surfaces are not read")
                });
            }
            _ => {}
        }
        Ok(())
    }

    fn change(&mut self, what: ChangeKind) {
        let polygon = to_u32(self.part.model.polygon_count());
        self.part.changes.push(Change { polygon, what });
    }

    fn warn(&mut self, code: WarningCode, line: u32, message: impl FnOnce() -> String) {
        self.part.report.warn(code, Some(Place::Line(line)), message);
    }

    fn vertex(&mut self, line: u32, values: &[u8]) -> Result<(), Failure> {
        let mut numbers = [1.0; 6];
        let mut count = 0;
        for (number, word) in numbers.iter_mut().zip(words(values)) {
            match self.number(line, word) {
                Some(value) => *number = value,
                // What is behind the position may be anything.
                None if count >= 3 => break,
                None => {
                    let what = format!("'{}' is not a number", String::from_utf8_lossy(word));
                    return Err((ReadErrorKind::Number, line, what));
                }
            }
            count += 1;
        }
        let [x, y, z, r, g, b] = numbers;
        if count < 3 {
            let what = format!("a vertex needs three numbers, this one has {count}");
            return Err((ReadErrorKind::Number, line, what));
        }
        // Four numbers are a point with its weight, six or seven have a colour.
        self.keep_vertex([x, y, z], (count == 6).then(|| [r, g, b].map(attribute)));
        Ok(())
    }

    /// A number; one with a broken exponent is read without it.
    fn number(&mut self, line: u32, word: &[u8]) -> Option<f64> {
        if let Some(number) = parse_number(word) {
            return Some(number);
        }
        let (number, length) = parse_prefix(word)?;
        let is_exponent = matches!(word[length..], [b'+' | b'-', b'e' | b'E', ..]);
        if is_exponent {
            self.warn(WarningCode::Syntax, line, || {
                let word = String::from_utf8_lossy(word);
                format!("'{word}' was read as {number}: its exponent is broken")
            });
        }
        is_exponent.then_some(number)
    }

    #[inline]
    fn keep_vertex(&mut self, position: [f64; 3], color: Option<[f32; 3]>) {
        // NaN compares as not within.
        let is_finite = position.iter().all(|coordinate| coordinate.abs() <= LARGEST_COORDINATE);
        if !is_finite {
            self.warn(WarningCode::NonFinite, self.line, || {
                "a vertex is not finite; faces that use it were dropped".into()
            });
        }
        let model = &mut self.part.model;
        if color.is_some() || !model.colors.is_empty() {
            model.colors.resize(model.positions.len(), [1.0; 3]);
            model.colors.push(color.unwrap_or([1.0; 3]));
        }
        model.positions.push(if is_finite { position } else { [f64::NAN; 3] });
    }

    fn face(&mut self, line: u32, values: &[u8]) -> Result<(), Failure> {
        let mut corners = std::mem::take(&mut self.corners);
        corners.clear();
        for word in words(values) {
            corners.push(self.corner(line, word)?);
        }
        if corners.len() < 3 {
            self.warn(WarningCode::Degenerate, line, || {
                format!("a face of {} corners was dropped", corners.len())
            });
        } else {
            self.part.model.push_polygon(&corners, line);
        }
        self.corners = corners;
        Ok(())
    }

    fn corner(&mut self, line: u32, word: &[u8]) -> Result<Corner, Failure> {
        let mut parts = word.split(|&byte| byte == b'/');
        let [position, texcoord, normal] = [(); 3].map(|()| parts.next().unwrap_or_default());
        let wrong = |why: &str| {
            let word = String::from_utf8_lossy(word);
            (ReadErrorKind::Index, line, format!("face corner '{word}': {why}"))
        };
        if parts.next().is_some() {
            return Err(wrong("has too many slashes"));
        }
        let model = &self.part.model;
        let counts = [model.texcoords.len(), model.normals.len()];
        let position = parse_index(position, model.positions.len()).map_err(|why| wrong(&why))?.0;
        let texcoord = self.attribute_index(line, texcoord, counts[0]);
        let normal = self.attribute_index(line, normal, counts[1]);
        Ok(Corner { position, texcoord, normal })
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

    /// `l`: from vertex to vertex; texture coordinates behind a slash are left
    /// out.
    fn polyline(&mut self, line: u32, values: &[u8]) -> Result<(), Failure> {
        let mut last = None;
        for word in words(values) {
            let index = word.split(|&byte| byte == b'/').next().unwrap_or_default();
            let end = parse_index(index, self.part.model.positions.len()).map_err(|why| {
                let word = String::from_utf8_lossy(word);
                (ReadErrorKind::Index, line, format!("line vertex '{word}': {why}"))
            })?;
            if let Some(start) = last.replace(end.0) {
                self.part.model.segments.push(Segment { ends: [start, end.0], line });
            }
        }
        Ok(())
    }
}

/// A texture coordinate or normal; what is missing or no number becomes 0,
/// since no line hangs on it.
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

    /// Parses without the plain way.
    fn parse_in_general(text: &[u8]) -> Part {
        let mut parser = Parser { text, at: 0, line: 0, corners: vec![], part: Part::default() };
        while parser.at < text.len() {
            parser.line += 1;
            parser.any_line().unwrap();
        }
        parser.part.line_count = parser.line;
        parser.part
    }

    #[test]
    fn both_ways_give_the_same() {
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
        let mut plain = 0;
        for end in ["\n", "\r\n", "\r"] {
            for (first, second) in lines.iter().flat_map(|a| lines.map(|b| (a, b))) {
                let text = format!("{first}{end}{second}");
                let (ours, general) =
                    (parse_chunk(text.as_bytes()), parse_in_general(text.as_bytes()));
                assert_eq!(format!("{:?}", ours.model), format!("{:?}", general.model), "{text:?}");
                assert_eq!(ours.report, general.report, "{text:?}");
                assert_eq!(ours.line_count, general.line_count, "{text:?}");
                plain += 1;
            }
        }
        assert!(plain > 1000, "{plain} cases");
    }

    #[test]
    fn numbers_side_by_side_are_not_plain() {
        let part = parse_chunk(b"v 1-2 3\n");
        assert!(part.error.is_some_and(|error| error.what.contains("'1-2'")));
    }
}
