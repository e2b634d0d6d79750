//! Classifies all edges of a mesh in a view, and counts the features of each class.

use std::ops::{Index, IndexMut};

use glam::Vec4;
use serde::{Serialize, Serializer};

use crate::edge_mesh::{EdgeFlags, EdgeMesh, EdgeRecord};
use crate::index::NONE;
use crate::line::{ClassTable, LineClass};
use crate::view::facing::faces_eye;
use crate::view::feature::{EdgeFaces, Line, LineBits, classify_edge, eye_is_outside};

/// The number of edges of each class in a view. An edge can be of several classes; edges of more
/// than two faces are not counted.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct FeatureCounts(pub [u32; LineClass::COUNT]);

impl FeatureCounts {
    /// The classes in the order of JSON.
    pub(crate) const IN_REPORTS: [LineClass; LineClass::COUNT] = [
        LineClass::Contour,
        LineClass::Ridge,
        LineClass::Valley,
        LineClass::Boundary,
        LineClass::Marked,
        LineClass::Material,
        LineClass::Smoothing,
    ];
}

impl Index<LineClass> for FeatureCounts {
    type Output = u32;

    fn index(&self, class: LineClass) -> &u32 {
        &self.0[class as usize]
    }
}

impl IndexMut<LineClass> for FeatureCounts {
    fn index_mut(&mut self, class: LineClass) -> &mut u32 {
        &mut self.0[class as usize]
    }
}

impl Serialize for FeatureCounts {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(Self::IN_REPORTS.map(|class| (class.name(), self[class])))
    }
}

/// Whether each face looks at `eye` (w = 1), or at the viewer in that direction (w = 0).
#[must_use]
pub fn facing_bits(mesh: &EdgeMesh, eye: Vec4) -> Vec<bool> {
    mesh.face_planes.iter().map(|plane| faces_eye(plane, eye)).collect()
}

/// Classifies all records of a mesh, in order, with all classes in one layer.
#[must_use]
pub fn classify_edges(mesh: &EdgeMesh, eye: Vec4) -> Vec<LineBits> {
    let outside = eye_is_outside(eye, mesh.bounds.min.into(), mesh.bounds.max.into());
    let lines = classify_lines(mesh, eye, &ClassTable::all_in_one(), outside);
    lines.into_iter().map(|line| line.bits).collect()
}

/// Classifies all records of a mesh, in order.
///
/// `eye` has w = 1, or is the direction to the viewer with w = 0.
#[must_use]
pub fn classify_lines(
    mesh: &EdgeMesh,
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
    let line =
        |record: &EdgeRecord| classify_edge(record.word, faces_of(record), table, eye_is_outside);
    mesh.records.iter().map(line).collect()
}

/// Counts the feature edges of each class, seen by `eye` (w = 1), or from that direction (w = 0).
#[must_use]
pub fn count_features(mesh: &EdgeMesh, eye: Vec4) -> FeatureCounts {
    let mut counts = FeatureCounts::default();
    for (record, bits) in mesh.records.iter().zip(classify_edges(mesh, eye)) {
        if record.flags().intersects(EdgeFlags::NON_MANIFOLD | EdgeFlags::PAIRED) {
            continue;
        }
        counts[LineClass::Contour] += u32::from(bits.contains(LineBits::CONTOUR));
        for class in LineClass::ALL {
            counts[class] += u32::from(record.flags().intersects(class.counted_by()));
        }
    }
    counts
}
