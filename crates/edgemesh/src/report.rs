//! Warnings and repairs, as data beside the result.
//!
//! Defects that can be repaired are neither errors nor log lines: readers and builder count them
//! here, with the first place in the file, and the commands print each kind once. A *warning* says
//! that something was lost or is doubtful; a *repair* loses nothing.

use std::fmt;

/// A place in a file.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Place {
    /// A line of text, counted from 1.
    Line(u32),
    /// An offset in bytes.
    Byte(u64),
    /// A face, counted from 1.
    Face(u64),
    /// A vertex, counted from 1.
    Vertex(u64),
    /// A path in the structure of the file: `meshes[0].primitives[2]`.
    Part(String),
}

impl Place {
    /// The place behind the name of its file: `model.obj:12`, `model.stl: face 7`.
    #[must_use]
    pub(crate) fn behind(&self, file: &str) -> String {
        match self {
            Self::Line(line) => format!("{file}:{line}"),
            Self::Byte(offset) => format!("{file}: byte {offset}"),
            Self::Face(face) => format!("{file}: face {face}"),
            Self::Vertex(vertex) => format!("{file}: vertex {vertex}"),
            Self::Part(path) => format!("{file}: {path}"),
        }
    }
}

/// Writes `place` behind the name of its file; without a place, the name alone.
#[must_use]
pub(crate) fn place_in(file: &str, place: Option<&Place>) -> String {
    place.map_or_else(|| file.to_owned(), |place| place.behind(file))
}

/// The kind of a [`Warning`], displayed as the `code` of `--json`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum WarningCode {
    /// A vertex is NaN or infinite; faces that use it were dropped.
    NonFinite,
    /// The index of a texture coordinate or normal is out of range; it was left out.
    Index,
    /// A face has fewer than three different corners; it was dropped.
    Degenerate,
    /// A face repeats another, with the same vertices in the same order; it was dropped.
    Duplicate,
    /// A polygon crosses itself; it was cut as a fan.
    Crossing,
    /// More than two faces share an edge.
    NonManifold,
    /// A surface cannot be oriented, such as a Möbius strip; it was cut.
    Orientation,
    /// A material library or a texture is missing, unreadable, outside of the
    /// folder, or not PNG or JPEG.
    Material,
    /// Another file that the model names, or its file of marks, is missing, unreadable, or
    /// outside of the folder.
    Uri,
    /// A statement, node or extension of the file is not supported.
    Unsupported,
    /// The file is too short or too long; its complete elements are kept.
    Truncated,
    /// The file breaks a rule of its format, without harm.
    Syntax,
    /// A marked pair of vertices is not an edge of the mesh.
    Mark,
}

impl WarningCode {
    /// All codes, in order.
    pub const ALL: [Self; 13] = [
        Self::NonFinite,
        Self::Index,
        Self::Degenerate,
        Self::Duplicate,
        Self::Crossing,
        Self::NonManifold,
        Self::Orientation,
        Self::Material,
        Self::Uri,
        Self::Unsupported,
        Self::Truncated,
        Self::Syntax,
        Self::Mark,
    ];

    /// The code whose [`Self::as_str`] is `word`.
    #[must_use]
    pub(crate) fn from_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|code| code.as_str() == word)
    }

    /// The word in JSON; scripts rely on it.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::NonFinite => "nonfinite",
            Self::Index => "index",
            Self::Degenerate => "degenerate",
            Self::Duplicate => "duplicate",
            Self::Crossing => "crossing",
            Self::NonManifold => "nonmanifold",
            Self::Orientation => "orientation",
            Self::Material => "material",
            Self::Uri => "uri",
            Self::Unsupported => "unsupported",
            Self::Truncated => "truncated",
            Self::Syntax => "syntax",
            Self::Mark => "mark",
        }
    }
}

impl fmt::Display for WarningCode {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.as_str())
    }
}

/// All warnings of one kind, with the first place.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Warning {
    /// The kind.
    pub code: WarningCode,
    /// Affected elements.
    pub count: usize,
    /// The first affected element; `None` for the whole file.
    pub place: Option<Place>,
    /// The defect at `place`, and how it was handled.
    pub message: String,
}

/// The kind of a [`Repair`], written as a key of `--json`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum RepairKind {
    /// Faces flipped so that their component winds one way.
    FlippedFaces,
    /// Faces of closed surfaces that were inside out, turned outward.
    InsideOutFaces,
    /// Faces dropped because they are the backs of others.
    TwoSidedFaces,
    /// Concave polygons that were not cut as fans, which would overlap themselves.
    EarClippedPolygons,
    /// Triangles with no area, or with less than rounding can make; they were kept, with the plane
    /// of a neighbor.
    ZeroAreaTriangles,
    /// Edges of more than two faces that were split into pairs.
    SplitEdges,
    /// Vertices added because fans of faces met in a single point.
    SplitVertices,
    /// Vertices moved onto others, by welding with a tolerance or to close a seam.
    SnappedVertices,
    /// Corners added to polygons along whose sides vertices of others lie.
    ClosedJunctions,
    /// Models moved and scaled, because 32 bits would lose their detail; at most 1.
    Recentered,
}

impl RepairKind {
    /// All kinds, in order.
    pub const ALL: [Self; 10] = [
        Self::FlippedFaces,
        Self::InsideOutFaces,
        Self::TwoSidedFaces,
        Self::EarClippedPolygons,
        Self::ZeroAreaTriangles,
        Self::SplitEdges,
        Self::SplitVertices,
        Self::SnappedVertices,
        Self::ClosedJunctions,
        Self::Recentered,
    ];

    /// The kind whose [`Self::as_str`] is `word`.
    #[must_use]
    pub(crate) fn from_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.as_str() == word)
    }

    /// The word in JSON; scripts rely on it.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::FlippedFaces => "flipped_faces",
            Self::InsideOutFaces => "inside_out_faces",
            Self::TwoSidedFaces => "two_sided_faces",
            Self::EarClippedPolygons => "ear_clipped_polygons",
            Self::ZeroAreaTriangles => "zero_area_triangles",
            Self::SplitEdges => "split_edges",
            Self::SplitVertices => "split_vertices",
            Self::SnappedVertices => "snapped_vertices",
            Self::ClosedJunctions => "closed_junctions",
            Self::Recentered => "recentred",
        }
    }
}

/// All repairs of one kind, with the first place.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Repair {
    /// The kind.
    pub kind: RepairKind,
    /// Repaired elements.
    pub count: usize,
    /// The first repaired element; `None` for the whole file.
    pub place: Option<Place>,
}

/// The warnings and repairs of reading a file and building its edge mesh.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Report {
    /// One entry for each code, ordered by code.
    warnings: Vec<Warning>,
    /// One entry for each kind, ordered by kind.
    repairs: Vec<Repair>,
}

impl Report {
    /// The report of stored warnings and repairs; entries of the same code or kind become
    /// one.
    pub(crate) fn from_parts(
        warnings: impl IntoIterator<Item = Warning>,
        repairs: impl IntoIterator<Item = Repair>,
    ) -> Self {
        let mut report = Self::default();
        report.absorb(Self {
            warnings: warnings.into_iter().collect(),
            repairs: repairs.into_iter().collect(),
        });
        report
    }

    /// Counts one `code`; the first call for a code sets place and message.
    pub(crate) fn warn(
        &mut self,
        code: WarningCode,
        place: Option<Place>,
        message: impl FnOnce() -> String,
    ) {
        self.warn_many(code, 1, place, message);
    }

    /// Counts `count` of `code`; the first call for a code sets place and message.
    pub(crate) fn warn_many(
        &mut self,
        code: WarningCode,
        count: usize,
        place: Option<Place>,
        message: impl FnOnce() -> String,
    ) {
        if count == 0 {
            return;
        }
        match self.warnings.binary_search_by_key(&code, |warning| warning.code) {
            Ok(found) => {
                let sum = &mut self.warnings[found].count;
                *sum = sum.saturating_add(count);
            }
            Err(at) => {
                self.warnings.insert(at, Warning { code, count, place, message: message() });
            }
        }
    }

    /// Counts `count` repairs of `kind`; the first call for a kind sets the place.
    pub(crate) fn repair(&mut self, kind: RepairKind, count: usize, place: Option<Place>) {
        if count == 0 {
            return;
        }
        match self.repairs.binary_search_by_key(&kind, |repair| repair.kind) {
            Ok(found) => {
                let sum = &mut self.repairs[found].count;
                *sum = sum.saturating_add(count);
            }
            Err(at) => self.repairs.insert(at, Repair { kind, count, place }),
        }
    }

    /// Adds all warnings and repairs of another report.
    pub(crate) fn absorb(&mut self, other: Self) {
        for Warning { code, count, place, message } in other.warnings {
            self.warn_many(code, count, place, || message);
        }
        for Repair { kind, count, place } in other.repairs {
            self.repair(kind, count, place);
        }
    }

    /// Adds the warnings of a later part of the file, which begins after `lines_before` lines.
    pub(crate) fn append(&mut self, later: Self, lines_before: u32) {
        for Warning { code, count, place, message } in later.warnings {
            let place = place.map(|place| match place {
                Place::Line(line) => Place::Line(line.saturating_add(lines_before)),
                other => other,
            });
            self.warn_many(code, count, place, || message);
        }
    }

    /// The warnings, one for each code, ordered by code.
    #[must_use]
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// A line for each warning: the first place in `file`, `level` (such as `warning: `), the
    /// message, the number of further elements, and the code.
    #[must_use]
    pub fn warning_lines(&self, file: &str, level: &str) -> Vec<String> {
        let line = |Warning { code, count, place, message }: &Warning| {
            let more = match count {
                1 => String::new(),
                count => format!(" (and {} more)", count - 1),
            };
            format!("{}: {level}{message}{more} [{code}]", place_in(file, place.as_ref()))
        };
        self.warnings.iter().map(line).collect()
    }

    /// The repairs, one for each kind, ordered by kind.
    #[must_use]
    pub fn repairs(&self) -> &[Repair] {
        &self.repairs
    }

    /// The number of elements that warnings with `code` affect.
    #[must_use]
    pub fn count(&self, code: WarningCode) -> usize {
        self.warnings.iter().find(|warning| warning.code == code).map_or(0, |warning| warning.count)
    }

    /// The number of repairs of `kind`.
    #[must_use]
    pub fn repair_count(&self, kind: RepairKind) -> usize {
        self.repairs.iter().find(|repair| repair.kind == kind).map_or(0, |repair| repair.count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn first_place_is_kept_and_all_are_counted() {
        let mut report = Report::default();
        report.warn(WarningCode::Unsupported, Some(Place::Line(9)), || "curve".into());
        report.warn(WarningCode::Degenerate, Some(Place::Line(3)), || "first".into());
        report.warn(WarningCode::Degenerate, Some(Place::Line(5)), || "second".into());
        assert_eq!(report.count(WarningCode::Degenerate), 2);
        assert_eq!(report.warnings()[0].place, Some(Place::Line(3)), "ordered, first place kept");
        assert_eq!(report.warnings()[0].message, "first");
        assert_eq!(report.count(WarningCode::Material), 0);
    }

    #[test]
    fn repairs_are_no_warnings() {
        let mut report = Report::default();
        report.repair(RepairKind::SplitVertices, 0, None);
        report.repair(RepairKind::FlippedFaces, 2, Some(Place::Face(4)));
        report.repair(RepairKind::FlippedFaces, 1, Some(Place::Face(1)));
        assert!(report.warnings().is_empty());
        let [only] = report.repairs() else { panic!("{report:?}") };
        assert_eq!((only.count, only.place.clone()), (3, Some(Place::Face(4))));
        assert_eq!(report.repair_count(RepairKind::SplitVertices), 0);
    }

    #[test]
    fn codes_and_kinds_are_known_by_their_words() {
        for code in WarningCode::ALL {
            assert_eq!(WarningCode::from_word(code.as_str()), Some(code));
        }
        for kind in RepairKind::ALL {
            assert_eq!(RepairKind::from_word(kind.as_str()), Some(kind));
        }
        assert!(WarningCode::ALL.is_sorted() && RepairKind::ALL.is_sorted());
        assert_eq!(WarningCode::from_word("Index"), None);
    }

    #[test]
    fn stored_parts_become_the_report_that_they_were() {
        let mut report = Report::default();
        report.warn_many(WarningCode::Index, 3, Some(Place::Line(2)), || "one".into());
        report.warn(WarningCode::NonFinite, None, || "two".into());
        report.repair(RepairKind::SplitEdges, 4, None);
        let warnings = report.warnings().iter().rev().cloned();
        assert_eq!(Report::from_parts(warnings, report.repairs().to_vec()), report);
    }

    #[test]
    fn places_stand_behind_the_file() {
        assert_eq!(place_in("a.obj", Some(&Place::Line(3))), "a.obj:3");
        assert_eq!(place_in("a.stl", Some(&Place::Byte(84))), "a.stl: byte 84");
        assert_eq!(place_in("a.glb", None), "a.glb");
    }
}
