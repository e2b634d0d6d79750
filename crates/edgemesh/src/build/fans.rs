//! Walks around each vertex: splits vertices in which several fans of faces meet, and computes
//! vertex normals.
//!
//! Idea: the faces at a vertex, joined across their records, form fans. A walk from face to face,
//! starting at the first corner of a vertex, covers one fan. If corners are left, the surface is
//! not connected there, and each further fan gets a new vertex. A sound mesh has one fan for each
//! vertex, so the walk is also the only pass over the faces that normals need.
//!
//! Normals weigh each face by its angle at the vertex (Thürmer and Wüthrich 1998, "Computing Vertex
//! Normals from Polygonal Facets"), so that they do not depend on the triangles of a flat part.
//!
//! ```text
//!     \ A /
//!      \ /        a bow tie: fans A and B meet in one vertex;
//!       v         B gets a copy of it
//!      / \
//!     / B \
//! ```
//!
//! Rejected: weights by area, where one long sliver turns a normal; comparing counts of edges and
//! faces, which misses two closed fans on one point.

use std::sync::atomic::{AtomicU32, Ordering};

use glam::Vec3;
use rayon::prelude::*;

use super::planes::has_normal;
use crate::edge_mesh::{EdgeRecord, FacePlane};
use crate::index::{NONE, to_u32};

/// The mesh of the walks.
#[derive(Debug)]
pub(crate) struct FanInput<'a> {
    pub(crate) positions: &'a [[f32; 3]],
    pub(crate) triangles: &'a [[u32; 3]],
    pub(crate) planes: &'a [FacePlane],
    /// For each side, the side across, or [`NONE`].
    pub(crate) twins: &'a [AtomicU32],
    /// Vertices of edges whose winding clashes, ascending. They are not split, because a record
    /// there has the vertices of both faces.
    pub(crate) clashing: &'a [u32],
}

/// The result of the walks.
#[derive(Debug, Default)]
pub(crate) struct Fans {
    /// Unit normals of vertices, or zero; a vertex of several fans has that of the first fan.
    pub(crate) normals: Vec<[f32; 3]>,
    /// Further fans, sorted by vertex and first corner.
    pub(crate) splits: Vec<Split>,
}

/// A fan that gets a new vertex.
#[derive(Debug, PartialEq)]
pub(crate) struct Split {
    /// The vertex that the fan is split from.
    pub(crate) vertex: u32,
    /// The corners of the fan at that vertex.
    pub(crate) corners: Vec<u32>,
    pub(crate) normal: [f32; 3],
}

/// The corners of a vertex.
#[derive(Debug, Clone, Copy)]
struct Corners {
    /// The first corner, or [`NONE`].
    first: u32,
    count: u32,
}

/// Walks around all vertices.
pub(crate) fn walk_fans(input: &FanInput) -> Fans {
    let corners = corners_by_vertex(input);
    let mut normals = vec![[0.0; 3]; corners.len()];
    let split: Vec<u32> = normals
        .par_iter_mut()
        .zip(&corners)
        .enumerate()
        .with_min_len(1 << 12)
        .filter(|(_, (_, corners))| corners.first != NONE)
        .filter_map(|(vertex, (normal, corners))| {
            let (sum, seen) = input.walk(corners.first, |_| ());
            *normal = sum;
            let vertex = to_u32(vertex);
            let is_split = seen != corners.count && input.clashing.binary_search(&vertex).is_err();
            is_split.then_some(vertex)
        })
        .collect();
    Fans { normals, splits: input.further_fans(&split) }
}

/// The first corner and the number of corners of each vertex; each thread has a range of vertices.
fn corners_by_vertex(input: &FanInput) -> Vec<Corners> {
    let vertex_count = input.positions.len();
    let mut corners = vec![Corners { first: NONE, count: 0 }; vertex_count];
    let chunk = vertex_count.div_ceil(rayon::current_num_threads()).max(1);
    corners.par_chunks_mut(chunk).enumerate().for_each(|(part, own)| {
        let start = to_u32(part * chunk);
        for (corner, &vertex) in input.triangles.as_flattened().iter().enumerate() {
            // Vertices below the range wrap around to large numbers.
            if let Some(entry) = own.get_mut(vertex.wrapping_sub(start) as usize) {
                entry.first = entry.first.min(to_u32(corner));
                entry.count += 1;
            }
        }
    });
    corners
}

impl FanInput<'_> {
    /// Walks over the fan of the corner `start`; returns its normal and number of corners.
    fn walk(&self, start: u32, mut visit: impl FnMut(u32)) -> ([f32; 3], u32) {
        let point = self.point(start);
        let mut sum = Vec3::ZERO;
        let mut count = 0;
        let mut see = |corner: u32, to_next: Vec3, to_previous: Vec3| {
            let plane = &self.planes[corner as usize / 3];
            if has_normal(plane) {
                let [x, y, z, _] = plane.normal;
                sum += Vec3::new(x, y, z) * angle(to_next.dot(to_previous));
            }
            count += 1;
            visit(corner);
        };
        let arm = |corner: u32| (self.point(corner) - point).normalize_or_zero();
        // Counter-clockwise, across the side that runs to the vertex.
        let first_arm = arm(next(start));
        let (mut corner, mut to_next) = (start, first_arm);
        loop {
            let to_previous = arm(previous(corner));
            see(corner, to_next, to_previous);
            corner = self.twin(previous(corner));
            if corner == start {
                break;
            }
            if corner == NONE {
                self.walk_back(start, first_arm, arm, &mut see);
                break;
            }
            to_next = to_previous;
        }
        (sum.normalize_or_zero().to_array(), count)
    }

    /// Walks clockwise from the corner `start`, which is not visited again, across the side that
    /// starts at the vertex.
    fn walk_back(
        &self,
        start: u32,
        first_arm: Vec3,
        arm: impl Fn(u32) -> Vec3,
        see: &mut impl FnMut(u32, Vec3, Vec3),
    ) {
        let (mut side, mut to_previous) = (self.twin(start), first_arm);
        while side != NONE {
            let corner = next(side);
            let to_next = arm(next(corner));
            see(corner, to_next, to_previous);
            side = self.twin(corner);
            to_previous = to_next;
        }
    }

    fn point(&self, corner: u32) -> Vec3 {
        let vertex = self.triangles.as_flattened()[corner as usize];
        Vec3::from(self.positions[vertex as usize])
    }

    fn twin(&self, side: u32) -> u32 {
        self.twins[side as usize].load(Ordering::Relaxed)
    }

    /// The fans of `vertices`, ascending, without the first fan of each.
    fn further_fans(&self, vertices: &[u32]) -> Vec<Split> {
        if vertices.is_empty() {
            return Vec::new();
        }
        let mut corners: Vec<(u32, u32)> = self
            .triangles
            .as_flattened()
            .iter()
            .enumerate()
            .filter(|(_, vertex)| vertices.binary_search(vertex).is_ok())
            .map(|(corner, &vertex)| (vertex, to_u32(corner)))
            .collect();
        corners.sort_unstable();
        let mut is_seen = vec![false; corners.len()];
        let mut splits = Vec::new();
        for at in 0..corners.len() {
            if is_seen[at] {
                continue;
            }
            let (vertex, start) = corners[at];
            let mut fan = Vec::new();
            let (normal, _) = self.walk(start, |corner| fan.push(corner));
            for &corner in &fan {
                if let Ok(found) = corners.binary_search(&(vertex, corner)) {
                    is_seen[found] = true;
                }
            }
            let is_first = at == 0 || corners[at - 1].0 != vertex;
            if !is_first {
                splits.push(Split { vertex, corners: fan, normal });
            }
        }
        splits
    }
}

/// Adds a vertex for each further fan to positions and normals, and changes triangles and records
/// to it. Returns the vertex that each new one was split from.
pub(crate) fn apply_splits(
    splits: &[Split],
    (positions, normals): (&mut Vec<[f32; 3]>, &mut Vec<[f32; 3]>),
    triangles: &mut [[u32; 3]],
    records: &mut [EdgeRecord],
) -> Vec<u32> {
    let split_vertices: Vec<u32> = splits.iter().map(|split| split.vertex).collect();
    if splits.is_empty() {
        return split_vertices;
    }
    let before = triangles.to_vec();
    for split in splits {
        let new = to_u32(positions.len());
        positions.push(positions[split.vertex as usize]);
        normals.push(split.normal);
        for &corner in &split.corners {
            triangles[corner as usize / 3][corner as usize % 3] = new;
        }
    }
    let is_split = |vertex: u32| split_vertices.binary_search(&vertex).is_ok();
    for record in records.iter_mut().filter(|record| is_split(record.v0) || is_split(record.v1)) {
        let face = record.face_a as usize;
        let renamed = |vertex: u32| {
            let corner = before[face].iter().position(|&other| other == vertex);
            corner.map_or(vertex, |corner| triangles[face][corner])
        };
        (record.v0, record.v1) = (renamed(record.v0), renamed(record.v1));
    }
    split_vertices
}

const fn next(corner: u32) -> u32 {
    if corner % 3 == 2 { corner - 2 } else { corner + 1 }
}

const fn previous(corner: u32) -> u32 {
    if corner.is_multiple_of(3) { corner + 2 } else { corner - 1 }
}

/// The arc cosine in radians, to 7 digits (Abramowitz and Stegun, *Handbook of Mathematical
/// Functions*, 4.4.46); faster than the exact one, and the same on every machine.
pub(crate) fn angle(cosine: f32) -> f32 {
    const COEFFICIENTS: [f32; 7] = [
        0.006_670_09,
        -0.017_088_13,
        0.030_891_88,
        -0.050_174_3,
        0.088_978_99,
        -0.214_598_8,
        std::f32::consts::FRAC_PI_2,
    ];
    let x = cosine.abs().min(1.0);
    let start = -0.001_262_491_1_f32;
    let series = COEFFICIENTS.iter().fold(start, |sum, coefficient| sum * x + coefficient);
    let acute = (1.0 - x).sqrt() * series;
    if cosine < 0.0 { std::f32::consts::PI - acute } else { acute }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::{BuildOptions, build_edge_mesh};
    use crate::edge_mesh::EdgeMesh;
    use crate::model::Model;
    use crate::report::{RepairKind, Report};

    fn build(positions: &[[f32; 3]], polygons: &[&[u32]]) -> (EdgeMesh, Report) {
        let model = Model::from_polygons(positions, polygons);
        let mut report = Report::default();
        let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut report);
        (mesh, report)
    }

    #[test]
    fn angles_are_those_of_the_standard_library() {
        for step in -1000..=1000_i16 {
            let cosine = f32::from(step) / 1000.0;
            let exact = f64::from(cosine).acos();
            assert!((f64::from(angle(cosine)) - exact).abs() < 2e-6, "{cosine}");
        }
    }

    #[test]
    fn a_cubes_corner_points_along_its_diagonal_however_it_is_cut() {
        let positions = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.], [1., 1., 0.]];
        // The bottom face is cut in two at the corner, the others are not.
        let (mesh, _) = build(&positions, &[&[0, 4, 1], &[0, 2, 4], &[0, 3, 2], &[0, 1, 3]]);
        let [x, y, z] = mesh.vertex_normals[0];
        for component in [x, y, z] {
            assert!((component + 1.0 / 3.0_f32.sqrt()).abs() < 1e-6, "{component}");
        }
    }

    #[test]
    fn a_bow_tie_is_split_into_its_fans() {
        let positions = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [-1., 0., 1.], [-1., 0., -1.]];
        let (mesh, report) = build(&positions, &[&[0, 1, 2], &[0, 3, 4]]);
        assert_eq!(report.repair_count(RepairKind::SplitVertices), 1);
        assert!(report.warnings().is_empty(), "nothing is lost");
        assert_eq!(mesh.counts.welded_vertices, 5);
        assert_eq!((mesh.positions.len(), mesh.positions[5]), (6, [0., 0., 0.]));
        assert_eq!(mesh.triangles, [[0, 1, 2], [5, 3, 4]]);
        assert_ne!(mesh.vertex_normals[0], mesh.vertex_normals[5]);
        let ends: Vec<_> = mesh.records.iter().map(|r| (r.face_a, r.v0, r.v1)).collect();
        assert_eq!(ends, [(0, 0, 1), (0, 2, 0), (1, 5, 3), (1, 4, 5), (0, 1, 2), (1, 3, 4)]);
    }

    /// Two tetrahedra, tip to tip: both fans are closed, so the vertex has as many edges as
    /// faces.
    #[test]
    fn closed_fans_on_one_point_are_split_too() {
        let tip = [0., 0., 0.];
        let base = |z: f32| [[1., 0., z], [-1., 1., z], [-1., -1., z]];
        let positions = [vec![tip], base(1.0).to_vec(), base(-1.0).to_vec()].concat();
        let up: [&[u32]; 4] = [&[0, 2, 1], &[0, 3, 2], &[0, 1, 3], &[1, 2, 3]];
        let down: [&[u32]; 4] = [&[0, 4, 5], &[0, 5, 6], &[0, 6, 4], &[4, 6, 5]];
        let (mesh, report) = build(&positions, &[up, down].concat());
        assert_eq!(report.repair_count(RepairKind::SplitVertices), 1);
        assert_eq!(mesh.positions.len(), 8);
        let [a, b] = [mesh.vertex_normals[0][2], mesh.vertex_normals[7][2]];
        assert!(a < -0.9 && b > 0.9, "{a} {b}");
    }
}
