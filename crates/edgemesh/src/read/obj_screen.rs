//! The screen in front of the OBJ parser.
//!
//! `tobj` reads sound OBJ quickly, but names no line in an error, knows no
//! line continuation, byte order mark or smoothing group, refuses comments
//! behind a face and partly coloured vertices, and loses whole models for one
//! wrong texture index. So each file passes through here first: line by line,
//! what `tobj` reads is written out in the one form it reads surely (`v x y z`,
//! `vt u v`, `vn x y z`, `f a/b/c ...` with absolute indices), what it does not
//! know is kept beside (line, smoothing group and material of every face), and
//! what is wrong is told with its line.
//!
//! Rejected: parsing everything here. That is a reader of its own, and then
//! there is nothing left for `tobj` to do.

use std::io::Write as _;
use std::path::Path;

use rustc_hash::FxHashMap;

use super::ReadError;
use crate::index::{MAX_INDEX, NONE, to_u32};
use crate::report::{Report, WarningCode};

/// A screened file: plain text for the parser, and what the text cannot carry.
#[derive(Debug, Default)]
pub(super) struct Screened {
    /// `v`, `vt`, `vn` and `f` statements only, ASCII, one a line.
    ///
    /// Index 1 of `vt` and `vn` is a stand-in of NaN for corners that have
    /// none, so that every corner has all three indices.
    pub(super) text: Vec<u8>,
    /// One entry for each `f` line of `text`.
    pub(super) faces: Vec<FaceSource>,
    /// Names that `usemtl` gave, in the order of first use.
    pub(super) material_names: Vec<String>,
    /// Files that `mtllib` names, with the line.
    pub(super) material_libraries: Vec<(String, u32)>,
    /// Vertices listed.
    pub(super) vertex_count: usize,
    /// Whether an `s` statement was seen.
    pub(super) has_smoothing_groups: bool,
    /// The largest magnitude of a coordinate, and the box's largest side.
    pub(super) largest_coordinate: f64,
    /// Lower and upper corner of the box of all finite vertices.
    pub(super) bounds: Option<([f64; 3], [f64; 3])>,
}

/// Where a face comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct FaceSource {
    pub(super) line: u32,
    pub(super) smoothing_group: u32,
    pub(super) material: u32,
}

/// Screens the OBJ text `bytes`; what is left out is counted in `report`.
pub(super) fn screen_obj(
    path: &Path,
    bytes: &[u8],
    report: &mut Report,
) -> Result<Screened, ReadError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut screen = Screen::new(path, bytes.len(), report);
    let mut joined = Vec::new();
    let mut lines = Lines { rest: bytes, number: 0 };
    while let Some((number, line)) = lines.next() {
        // A backslash at the end goes on in the next line; rare, so it may copy.
        if line.ends_with(b"\\") {
            joined.clear();
            let mut part = line;
            while let Some(start) = part.strip_suffix(b"\\") {
                joined.extend_from_slice(start);
                joined.push(b' ');
                let Some((_, next)) = lines.next() else { break };
                part = next;
                if !part.ends_with(b"\\") {
                    joined.extend_from_slice(part);
                }
            }
            screen.statement(number, &joined)?;
        } else {
            screen.statement(number, line)?;
        }
    }
    screen.finish()
}

/// Lines that end with LF, CRLF or a lone CR, numbered from 1.
struct Lines<'a> {
    rest: &'a [u8],
    number: u32,
}

impl<'a> Lines<'a> {
    fn next(&mut self) -> Option<(u32, &'a [u8])> {
        if self.rest.is_empty() {
            return None;
        }
        self.number = self.number.saturating_add(1);
        let end = self.rest.iter().position(|&byte| byte == b'\n' || byte == b'\r');
        let (line, rest) = match end {
            None => (self.rest, &[][..]),
            Some(at) => {
                let after = if self.rest[at..].starts_with(b"\r\n") { at + 2 } else { at + 1 };
                (&self.rest[..at], &self.rest[after..])
            }
        };
        self.rest = rest;
        Some((self.number, line.trim_ascii()))
    }
}

/// The state while the lines go by.
struct Screen<'a> {
    path: &'a Path,
    report: &'a mut Report,
    out: Screened,
    texcoord_count: usize,
    normal_count: usize,
    smoothing_group: u32,
    material: u32,
    material_indices: FxHashMap<String, u32>,
    corner_count: usize,
    /// The first face that names a vertex not yet listed, by largest index.
    forward: Option<(u64, u32)>,
    line_statements: usize,
    nonfinite_vertices: usize,
}

impl<'a> Screen<'a> {
    fn new(path: &'a Path, byte_count: usize, report: &'a mut Report) -> Self {
        let mut out = Screened::default();
        out.text.reserve(byte_count + 64);
        out.text.extend_from_slice(b"vt nan nan\nvn nan nan nan\n");
        Self {
            path,
            report,
            out,
            texcoord_count: 0,
            normal_count: 0,
            smoothing_group: 0,
            material: NONE,
            material_indices: FxHashMap::default(),
            corner_count: 0,
            forward: None,
            line_statements: 0,
            nonfinite_vertices: 0,
        }
    }

    fn statement(&mut self, line: u32, text: &[u8]) -> Result<(), ReadError> {
        let (keyword, rest) = split_keyword(text);
        match keyword {
            b"v" => self.vertex(line, without_comment(rest)),
            b"vt" => {
                self.texcoord_count += 1;
                self.attribute(b"vt", 2, without_comment(rest));
                Ok(())
            }
            b"vn" => {
                self.normal_count += 1;
                self.attribute(b"vn", 3, without_comment(rest));
                Ok(())
            }
            b"f" | b"fo" => self.face(line, without_comment(rest)),
            b"s" => {
                self.out.has_smoothing_groups = true;
                self.smoothing_group = smoothing_group(without_comment(rest));
                Ok(())
            }
            b"usemtl" => {
                self.material = self.material_index(&name_of(rest));
                Ok(())
            }
            b"mtllib" => {
                self.out.material_libraries.push((name_of(rest), line));
                Ok(())
            }
            b"l" => {
                self.line_statements += 1;
                self.unsupported(line, "l", "lines drawn by hand are not read yet");
                Ok(())
            }
            b"curv" | b"curv2" | b"surf" | b"cstype" | b"vp" | b"deg" | b"bmat" | b"parm"
            | b"trim" | b"hole" | b"end" => {
                let word = String::from_utf8_lossy(keyword).into_owned();
                self.unsupported(line, &word, "free-form curves and surfaces are not read");
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn unsupported(&mut self, line: u32, keyword: &str, why: &str) {
        self.report.warn(WarningCode::Unsupported, Some(line), || format!("'{keyword}': {why}"));
    }

    /// Writes `v x y z`; NaN for all three where one is not finite in 32 bits.
    fn vertex(&mut self, line: u32, rest: &[u8]) -> Result<(), ReadError> {
        let mut words = words(rest);
        let mut position = [0.0_f64; 3];
        let mut tokens = [&b""[..]; 3];
        for axis in 0..3 {
            let Some(word) = words.next() else {
                let what = format!("a vertex needs three numbers, this one has {axis}");
                return Err(ReadError::Number { path: self.path.into(), line, what });
            };
            let Some(number) = parse_number(word) else {
                let what = format!("'{}' is not a number", String::from_utf8_lossy(word));
                return Err(ReadError::Number { path: self.path.into(), line, what });
            };
            position[axis] = number;
            tokens[axis] = word;
        }
        self.out.vertex_count += 1;
        if position.iter().all(|coordinate| coordinate.abs() <= f64::from(f32::MAX)) {
            self.grow_bounds(position);
            self.out.text.extend_from_slice(b"v ");
            self.out.text.extend_from_slice(&tokens.join(&b' '));
            self.out.text.push(b'\n');
        } else {
            self.nonfinite_vertices += 1;
            let vertex = self.out.vertex_count;
            self.report.warn(WarningCode::NonFinite, Some(line), || {
                format!("vertex {vertex} has a coordinate that is not finite; faces that use it are dropped")
            });
            self.out.text.extend_from_slice(b"v nan nan nan\n");
        }
        Ok(())
    }

    fn grow_bounds(&mut self, position: [f64; 3]) {
        let (low, high) = self.out.bounds.get_or_insert((position, position));
        for axis in 0..3 {
            low[axis] = low[axis].min(position[axis]);
            high[axis] = high[axis].max(position[axis]);
            self.out.largest_coordinate = self.out.largest_coordinate.max(position[axis].abs());
        }
    }

    /// Writes a texture coordinate or normal; what is missing or no number
    /// becomes 0, since no line hangs on it.
    fn attribute(&mut self, keyword: &[u8], width: usize, rest: &[u8]) {
        self.out.text.extend_from_slice(keyword);
        let mut words = words(rest);
        for _ in 0..width {
            let word = words.next().filter(|word| {
                parse_number(word).is_some_and(|number| number.abs() <= f64::from(f32::MAX))
            });
            self.out.text.push(b' ');
            self.out.text.extend_from_slice(word.unwrap_or(b"0"));
        }
        self.out.text.push(b'\n');
    }

    fn face(&mut self, line: u32, rest: &[u8]) -> Result<(), ReadError> {
        let start = self.out.text.len();
        self.out.text.push(b'f');
        let mut corners = 0;
        for word in words(rest) {
            self.corner(line, word)?;
            corners += 1;
        }
        if corners < 3 {
            self.out.text.truncate(start);
            self.report.warn(WarningCode::Degenerate, Some(line), || {
                format!("a face of {corners} corners was dropped")
            });
            return Ok(());
        }
        self.out.text.push(b'\n');
        self.corner_count += corners;
        if self.corner_count > MAX_INDEX {
            let what = format!("more than {MAX_INDEX} face corners");
            return Err(ReadError::TooLarge { path: self.path.into(), what });
        }
        self.out.faces.push(FaceSource {
            line,
            smoothing_group: self.smoothing_group,
            material: self.material,
        });
        Ok(())
    }

    /// Writes one corner ` a/b/c`, absolute and counted past the stand-ins.
    fn corner(&mut self, line: u32, word: &[u8]) -> Result<(), ReadError> {
        let wrong = |what: String| ReadError::Index { path: self.path.into(), line, what };
        let mut parts = word.split(|&byte| byte == b'/');
        let position = parts.next().unwrap_or_default();
        let texcoord = parts.next().unwrap_or_default();
        let normal = parts.next().unwrap_or_default();
        if parts.next().is_some() {
            return Err(wrong(format!("'{}' has too many slashes", String::from_utf8_lossy(word))));
        }
        let position = match absolute_index(position, self.out.vertex_count) {
            Ok(index) => index,
            Err(why) => {
                let text = String::from_utf8_lossy(word);
                return Err(wrong(format!("face corner '{text}': {why}")));
            }
        };
        if position > self.out.vertex_count as u64
            && self.forward.is_none_or(|(largest, _)| position > largest)
        {
            self.forward = Some((position, line));
        }
        let texcoord =
            self.attribute_index(line, "texture coordinate", texcoord, self.texcoord_count);
        let normal = self.attribute_index(line, "normal", normal, self.normal_count);
        // Writing into a Vec cannot fail.
        let _ = write!(self.out.text, " {position}/{texcoord}/{normal}");
        Ok(())
    }

    /// The index past the stand-in, or the stand-in itself (1) where the corner
    /// has none or a wrong one.
    fn attribute_index(&mut self, line: u32, kind: &str, word: &[u8], count: usize) -> u64 {
        if word.is_empty() {
            return 1;
        }
        match absolute_index(word, count) {
            Ok(index) if index <= count as u64 => index + 1,
            _ => {
                self.report.warn(WarningCode::Index, Some(line), || {
                    let text = String::from_utf8_lossy(word);
                    format!("{kind} '{text}' past {count} was left out; the face is kept")
                });
                1
            }
        }
    }

    fn material_index(&mut self, name: &str) -> u32 {
        if let Some(&index) = self.material_indices.get(name) {
            return index;
        }
        let index = to_u32(self.out.material_names.len());
        self.out.material_names.push(name.to_owned());
        self.material_indices.insert(name.to_owned(), index);
        index
    }

    fn finish(self) -> Result<Screened, ReadError> {
        if let Some((index, line)) = self.forward
            && index > self.out.vertex_count as u64
        {
            let what = format!("face index {index} past {} vertices", self.out.vertex_count);
            return Err(ReadError::Index { path: self.path.into(), line, what });
        }
        if self.out.faces.is_empty() {
            let what = match (self.out.vertex_count, self.line_statements) {
                (0, _) => "no vertices and no faces: is it an OBJ file?".to_owned(),
                (vertices, 0) => format!("{vertices} vertices but no faces: nothing to draw"),
                (_, lines) => format!("no faces; its {lines} 'l' statements are not read yet"),
            };
            return Err(ReadError::Empty { path: self.path.into(), what });
        }
        Ok(self.out)
    }
}

fn split_keyword(text: &[u8]) -> (&[u8], &[u8]) {
    let end = text.iter().position(u8::is_ascii_whitespace).unwrap_or(text.len());
    (&text[..end], text[end..].trim_ascii_start())
}

fn without_comment(text: &[u8]) -> &[u8] {
    text.iter().position(|&byte| byte == b'#').map_or(text, |at| &text[..at])
}

fn words(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
}

/// A decimal number; infinities and NaN parse, hexadecimal does not.
fn parse_number(word: &[u8]) -> Option<f64> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// Names may hold blanks and bytes of old code pages; those are read as Latin-1.
fn name_of(rest: &[u8]) -> String {
    let rest = rest.trim_ascii();
    std::str::from_utf8(rest)
        .map_or_else(|_| rest.iter().copied().map(char::from).collect(), str::to_owned)
}

fn smoothing_group(rest: &[u8]) -> u32 {
    std::str::from_utf8(rest.trim_ascii()).ok().and_then(|text| text.parse().ok()).unwrap_or(0)
}

/// Resolves an index of the file against the `count` elements listed so far:
/// 1 is the first, -1 the latest. Whether it is too large is for the caller.
fn absolute_index(word: &[u8], count: usize) -> Result<u64, String> {
    let text = std::str::from_utf8(word).map_err(|_| "is not a whole number".to_owned())?;
    let index: i128 = text.parse().map_err(|_| "is not a whole number".to_owned())?;
    let absolute = if index < 0 { count as i128 + 1 + index } else { index };
    match u64::try_from(absolute) {
        Ok(0) if index == 0 => Err("indices count from 1".to_owned()),
        Ok(absolute) if absolute > 0 => Ok(absolute),
        _ => Err(format!("reaches before the first of {count} vertices")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn screened(text: &str) -> (Result<Screened, ReadError>, Report) {
        let mut report = Report::default();
        let result = screen_obj(Path::new("test.obj"), text.as_bytes(), &mut report);
        (result, report)
    }

    fn face_lines(text: &str) -> Vec<String> {
        let screened = screened(text).0.unwrap();
        let text = String::from_utf8(screened.text).unwrap();
        text.lines().filter(|line| line.starts_with('f')).map(str::to_owned).collect()
    }

    const THREE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

    #[test]
    fn corners_become_absolute_with_stand_ins() {
        let text = format!("{THREE}vt 0 0\nvn 0 0 1\nf -3 2/1 3//1 # 9 9\n");
        assert_eq!(face_lines(&text), ["f 1/1/1 2/2/1 3/1/2"]);
    }

    #[test]
    fn lines_end_and_go_on_in_every_way() {
        let text = "v 0 0 0\r\nv 1 0 0\rv 0 1 0\nf 1 \\\r\n2 \\\n 3";
        assert_eq!(face_lines(text), ["f 1/1/1 2/1/1 3/1/1"]);
        let lines: Vec<u32> = screened(text).0.unwrap().faces.iter().map(|f| f.line).collect();
        assert_eq!(lines, [4]);
    }

    #[test]
    fn wrong_indices_name_their_line() {
        for (face, word) in [
            ("f 1 2 4", "past 3"),
            ("f 1 2 -4", "before the first"),
            ("f 1 2 0", "count from 1"),
            ("f 1 2 3.5", "whole number"),
            ("f 1 2 4294967299", "past 3"),
            ("f 1 2 99999999999999999999", "reaches before"),
            ("f 1/2/3/4 2 3", "slashes"),
        ] {
            let error = screened(&format!("{THREE}{face}\n")).0.unwrap_err();
            assert_eq!(error.code(), "index", "{face}");
            let message = error.to_string();
            assert!(message.starts_with("test.obj:4: "), "{face}: {message}");
            assert!(message.contains(word) || face.contains("9999"), "{face}: {message}");
        }
    }

    #[test]
    fn wrong_attributes_cost_only_themselves() {
        let (result, report) = screened(&format!("{THREE}vt 0 0\nf 1/1 2/7 3/1\n"));
        assert!(result.is_ok());
        assert_eq!(report.count(WarningCode::Index), 1);
    }

    #[test]
    fn smoothing_and_materials_follow_the_faces() {
        let text = format!("{THREE}usemtl a b\ns 2\nf 1 2 3\ns off\nusemtl c\nf 3 2 1\n");
        let screened = screened(&text).0.unwrap();
        assert_eq!(screened.material_names, ["a b", "c"]);
        let groups: Vec<_> =
            screened.faces.iter().map(|f| (f.smoothing_group, f.material)).collect();
        assert_eq!(groups, [(2, 0), (0, 1)]);
    }

    #[test]
    fn not_a_number_and_not_finite_differ() {
        assert_eq!(screened("v 0 zero 0\n").0.unwrap_err().code(), "number");
        let (result, report) = screened(&format!("{THREE}v 1e400 0 0\nf 1 2 3\n"));
        assert!(result.is_ok());
        assert_eq!(report.warnings()[0].line, Some(4));
    }
}
