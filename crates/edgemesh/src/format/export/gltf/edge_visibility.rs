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
//! Consecutive hard edges of a chain become line strings, which preserve the chain; single hard
//! edges become values. A line string ends where its chain continues with a line without a face,
//! and where the primitive changes. Of an edge of more than two faces only the first record may be
//! in a line string, so that each edge is written once.
//!
//! Rejected: normals in bytes, which the extension recommends. They have errors of up to
//! 0.4 degrees, and silhouettes would flicker.

use glam::{Vec3, Vec4Swizzles as _};

use super::super::edge_records::{classes_of_records, edges, hard_classes, welded_ends};
use super::faces::PrimitiveFaces;
use crate::edge_mesh::{
    CHAIN_CLASSES, ChainLink, EdgeFlags, EdgeMesh, EdgeRecord, chain_class_of, side_on,
};
use crate::index::NONE;

/// The name of the extension.
pub(super) const EXTENSION: &str = "EXT_mesh_primitive_edge_visibility";

const SILHOUETTE: u8 = 1;
const HARD: u8 = 2;
const HARD_AGAIN: u8 = 3;

/// The largest difference of unit normals that count as equal: some units in the last
/// place of 32 bits, an angle of 0.2 arc seconds.
const SAME_NORMAL: f32 = 1e-6;

/// The index between two line strings.
pub(super) const RESTART: u32 = NONE;

/// The visibility of the edges of a primitive.
#[derive(Debug, Default, PartialEq)]
pub(super) struct EdgeVisibility {
    /// A value for each side of each triangle, three for a triangle.
    pub(super) values: Vec<u8>,
    /// For each value 1, in order, the normals of its face and of the face across.
    pub(super) silhouette_normals: Vec<[[f32; 3]; 2]>,
    /// For each value 1, in order, whether the edge is the diagonal of a polygon.
    pub(super) silhouette_classes: Vec<ClassRun>,
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

/// A silhouette edge: its side, its normals, its classes.
type Silhouette = (usize, [[f32; 3]; 2], EdgeFlags);

/// The edges of a primitive that are no line strings, before they are sorted by side.
#[derive(Debug, Default)]
struct SingleEdges {
    values: Vec<u8>,
    hard: Vec<(usize, EdgeFlags)>,
    silhouettes: Vec<Silhouette>,
}

impl EdgeVisibility {
    /// The visibility of the edges of `mesh` in each primitive. `corners` are the vertices of its
    /// triangles in the file.
    pub(super) fn of(mesh: &EdgeMesh, faces: &PrimitiveFaces, corners: &[[u32; 3]]) -> Vec<Self> {
        let (line_strings, is_in_line) = line_strings(mesh, faces, corners);
        let singles = single_edges(mesh, faces, &is_in_line);
        singles
            .into_iter()
            .zip(line_strings)
            .map(|(edges, lines)| Self::new(edges, lines))
            .collect()
    }

    fn new(edges: SingleEdges, line_strings: Vec<LineStrings>) -> Self {
        let SingleEdges { values, mut hard, mut silhouettes } = edges;
        hard.sort_unstable_by_key(|(side, _)| *side);
        silhouettes.sort_unstable_by_key(|(side, ..)| *side);
        Self {
            values,
            silhouette_normals: silhouettes.iter().map(|(_, normals, _)| *normals).collect(),
            silhouette_classes: runs(silhouettes.into_iter().map(|(.., classes)| classes)),
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

/// The edges of each primitive that are in no line string. An edge between primitives belongs to
/// the first of them.
fn single_edges(mesh: &EdgeMesh, faces: &PrimitiveFaces, is_in_line: &[bool]) -> Vec<SingleEdges> {
    let empty = |primitive: usize| SingleEdges {
        values: vec![0; 3 * faces.of(primitive).len()],
        ..SingleEdges::default()
    };
    let mut singles: Vec<SingleEdges> = (0..faces.len()).map(empty).collect();
    let mut end = 0;
    for records in edges(mesh) {
        let first = end;
        end += records.len();
        let sides = || sides_of(mesh, faces, records);
        let Some((primitive, side)) = sides().min().filter(|_| !is_in_line[first]) else {
            continue;
        };
        let classes = hard_classes(records);
        if !classes.is_empty() {
            sides().for_each(|(primitive, side)| singles[primitive].values[side] = HARD_AGAIN);
            singles[primitive].values[side] = HARD;
            singles[primitive].hard.push((side, classes));
        } else {
            let face = faces.of(primitive)[side / 3];
            if let Some(normals) = contour_normals(mesh, &records[0], face) {
                singles[primitive].values[side] = SILHOUETTE;
                let classes = records[0].flags() & EdgeFlags::DIAGONAL;
                singles[primitive].silhouettes.push((side, normals, classes));
            }
        }
    }
    singles
}

/// The sides of triangles on an edge: a primitive and an index of its `values`.
fn sides_of(
    mesh: &EdgeMesh,
    faces: &PrimitiveFaces,
    records: &[EdgeRecord],
) -> impl Iterator<Item = (usize, usize)> {
    records.iter().flat_map(move |record| {
        let own = [record.face_a, record.face_b].into_iter().filter(|&face| face != NONE);
        own.filter_map(move |face| {
            Some((faces.primitive(face), faces.side(face, side_on(mesh, face, record)?)))
        })
    })
}

/// The normals of the faces of an edge that may be a contour, first that of `own`; `None` if the
/// faces are coplanar, or one has no area and so no plane.
///
/// If the windings clash, the normal of face B is reversed.
fn contour_normals(mesh: &EdgeMesh, record: &EdgeRecord, own: u32) -> Option<[[f32; 3]; 2]> {
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
    Some(if own == record.face_a { [a, b] } else { [b, a] }.map(Into::into))
}

/// The line strings of each primitive for each class, and whether each record is in one.
fn line_strings(
    mesh: &EdgeMesh,
    faces: &PrimitiveFaces,
    corners: &[[u32; 3]],
) -> (Vec<Vec<LineStrings>>, Vec<bool>) {
    let of_record = classes_of_records(mesh);
    let mut is_in_line = vec![false; mesh.records.len()];
    let by_class = || CHAIN_CLASSES.map(|class| LineStrings { class, ..LineStrings::default() });
    let mut strings: Vec<_> = (0..faces.len()).map(|_| by_class()).collect();
    let primitive = |link: &ChainLink| faces.primitive(mesh.records[link.record as usize].face_a);
    let is_joined = |a: &ChainLink, b: &ChainLink| {
        may_be_in_line(mesh, a) && may_be_in_line(mesh, b) && primitive(a) == primitive(b)
    };
    for chain in &mesh.chains.chains {
        let Some(class) = chain_class_of(chain.class) else { continue };
        let links = &mesh.chains.links[chain.link_range()];
        for line in links.chunk_by(is_joined).filter(|line| line.len() > 1) {
            line.iter().for_each(|link| is_in_line[link.record as usize] = true);
            strings[primitive(&line[0])][class].push(mesh, corners, &of_record, line);
        }
    }
    let used = |by_class: [LineStrings; CHAIN_CLASSES.len()]| {
        by_class.into_iter().filter(|strings| !strings.indices.is_empty()).collect()
    };
    (strings.into_iter().map(used).collect(), is_in_line)
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
    fn push(
        &mut self,
        mesh: &EdgeMesh,
        corners: &[[u32; 3]],
        of_record: &[EdgeFlags],
        line: &[ChainLink],
    ) {
        if !self.indices.is_empty() {
            self.indices.push(RESTART);
        }
        for (at, link) in line.iter().enumerate() {
            let [start, end] = stored_ends(mesh, corners, link);
            if at == 0 {
                self.indices.push(start);
            }
            self.indices.push(end);
            push_run(&mut self.edge_classes, of_record[link.record as usize]);
        }
    }
}

/// The ends of an edge in the order of its chain, as vertices of its first face in the file.
fn stored_ends(mesh: &EdgeMesh, corners: &[[u32; 3]], link: &ChainLink) -> [u32; 2] {
    let record = &mesh.records[link.record as usize];
    let face = record.face_a as usize;
    let stored = |vertex: u32| {
        let corner = mesh.triangles[face].iter().position(|&other| other == vertex);
        corner.map_or(NONE, |corner| corners[face][corner])
    };
    let [start, end] = [stored(record.v0), stored(record.v1)];
    if link.is_reversed == 1 { [end, start] } else { [start, end] }
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
        of_mesh(&build(positions, polygons))
    }

    fn of_mesh(mesh: &EdgeMesh) -> EdgeVisibility {
        let faces = PrimitiveFaces::new(mesh.triangles.iter().map(|_| 0), vec![false]);
        EdgeVisibility::of(mesh, &faces, &mesh.triangles).remove(0)
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
            assert_eq!(of_mesh(&mesh).values, [2, 2, value, 0, 2, 2], "{x}");
        }
        mesh.face_planes[1].normal = [0.0; 4];
        assert_eq!(of_mesh(&mesh).values, [2, 2, 0, 0, 2, 2], "no plane");
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
