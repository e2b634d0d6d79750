//! Which edges of a mesh are features of a view, all at once, and how many of each class.

use glam::Vec4;

use crate::edge_mesh::EdgeMesh;
use crate::edge_mesh::edge_word::{EdgeWord, edge_words};
use crate::edge_mesh::record::{EdgeFlags, EdgeRecord};
use crate::index::NONE;
use crate::line::class::{ClassTable, LineClass};
use crate::view::facing::faces_eye;
use crate::view::feature::{EdgeFaces, Line, LineBits, classify_edge, eye_is_outside};

/// How many edges belong to each class in a view; an edge can be in several.
/// Edges that more than two faces share are in none.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "command", derive(serde::Serialize))]
pub struct FeatureCounts {
    /// One face toward the eye, the other away.
    pub contour: u32,
    /// Convex creases.
    pub ridge: u32,
    /// Concave creases.
    pub valley: u32,
    /// Edges of one face.
    pub boundary: u32,
    /// Edges that the artist chose.
    pub marked: u32,
    /// Edges between two materials.
    pub material: u32,
    /// Edges between two smoothing groups.
    pub smoothing: u32,
}

impl FeatureCounts {
    /// The count of a class.
    #[must_use]
    pub const fn of(&self, class: LineClass) -> u32 {
        match class {
            LineClass::Contour => self.contour,
            LineClass::Marked => self.marked,
            LineClass::Boundary => self.boundary,
            LineClass::Material => self.material,
            LineClass::Smoothing => self.smoothing,
            LineClass::Ridge => self.ridge,
            LineClass::Valley => self.valley,
        }
    }
}

/// One facing bit a face: whether it faces `eye` (w = 1), or the direction to
/// the viewer (w = 0).
#[must_use]
pub fn facing_bits(mesh: &EdgeMesh, eye: Vec4) -> Vec<bool> {
    mesh.face_planes.iter().map(|plane| faces_eye(plane, eye)).collect()
}

/// What a view makes of every record, in order; all classes in one layer.
#[must_use]
pub fn classify_edges(mesh: &EdgeMesh, eye: Vec4) -> Vec<LineBits> {
    let words = edge_words(mesh);
    let outside = eye_is_outside(eye, mesh.bounds.min.into(), mesh.bounds.max.into());
    let lines = classify_lines(mesh, &words, eye, &ClassTable::all_in_one(), outside);
    lines.into_iter().map(|line| line.bits).collect()
}

/// What a view makes of every record with its word, in order.
#[must_use]
pub fn classify_lines(
    mesh: &EdgeMesh,
    words: &[EdgeWord],
    eye: Vec4,
    table: &ClassTable,
    eye_is_outside: bool,
) -> Vec<Line> {
    let facing = facing_bits(mesh, eye);
    let faces_of = |record: &EdgeRecord| {
        let faces = |face: u32| face != NONE && facing[face as usize];
        let (a_faces, b_faces) = (faces(record.face_a), faces(record.face_b));
        EdgeFaces { has_b: record.face_b != NONE, a_faces, b_faces }
    };
    let edges = mesh.records.iter().zip(words);
    edges
        .map(|(record, &word)| classify_edge(word, faces_of(record), table, eye_is_outside))
        .collect()
}

/// Counts the feature edges of a view, class by class.
#[must_use]
pub fn count_features(mesh: &EdgeMesh, eye: Vec4) -> FeatureCounts {
    let mut counts = FeatureCounts::default();
    for (record, bits) in mesh.records.iter().zip(classify_edges(mesh, eye)) {
        if record.flags.contains(EdgeFlags::NON_MANIFOLD) {
            continue;
        }
        let has = |class: EdgeFlags| u32::from(record.flags.contains(class));
        counts.contour += u32::from(bits.contains(LineBits::CONTOUR));
        counts.ridge += has(EdgeFlags::RIDGE);
        counts.valley += has(EdgeFlags::VALLEY);
        counts.boundary += has(EdgeFlags::BOUNDARY);
        counts.marked += has(EdgeFlags::MARKED);
        counts.material += has(EdgeFlags::MATERIAL);
        counts.smoothing += has(EdgeFlags::SMOOTHING);
    }
    counts
}
