//! The visibility of edges, as defined by `EXT_mesh_primitive_edge_visibility`.
//!
//! Based on: the extension as merged in May 2026 (`KhronosGroup/glTF`, pull
//! request 2479). Earlier drafts differ.
//!
//! ```text
//! 0---3   triangles (0 1 2) (0 2 3), edges in order: 01 12 20  02 23 30
//! |\  |                                     values:   2  0  1   0  2  0
//! | \ |                                     bytes, lowest bits first:
//! 1---2                                              |-- 18 ---|  |- 2
//!
//! 0 never drawn, or in a line string   1 silhouette: drawn if one face is a front face
//! 2 hard: drawn in every view          3 hard, the same edge as a 2 before
//! ```
//!
//! Consecutive hard edges of a chain become line strings, which preserve the chain;
//! single hard edges become values. A line string ends where its chain continues with
//! a line without a face. Of an edge of more than two faces only the first record may
//! be in a line string, so that each edge is written once.
//!
//! Rejected: normals in bytes, which the extension recommends. They have errors of up to
//! 0.4 degrees, and silhouettes would flicker.

use glam::{Vec3, Vec4Swizzles as _};

use super::edge_records::{edges, hard_classes, link_ends, welded_ends};
use crate::edge_mesh::{
    CHAIN_CLASSES, ChainLink, EdgeFlags, EdgeMesh, EdgeRecord, chain_class_of, side_on,
};
use crate::index::NONE;

const SILHOUETTE: u8 = 1;
const HARD: u8 = 2;
const HARD_AGAIN: u8 = 3;

/// The largest difference of unit normals that count as equal: some units in the last
/// place of 32 bits, an angle of 0.2 arc seconds.
const SAME_NORMAL: f32 = 1e-6;

/// The index between two line strings.
pub(super) const RESTART: u32 = NONE;

/// The visibility of the edges of a mesh.
#[derive(Debug, Default, PartialEq)]
pub(super) struct EdgeVisibility {
    /// A value for each side of each triangle, three for a triangle.
    pub(super) values: Vec<u8>,
    /// For each value 1, in order, the normals of its face and of the face across.
    pub(super) silhouette_normals: Vec<[[f32; 3]; 2]>,
    /// For each value 2, in order, the classes of the edge.
    pub(super) hard_classes: Vec<ClassRun>,
    /// The hard edges that are not in `values`, for each class.
    pub(super) line_strings: Vec<LineStrings>,
}

/// Line strings of one class.
#[derive(Debug, Default, PartialEq)]
pub(super) struct LineStrings {
    /// The class of their chains.
    pub(super) class: EdgeFlags,
    /// Vertices, with [`RESTART`] between the line strings.
    pub(super) indices: Vec<u32>,
    /// The classes of their edges, in order.
    pub(super) edge_classes: Vec<ClassRun>,
}

/// Consecutive edges with the same classes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ClassRun {
    /// The number of edges.
    pub(super) count: usize,
    /// Their classes.
    pub(super) classes: EdgeFlags,
}

impl EdgeVisibility {
    /// The visibility of the edges of `mesh`.
    pub(super) fn of(mesh: &EdgeMesh) -> Self {
        let (line_strings, is_in_line) = line_strings(mesh);
        let mut values = vec![0; 3 * mesh.triangles.len()];
        let mut hard = Vec::new();
        let mut silhouettes = Vec::new();
        let mut end = 0;
        for records in edges(mesh) {
            let first = end;
            end += records.len();
            let sides = || sides_of(mesh, records);
            let Some(side) = sides().min().filter(|_| !is_in_line[first]) else { continue };
            let classes = hard_classes(records);
            if !classes.is_empty() {
                sides().for_each(|side| values[side] = HARD_AGAIN);
                values[side] = HARD;
                hard.push((side, classes));
            } else if let Some(normals) = contour_normals(mesh, &records[0], side) {
                values[side] = SILHOUETTE;
                silhouettes.push((side, normals));
            }
        }
        hard.sort_unstable_by_key(|(side, _)| *side);
        silhouettes.sort_unstable_by_key(|(side, _)| *side);
        Self {
            values,
            silhouette_normals: silhouettes.into_iter().map(|(_, normals)| normals).collect(),
            hard_classes: runs(hard.into_iter().map(|(_, classes)| classes)),
            line_strings,
        }
    }

    /// Whether no view draws an edge.
    pub(super) fn is_empty(&self) -> bool {
        self.line_strings.is_empty() && !self.has_values()
    }

    /// Whether any value is not 0.
    pub(super) fn has_values(&self) -> bool {
        self.values.iter().any(|&value| value != 0)
    }

    /// The values, four in a byte, the first in the lowest bits.
    pub(super) fn packed(&self) -> impl Iterator<Item = u8> {
        let byte = |values: &[u8]| values.iter().rev().fold(0, |byte, value| byte << 2 | value);
        self.values.chunks(4).map(byte)
    }
}

/// The sides of triangles on an edge, as indices of `values`.
fn sides_of(mesh: &EdgeMesh, records: &[EdgeRecord]) -> impl Iterator<Item = usize> {
    records.iter().flat_map(|record| {
        let faces = [record.face_a, record.face_b].into_iter().filter(|&face| face != NONE);
        faces.filter_map(|face| Some((3 * face + side_on(mesh, face, record)?) as usize))
    })
}

/// The normals of the faces of an edge that may be a contour, first that of the face
/// with `side`; `None` if the faces are coplanar, or one has no area and so no plane.
///
/// If the windings clash, the normal of face B is reversed.
fn contour_normals(mesh: &EdgeMesh, record: &EdgeRecord, side: usize) -> Option<[[f32; 3]; 2]> {
    let normal = |face: u32| {
        let plane = mesh.face_planes.get(face as usize)?;
        let normal = glam::Vec4::from(plane.normal).xyz();
        (normal != Vec3::ZERO).then_some(normal)
    };
    let sign = if record.flags().contains(EdgeFlags::CLASH) { -1.0 } else { 1.0 };
    let [a, b] = [normal(record.face_a)?, normal(record.face_b)? * sign];
    if (a - b).length() <= SAME_NORMAL {
        return None;
    }
    let is_in_a = side / 3 == record.face_a as usize;
    Some(if is_in_a { [a, b] } else { [b, a] }.map(Into::into))
}

/// The line strings of a mesh for each class, and whether each record is in one.
fn line_strings(mesh: &EdgeMesh) -> (Vec<LineStrings>, Vec<bool>) {
    let mut is_in_line = vec![false; mesh.records.len()];
    let mut by_class = CHAIN_CLASSES.map(|class| LineStrings { class, ..LineStrings::default() });
    for chain in &mesh.chains.chains {
        let Some(class) = chain_class_of(chain.class) else { continue };
        let links = &mesh.chains.links[chain.link_range()];
        let is_joined =
            |a: &ChainLink, b: &ChainLink| may_be_in_line(mesh, a) && may_be_in_line(mesh, b);
        for line in links.chunk_by(is_joined).filter(|line| line.len() > 1) {
            line.iter().for_each(|link| is_in_line[link.record as usize] = true);
            by_class[class].push(mesh, line);
        }
    }
    let strings = by_class.into_iter().filter(|strings| !strings.indices.is_empty());
    (strings.collect(), is_in_line)
}

/// Whether a link may be in a line string: it is the first record of an edge of a
/// triangle.
fn may_be_in_line(mesh: &EdgeMesh, link: &ChainLink) -> bool {
    let at = link.record as usize;
    let record = &mesh.records[at];
    let before = at.checked_sub(1).map(|before| welded_ends(mesh, &mesh.records[before]));
    record.face_a != NONE && before != Some(welded_ends(mesh, record))
}

impl LineStrings {
    fn push(&mut self, mesh: &EdgeMesh, line: &[ChainLink]) {
        if !self.indices.is_empty() {
            self.indices.push(RESTART);
        }
        for (at, link) in line.iter().enumerate() {
            let [start, end] = link_ends(mesh, link);
            if at == 0 {
                self.indices.push(start);
            }
            self.indices.push(end);
            push_run(&mut self.edge_classes, classes_from(mesh, link.record as usize));
        }
    }
}

/// The classes of the edge with this first record.
fn classes_from(mesh: &EdgeMesh, first: usize) -> EdgeFlags {
    let ends = welded_ends(mesh, &mesh.records[first]);
    let same = |record: &&EdgeRecord| welded_ends(mesh, record) == ends;
    let count = mesh.records[first..].iter().take_while(same).count();
    hard_classes(&mesh.records[first..first + count])
}

fn runs(classes: impl Iterator<Item = EdgeFlags>) -> Vec<ClassRun> {
    let mut runs = Vec::new();
    classes.for_each(|classes| push_run(&mut runs, classes));
    runs
}

fn push_run(runs: &mut Vec<ClassRun>, classes: EdgeFlags) {
    match runs.last_mut() {
        Some(last) if last.classes == classes => last.count += 1,
        _ => runs.push(ClassRun { count: 1, classes }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::{BuildOptions, build_edge_mesh};
    use crate::model::Model;
    use crate::report::Report;

    fn build(positions: &[[f32; 3]], polygons: &[&[u32]]) -> EdgeMesh {
        let model = Model::from_polygons(positions, polygons);
        build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default())
    }

    fn visibility(positions: &[[f32; 3]], polygons: &[&[u32]]) -> EdgeVisibility {
        EdgeVisibility::of(&build(positions, polygons))
    }

    const SQUARE: [[f32; 3]; 4] = [[0., 1., 0.], [0., 0., 0.], [1., 0., 0.], [1., 1., 0.]];

    #[test]
    fn four_values_in_a_byte_the_first_lowest() {
        let packed = |values: &[u8]| -> Vec<u8> {
            let values = values.to_vec();
            EdgeVisibility { values, ..EdgeVisibility::default() }.packed().collect()
        };
        assert_eq!(packed(&[2, 0, 1, 0, 2, 0]), [18, 2]);
        assert_eq!(packed(&[2, 0, 2, 3, 2, 0]), [226, 2]);
        assert_eq!(packed(&[3; 12]), [255; 3]);
        assert_eq!(packed(&[3, 0, 0]), [3], "spare bits are 0");
        assert_eq!(packed(&[]), [0; 0]);
    }

    #[test]
    fn the_diagonal_of_a_square_is_never_drawn() {
        // The corners are too sharp for chains, so every edge is single.
        let flat = visibility(&SQUARE, &[&[0, 1, 2, 3]]);
        assert_eq!(flat.values, [2, 2, 0, 0, 2, 2]);
        assert_eq!(flat.hard_classes, [ClassRun { count: 4, classes: EdgeFlags::BOUNDARY }]);
        assert!(flat.silhouette_normals.is_empty() && flat.line_strings.is_empty());
        assert!(flat.has_values() && !flat.is_empty());
    }

    #[test]
    fn rounding_errors_do_not_bend_a_diagonal() {
        let mut mesh = build(&SQUARE, &[&[0, 1, 2, 3]]);
        for (x, value) in [(0.0, 0), (5e-7, 0), (5e-6, 1), (-1.0, 1)] {
            mesh.face_planes[1].normal[0] = x;
            assert_eq!(EdgeVisibility::of(&mesh).values, [2, 2, value, 0, 2, 2], "{x}");
        }
        mesh.face_planes[1].normal = [0.0; 4];
        assert_eq!(EdgeVisibility::of(&mesh).values, [2, 2, 0, 0, 2, 2], "no plane");
    }

    #[test]
    fn a_bent_diagonal_may_be_a_silhouette_and_a_fold_is_hard() {
        let mut bent = SQUARE;
        bent[3][2] = 0.1;
        let polygon = visibility(&bent, &[&[0, 1, 2, 3]]);
        assert_eq!(polygon.values, [2, 2, 1, 0, 2, 2]);
        let [[near, across]] = polygon.silhouette_normals[..] else { panic!("{polygon:?}") };
        assert_eq!(near, [0., 0., 1.]);
        assert!(across[0] < -0.05 && across[1] < -0.05 && across[2] > 0.9, "{across:?}");
        bent[3][2] = 5.0;
        let fold = visibility(&bent, &[&[0, 1, 2], &[0, 2, 3]]);
        assert_eq!(fold.values, [2, 2, 2, 3, 2, 2]);
        let classes = [EdgeFlags::BOUNDARY, EdgeFlags::VALLEY, EdgeFlags::BOUNDARY];
        let counts = [2, 1, 2].into_iter().zip(classes);
        let expected: Vec<ClassRun> =
            counts.map(|(count, classes)| ClassRun { count, classes }).collect();
        assert_eq!(fold.hard_classes, expected);
    }

    #[test]
    fn chains_become_line_strings() {
        // Two squares side by side: their long sides are lines of two edges.
        let positions: Vec<[f32; 3]> =
            (0..6_u8).map(|k| [f32::from(k / 2), f32::from(k % 2), 0.0]).collect();
        let strip = visibility(&positions, &[&[0, 2, 3, 1], &[2, 4, 5, 3]]);
        let [lines] = &strip.line_strings[..] else { panic!("{strip:?}") };
        assert_eq!(lines.class, EdgeFlags::BOUNDARY);
        assert_eq!(lines.indices, [0, 2, 4, RESTART, 5, 3, 1]);
        assert_eq!(lines.edge_classes, [ClassRun { count: 4, classes: EdgeFlags::BOUNDARY }]);
        // The short sides are 1-0, the last one of its quad, and 4-5.
        assert_eq!(strip.values, [0, 0, 0, 0, 0, 2, 0, 2, 0, 0, 0, 0]);
    }

    #[test]
    fn an_edge_of_three_faces_is_drawn_once() {
        let positions = [[0., 0., 0.], [0., 0., 1.], [1., 0., 0.], [0., 1., 0.], [-1., -1., 0.]];
        let fan = visibility(&positions, &[&[0, 1, 2], &[0, 1, 3], &[1, 0, 4]]);
        assert_eq!(fan.values[..9].iter().filter(|&&value| value == HARD_AGAIN).count(), 2);
        assert_eq!((fan.values[0], fan.values[3], fan.values[6]), (2, 3, 3));
    }
}
