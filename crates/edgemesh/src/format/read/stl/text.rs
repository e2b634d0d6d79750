//! Text STL.
//!
//! Words may be in upper or lower case, and on any line; only the three numbers of a vertex end
//! with their line. The name of a solid ends with its line too, or at `facet normal` and a
//! number: some programs write a whole file as one line.
//!
//! ```text
//! solid NAME                      a group
//!   facet normal 0 0 1            the normal is ignored
//!     outer loop
//!       vertex 0 0 0              three of them
//!     endloop
//!   endfacet                      a triangle, if it has three vertices
//! endsolid NAME
//! ```
//!
//! A facet ends at `endfacet` or at the next `facet`. An open facet at the end of the
//! file is dropped: its last number may be incomplete.
//! Rejected: facets with four vertices as quads, which the format does not have and
//! other programs do not read.

use rustc_hash::FxHashMap;

use super::super::byte_order_mark::without_mark;
use super::super::error::{ReadError, ReadErrorKind};
use super::super::source::Source;
use super::super::words::{Words, quoted};
use crate::index::{NONE, to_u32};
use crate::model::{Attributes, Corner, Model};
use crate::report::{Place, Report, WarningCode};

/// Keywords of the format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Keyword {
    Vertex,
    Facet,
    Normal,
    /// `outer`, `loop` or `endloop`, which have no effect.
    Loop,
    EndFacet,
    Solid,
    EndSolid,
}

/// The words, the frequent ones first.
const KEYWORDS: [(&[u8], Keyword); 9] = [
    (b"vertex", Keyword::Vertex),
    (b"facet", Keyword::Facet),
    (b"normal", Keyword::Normal),
    (b"outer", Keyword::Loop),
    (b"loop", Keyword::Loop),
    (b"endloop", Keyword::Loop),
    (b"endfacet", Keyword::EndFacet),
    (b"solid", Keyword::Solid),
    (b"endsolid", Keyword::EndSolid),
];

/// Reads a text file.
///
/// # Errors
/// Number: a vertex does not have three numbers.
pub(super) fn read_text(source: &Source, report: &mut Report) -> Result<Model, ReadError> {
    let start = source.bytes.len() - without_mark(source.bytes).len();
    let mut reader = TextReader {
        source,
        report,
        words: Words::new(source.bytes, start, 1),
        model: Model::default(),
        groups: FxHashMap::default(),
        solid: None,
        facet: None,
        corners: Vec::new(),
    };
    while reader.statement()? {}
    reader.finish();
    Ok(reader.model)
}

struct TextReader<'s, 'a> {
    source: &'s Source<'a>,
    report: &'s mut Report,
    words: Words<'a>,
    model: Model,
    /// Indices of the model's groups, by name.
    groups: FxHashMap<&'a [u8], u32>,
    /// The line of the open solid.
    solid: Option<u32>,
    /// The line of the open facet.
    facet: Option<u32>,
    /// The vertices of the open facet.
    corners: Vec<[f64; 3]>,
}

impl<'a> TextReader<'_, 'a> {
    /// Reads a keyword and its values; returns false at the end of the file.
    fn statement(&mut self) -> Result<bool, ReadError> {
        self.words.skip_space();
        let Some(word) = self.words.word() else { return Ok(false) };
        let keyword = KEYWORDS.iter().find(|(name, _)| word.eq_ignore_ascii_case(name));
        match keyword.map(|&(_, keyword)| keyword) {
            Some(Keyword::Vertex) => self.vertex()?,
            Some(Keyword::Facet) => {
                self.end_facet();
                self.facet = Some(self.words.line());
            }
            Some(Keyword::Normal) => {
                // Three words, which need not be numbers.
                for _ in 0..3 {
                    self.words.word();
                }
            }
            Some(Keyword::Loop) => {}
            Some(Keyword::EndFacet) => self.end_facet(),
            Some(Keyword::Solid) => self.begin_solid(),
            Some(Keyword::EndSolid) => {
                self.end_facet();
                self.end_solid();
            }
            None => self.unknown(word),
        }
        Ok(true)
    }

    fn vertex(&mut self) -> Result<(), ReadError> {
        let line = self.words.line();
        self.facet.get_or_insert(line);
        let mut position = [0.0; 3];
        for coordinate in &mut position {
            match self.words.number() {
                Some(Ok(number)) => *coordinate = number,
                // Truncated: the facet will be dropped.
                _ if self.words.left().is_empty() => return Ok(()),
                word => return Err(self.number_error(word.and_then(Result::err))),
            }
        }
        self.corners.push(position);
        Ok(())
    }

    fn number_error(&self, word: Option<&[u8]>) -> ReadError {
        let what = match word {
            Some(word) => format!("{} is not a number", quoted(word)),
            None => "a vertex has fewer than three numbers".into(),
        };
        self.source.error(ReadErrorKind::Number, Some(Place::Line(self.words.line())), what)
    }

    fn begin_solid(&mut self) {
        self.end_facet();
        self.warn_of_open_solid();
        self.solid = Some(self.words.line());
        let name = match self.facet_in_line() {
            Some(facet) => self.take_until(facet),
            None => self.words.take_rest_of_line(),
        };
        let group = if name.is_empty() { NONE } else { self.group(name) };
        self.model.set_attributes(Attributes { group, ..Attributes::default() });
    }

    /// Skips the name after `endsolid`, up to the next solid or facet of this line.
    fn end_solid(&mut self) {
        self.solid = None;
        let Some(facet) = self.facet_in_line() else {
            self.words.take_rest_of_line();
            return;
        };
        while self.words.at() < facet.at() {
            let before = self.words.clone();
            if self.words.word().is_some_and(|word| word.eq_ignore_ascii_case(b"solid")) {
                self.words = before;
                return;
            }
        }
        self.words = facet;
    }

    /// The cursor before the next `facet normal` of this line that a number follows.
    fn facet_in_line(&self) -> Option<Words<'a>> {
        let mut ahead = self.words.clone();
        loop {
            let facet = ahead.clone();
            if !ahead.word()?.eq_ignore_ascii_case(b"facet") {
                continue;
            }
            let mut normal = ahead.clone();
            let is_normal = normal.word().is_some_and(|word| word.eq_ignore_ascii_case(b"normal"));
            if is_normal && matches!(normal.number(), Some(Ok(_))) {
                return Some(facet);
            }
        }
    }

    /// Moves to `to`; returns the text before it without surrounding blanks.
    fn take_until(&mut self, to: Words<'a>) -> &'a [u8] {
        let length = to.at() - self.words.at();
        let text = self.words.left().get(..length).unwrap_or_default();
        self.words = to;
        text.trim_ascii()
    }

    fn end_facet(&mut self) {
        let Some(line) = self.facet.take() else { return };
        if self.corners.len() == 3 {
            let first = to_u32(self.model.positions.len());
            self.model.positions.append(&mut self.corners);
            self.model.push_polygon(&[first, first + 1, first + 2].map(Corner::at), line);
            return;
        }
        let count = self.corners.len();
        self.corners.clear();
        self.report.warn(WarningCode::Syntax, Some(Place::Line(line)), || {
            format!("a facet needs three vertices, this one has {count}; it was dropped")
        });
    }

    fn unknown(&mut self, word: &[u8]) {
        self.report.warn(WarningCode::Syntax, Some(Place::Line(self.words.line())), || {
            format!("{} is not an STL keyword; its line was left out", quoted(word))
        });
        self.words.take_rest_of_line();
    }

    fn finish(&mut self) {
        match self.facet {
            Some(line) => self.report.warn(WarningCode::Truncated, Some(Place::Line(line)), || {
                "the file ends within a facet, which was dropped".into()
            }),
            None => self.warn_of_open_solid(),
        }
    }

    fn warn_of_open_solid(&mut self) {
        if let Some(line) = self.solid {
            self.report.warn(WarningCode::Truncated, Some(Place::Line(line)), || {
                "a solid has no end; the file may be truncated".into()
            });
        }
    }

    /// The index of the group `name`, which is added if it is new.
    fn group(&mut self, name: &'a [u8]) -> u32 {
        let groups = &mut self.model.groups;
        *self.groups.entry(name).or_insert_with(|| {
            groups.push(String::from_utf8_lossy(name).into_owned());
            to_u32(groups.len() - 1)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str, report: &mut Report) -> Result<Model, ReadError> {
        read_text(&Source { name: "test", folder: None, bytes: text.as_bytes() }, report)
    }

    /// A facet on seven lines.
    const FACET: &str = "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  \
                         vertex 0 1.5e0 -2\n endloop\nendfacet\n";

    #[test]
    fn every_facet_has_its_own_three_vertices() {
        let mut report = Report::default();
        let model = read(&format!("solid\n{FACET}{FACET}endsolid"), &mut report).unwrap();
        let triangle = [[0., 0., 0.], [1., 0., 0.], [0., 1.5, -2.]];
        assert_eq!(model.positions, [triangle, triangle].concat());
        assert_eq!(model.corner_positions, [0, 1, 2, 3, 4, 5]);
        assert_eq!(model.polygon_lines, [2, 9]);
        assert!(model.is_triangles() && model.groups.is_empty() && model.runs.is_empty());
        assert!(report.warnings().is_empty());
    }

    #[test]
    fn solids_are_groups_by_name() {
        let text = format!(
            "solid a b \r\n{FACET}endsolid a b\nSOLID c\n{FACET}{FACET}EndSolid\nsolid a b\n{FACET}\
             endsolid\nsolid\n{FACET}endsolid"
        );
        let mut report = Report::default();
        let model = read(&text.to_uppercase().replace("A B", "a b"), &mut report).unwrap();
        assert_eq!(model.groups, ["a b", "C"]);
        let runs = model.runs.iter().map(|run| (run.first_polygon, run.attributes.group));
        assert_eq!(runs.collect::<Vec<_>>(), [(0, 0), (1, 1), (3, 0), (4, NONE)]);
        assert!(report.warnings().is_empty());
    }

    #[test]
    fn normals_need_not_be_numbers() {
        for normal in ["normal nan -nan(ind) 1.#QNAN", "normal 0 0", "normal", ""] {
            let mut report = Report::default();
            let text = FACET.replace("normal 0 0 1", normal);
            assert_eq!(read(&text, &mut report).unwrap().polygon_count(), 1, "{normal}");
            assert!(report.warnings().is_empty(), "{normal}");
        }
        let one_line = FACET.replace('\n', " ");
        assert_eq!(read(&one_line, &mut Report::default()).unwrap().polygon_count(), 1);
    }

    #[test]
    fn coordinates_that_are_not_numbers_are_errors_with_their_line() {
        for (vertex, what) in [
            ("vertex 1 0 zero", "'zero' is not a number"),
            ("vertex 1 0,5 0", "'0,5' is not a number"),
            ("vertex 1 0", "fewer than three numbers"),
        ] {
            let text = FACET.replace("vertex 1 0 0", vertex);
            let error = read(&text, &mut Report::default()).unwrap_err();
            assert_eq!((error.kind, error.place), (ReadErrorKind::Number, Some(Place::Line(4))));
            assert!(error.what.contains(what), "{}", error.what);
        }
    }

    /// The number of facets, and the only warning as its code, count and line.
    fn facets_and_warning(text: &str) -> (usize, Option<(WarningCode, usize, u32)>) {
        let mut report = Report::default();
        let model = read(text, &mut report).unwrap();
        let warning = report.warnings().first().map(|warning| {
            let Some(Place::Line(line)) = warning.place else { panic!("{warning:?}") };
            (warning.code, warning.count, line)
        });
        assert!(report.warnings().len() < 2, "{report:?}");
        (model.polygon_count(), warning)
    }

    #[test]
    fn incomplete_facets_are_dropped_with_their_line() {
        use WarningCode::{Syntax, Truncated};
        let quad = FACET.replace(" endloop", "vertex 0 0 0\n endloop");
        let two = FACET.replace("  vertex 1 0 0\n", "");
        let open = FACET.replace("endfacet\n", "");
        for (text, expected) in [
            (format!("{FACET}{quad}{quad}{FACET}"), (2, Some((Syntax, 2, 8)))),
            (format!("{two}{FACET}"), (1, Some((Syntax, 1, 1)))),
            (format!("facet\nendfacet\n{FACET}"), (1, Some((Syntax, 1, 1)))),
            (format!("{FACET}color 1 2 vertex\n{FACET}"), (2, Some((Syntax, 1, 8)))),
            (format!("{open}{open}{FACET}"), (3, None)),
            (format!("{FACET}endfacet\n"), (1, None)),
            (format!("{FACET}{open}"), (1, Some((Truncated, 1, 8)))),
            (format!("{FACET}facet normal 0 0 1\nvertex 0 0"), (1, Some((Truncated, 1, 8)))),
            (format!("{FACET}facet normal 0 0 1\nvertex 0 1.5e-"), (1, Some((Truncated, 1, 8)))),
            (format!("\nsolid a\n{FACET}"), (1, Some((Truncated, 1, 2)))),
            (format!("solid a\nsolid b\n{FACET}endsolid"), (1, Some((Truncated, 1, 1)))),
        ] {
            assert_eq!(facets_and_warning(&text), expected, "{text}");
        }
    }

    #[test]
    fn a_whole_file_may_be_one_line() {
        let one = FACET.replace('\n', " ");
        for (text, groups, facets) in [
            (format!("solid a {one}{one}endsolid a"), vec!["a"], 2),
            (format!("solid {one}endsolid"), vec![], 1),
            (format!("solid a b {one}endsolid a b solid c {one}endsolid c\n"), vec!["a b", "c"], 2),
            (
                format!("SOLID facet normals {} ENDSOLID", one.to_uppercase()),
                vec!["facet normals"],
                1,
            ),
            (format!("solid facet normal map\n{FACET}endsolid\n"), vec!["facet normal map"], 1),
            (format!("solid a\n{FACET}endsolid a {one}"), vec!["a"], 2),
        ] {
            let mut report = Report::default();
            let model = read(&text, &mut report).unwrap();
            assert_eq!(
                (&model.groups, model.polygon_count()),
                (&groups.iter().map(|&g| g.into()).collect(), facets),
                "{text}"
            );
            assert_eq!(report, Report::default(), "{text}");
        }
    }

    #[test]
    fn vertices_that_are_not_finite_may_be_spelled_as_c_libraries_do() {
        let text = FACET.replace("vertex 1 0 0", "vertex -nan(ind) 1.#INF00 -1.#IND");
        let model = read(&text, &mut Report::default()).unwrap();
        assert!(model.positions[1].iter().all(|x| !x.is_finite()), "{:?}", model.positions);
    }

    #[test]
    fn many_solids_take_linear_time() {
        let on_a_line: String = (0..100_000).map(|k| format!("endsolid solid {k} ")).collect();
        let facet = FACET.replace('\n', " ");
        for text in [format!("{on_a_line}\n"), format!("solid {on_a_line}{facet}endsolid")] {
            assert!(read(&text, &mut Report::default()).unwrap().groups.len() < 3);
        }
        let text: String = (0..100_000).map(|k| format!("solid {k}\nendsolid\n")).collect();
        let model = read(&text, &mut Report::default()).unwrap();
        assert_eq!((model.groups.len(), model.polygon_count()), (100_000, 0));
    }
}
