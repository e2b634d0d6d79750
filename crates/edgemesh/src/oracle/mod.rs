//! The CPU twin of the shaders: the same decisions and corners, function by
//! function, with the same names and argument order.
//!
//! | here | `shaders/common/` | paper |
//! |---|---|---|
//! | [`facing`] | `facing.wgsl` | Equation 1, the sign of one face |
//! | [`feature`] | `feature.wgsl` | Equation 1 |
//! | [`normal_cone`] | `normal_cone.wgsl` | faces that all look one way (not in the paper) |
//! | [`spine`] | `spine.wgsl` | section 3.3, projection; section 6, clipping |
//! | [`stroke_quad`] | `stroke_quad.wgsl` | Equations 2 and 3 |
//! | [`stroke_cap`] | `stroke_cap.wgsl` | Equations 4 and 5; section 6, half disks |
//! | [`stroke_segment`] | `stroke_segment.wgsl` | what the vertices of an edge share; section 4 |
//! | [`stroke_vertex`] | `stroke_vertex.wgsl` | one vertex of it |
//!
//! Detectors of edges in images are in [`detector`].
//!
//! A GPU test runs both over thousands of random and adversarial edges; the
//! counts of [`count_features`] are what `edgemesh info` prints and what the
//! GPU's own counts must equal.

pub mod contour_chain;
pub mod detector;
pub mod facing;
pub mod feature;
pub mod layer_chain;
pub mod normal_cone;
pub mod spine;
pub mod stroke_cap;
pub mod stroke_quad;
pub mod stroke_segment;
pub mod stroke_vertex;

use glam::Vec4;

use crate::edge_mesh::EdgeMesh;
use crate::edge_word::{EdgeWord, edge_words};
use crate::index::NONE;
use crate::record::{EdgeFlags, EdgeRecord};
use facing::faces_eye;
use feature::{ClassTable, EdgeClass, EdgeFaces, Line, LineBits, classify_edge, eye_is_outside};

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
    pub const fn of(&self, class: EdgeClass) -> u32 {
        match class {
            EdgeClass::Contour => self.contour,
            EdgeClass::Marked => self.marked,
            EdgeClass::Boundary => self.boundary,
            EdgeClass::Material => self.material,
            EdgeClass::Smoothing => self.smoothing,
            EdgeClass::Ridge => self.ridge,
            EdgeClass::Valley => self.valley,
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
