//! The layouts of the paper (section 3): four copies of `<v0, v1, v2, v3, n0, n1, r, i>` for each
//! edge, which need only vertex attributes.
//!
//! At 16 bits, positions are quantized to steps of the largest side of the bounds over 65534, the
//! same along all axes, so that angles are kept. A position moves by at most half a step along an
//! axis, plus its rounding; a component of a normal errs by at most half of 1 / 32767.
//!
//! A sliver has the facing of its neighbor. The edge vertex cannot store that, so the third vertex
//! of such a face is moved off the edge, in the plane of the neighbor.
//!
//! The paper sets `v3 = v0` for marked edges, too. A marked edge would then lose its second face,
//! and so its contour; here the class bits mark it, and it keeps its vertex.
//!
//! Rejected: a separate step along each axis. A flat mesh would gain precision across, but every
//! normal would have to be corrected.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use crate::edge_mesh::edge_flags::EdgeFlags;
use crate::edge_mesh::edge_word::EdgeWord;
use crate::edge_mesh::face_normal::{corners_of, face_normal};
use crate::edge_mesh::record::{EdgeRecord, EdgeVertex, EdgeVertex16, FinVertex, edge_random};
use crate::edge_mesh::{Bounds, EdgeMesh};
use crate::index::NONE;

/// The largest 16-bit step from the middle.
const LARGEST_STEP: f64 = 32767.0;

/// The values that the edge vertices of a record share.
struct EdgeCorners {
    /// The paper's v0 to v3.
    positions: [[f32; 3]; 4],
    /// The vertex normals at v0 and v1.
    normals: [[f32; 3]; 2],
    word: EdgeWord,
}

impl EdgeCorners {
    fn of(mesh: &EdgeMesh, record: &EdgeRecord) -> Self {
        let ends = [record.v0, record.v1].map(|vertex| mesh.positions[vertex as usize]);
        let normals = [record.v0, record.v1].map(|vertex| mesh.vertex_normals[vertex as usize]);
        let third = |face: u32, side: f32| {
            let vertex = mesh.apex(face, record);
            if face == NONE {
                return ends[0];
            }
            let plane = Vec3::from_slice(&mesh.face_planes[face as usize].normal);
            let corners = corners_of(&mesh.positions, mesh.triangles[face as usize]);
            let is_own = face_normal(corners).as_vec3() == plane;
            if is_own || plane == Vec3::ZERO {
                return mesh.positions[vertex as usize];
            }
            let [v0, v1] = ends.map(Vec3::from);
            // A quarter of its length off the middle of the edge, on the left for face A.
            (v0.midpoint(v1) + plane.cross(v1 - v0) * (0.25 * side)).to_array()
        };
        let positions = [ends[0], ends[1], third(record.face_a, 1.0), third(record.face_b, -1.0)];
        Self { positions, normals, word: record.word }
    }

    fn random(&self) -> f32 {
        edge_random(self.positions[0].into(), self.positions[1].into())
    }
}

/// Four edge vertices for each record, in order.
fn replicate_with<T: Send>(
    mesh: &EdgeMesh,
    vertex: impl Fn(&EdgeCorners, u8) -> T + Sync,
) -> Vec<T> {
    let of_record = |record: &EdgeRecord| {
        let corners = EdgeCorners::of(mesh, record);
        [0, 1, 2, 3].map(|corner| vertex(&corners, corner))
    };
    mesh.records.par_iter().flat_map_iter(of_record).collect()
}

/// Makes the paper's edge mesh in 32-bit floats: four edge vertices for each record, in order.
#[must_use]
pub fn replicate(mesh: &EdgeMesh) -> Vec<EdgeVertex> {
    replicate_with(mesh, |edge, corner| {
        let ([v0, v1, v2, v3], [n0, n1]) = (edge.positions, edge.normals);
        let corner_and_flags = u32::from(corner) | edge.word.0 << EdgeVertex::FLAGS_SHIFT;
        EdgeVertex { v0, v1, v2, v3, n0, n1, r: edge.random(), corner_and_flags }
    })
}

/// Makes the paper's edge mesh at 16 bits: four edge vertices for each record, in order.
#[must_use]
pub fn replicate_16(mesh: &EdgeMesh) -> Vec<EdgeVertex16> {
    let quantization = Quantization::of(&mesh.bounds);
    replicate_with(mesh, |edge, corner| {
        let [v0, v1, v2, v3] = edge.positions.map(|position| quantization.quantize(position));
        let [n0, n1] = edge.normals.map(|normal| normal.map(quantize_normal));
        let corner_and_random = corner | quantize_random(edge.random()) << 2;
        let [low, middle, high, _] = edge.word.to_24_bits().to_le_bytes();
        EdgeVertex16 { v0, v1, v2, v3, n0, n1, corner_and_random, flags: [low, middle, high] }
    })
}

/// Makes Card and Mitchell's fins: four vertices for each record, in order. The first two are the
/// ends on the edge, the next two those that stand out, from the end back to the start.
#[must_use]
pub fn fins(mesh: &EdgeMesh) -> Vec<FinVertex> {
    let normal = |face: u32| {
        let [x, y, z, _] = mesh.face_planes[face as usize].normal;
        [x, y, z]
    };
    let of_record = |record: &EdgeRecord| {
        let (a, b) = (record.face_a, record.face_b);
        let face_a = if a == NONE { [0.0, 1.0, 0.0] } else { normal(a) };
        let mut face_b = if b == NONE { face_a.map(|part| -part) } else { normal(b) };
        if record.flags().contains(EdgeFlags::CLASH) {
            face_b = face_b.map(|part| -part);
        }
        let corners =
            [(record.v0, false), (record.v1, false), (record.v1, true), (record.v0, true)];
        corners.map(|(vertex, stands_out)| FinVertex {
            position: mesh.positions[vertex as usize],
            normal: if stands_out { mesh.vertex_normals[vertex as usize] } else { [0.0; 3] },
            face_a,
            face_b,
        })
    };
    mesh.records.par_iter().flat_map_iter(of_record).collect()
}

/// The conversion between positions and 16-bit steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quantization {
    /// The position of step 0 along all axes: the center of the bounds.
    pub center: DVec3,
    /// The length of a step, in units of the mesh.
    pub step: f64,
}

impl Quantization {
    /// The quantization of positions within `bounds`.
    #[must_use]
    pub fn of(bounds: &Bounds) -> Self {
        let [low, high] = [bounds.min, bounds.max].map(|corner| Vec3::from(corner).as_dvec3());
        let half = (high - low).max_element() / 2.0;
        Self { center: bounds.center(), step: if half > 0.0 { half / LARGEST_STEP } else { 1.0 } }
    }

    /// The steps of a position; positions outside of the bounds are clamped.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, reason = "clamped to 16 bits")]
    pub fn quantize(&self, position: [f32; 3]) -> [i16; 3] {
        let steps = (Vec3::from(position).as_dvec3() - self.center) / self.step;
        steps.to_array().map(|step| step.round().clamp(-LARGEST_STEP, LARGEST_STEP) as i16)
    }

    /// The position of steps, as the GPU computes it.
    #[must_use]
    pub fn dequantize(&self, steps: [i16; 3]) -> [f32; 3] {
        let [x, y, z] = steps.map(f64::from);
        (self.center + DVec3::new(x, y, z) * self.step).as_vec3().to_array()
    }

    /// The largest error of a coordinate: half a step, and the rounding to 32 bits.
    #[must_use]
    pub fn largest_error(&self) -> f64 {
        let reach = self.center.abs().max_element() + self.step * LARGEST_STEP;
        self.step * 0.5 + reach * f64::from(f32::EPSILON)
    }
}

#[expect(clippy::cast_possible_truncation, reason = "clamped to 16 bits")]
fn quantize_normal(component: f32) -> i16 {
    (f64::from(component) * LARGEST_STEP).round().clamp(-LARGEST_STEP, LARGEST_STEP) as i16
}

/// Converts a scalar from 0 to 1 to six bits.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below 64")]
fn quantize_random(random: f32) -> u8 {
    ((random * 64.0) as u8).min(63)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::{BuildOptions, build_edge_mesh};
    use crate::model::Model;
    use crate::report::Report;

    #[test]
    fn four_copies_differ_in_i_and_boundaries_repeat_v0() {
        let positions = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [1., 1., 1.]];
        let model = Model::from_polygons(&positions, &[&[0, 1, 2], &[1, 3, 2]]);
        let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default());
        let vertices = replicate(&mesh);
        assert_eq!(vertices.len(), 4 * mesh.records.len());
        for (index, vertex) in vertices.iter().enumerate() {
            assert_eq!(vertex.corner() as usize, index % 4);
            let is_boundary = vertex.flags().contains(EdgeFlags::BOUNDARY);
            assert_eq!(vertex.v3 == vertex.v0, is_boundary, "{vertex:?}");
        }
        let inner = vertices.iter().find(|v| !v.flags().contains(EdgeFlags::BOUNDARY)).unwrap();
        assert_eq!((inner.v0, inner.v1), ([1., 0., 0.], [0., 1., 0.]), "as face A runs");
        assert_eq!((inner.v2, inner.v3), ([0., 0., 0.], [1., 1., 1.]));
    }

    #[test]
    fn a_marked_edge_keeps_its_second_face() {
        let positions = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [1., 1., 1.]];
        let model = Model::from_polygons(&positions, &[&[0, 1, 2], &[1, 3, 2]]);
        let mut mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default());
        let inner = mesh.records.iter().position(|record| record.face_b != NONE).unwrap();
        mesh.records[inner].word.set(EdgeFlags::MARKED, true);
        let vertex = &replicate(&mesh)[4 * inner];
        assert!(vertex.v3 != vertex.v0 && vertex.flags().contains(EdgeFlags::MARKED));
    }

    #[test]
    fn fins_stand_on_their_edges_and_boundaries_negate_their_face() {
        let positions = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [1., 1., 1.]];
        let model = Model::from_polygons(&positions, &[&[0, 1, 2], &[1, 3, 2]]);
        let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default());
        for (record, fin) in mesh.records.iter().zip(fins(&mesh).as_chunks::<4>().0) {
            let ends = [record.v0, record.v1, record.v1, record.v0];
            assert_eq!(fin.map(|vertex| vertex.position), ends.map(|v| mesh.positions[v as usize]));
            assert_eq!(fin.map(|vertex| vertex.normal != [0.0; 3]), [false, false, true, true]);
            let sum = Vec3::from(fin[0].face_a) + Vec3::from(fin[0].face_b);
            assert_eq!(sum == Vec3::ZERO, record.face_b == NONE, "{record:?}");
        }
    }

    /// A face of three points on a line has the facing of its neighbor.
    #[test]
    fn a_face_without_area_stands_in_its_neighbors_plane() {
        let positions = [[0., 0., 0.], [1., 0., 0.], [2., 0., 0.], [1., 1., 0.]];
        let model = Model::from_polygons(&positions, &[&[0, 2, 3], &[0, 1, 2]]);
        let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default());
        assert_eq!(mesh.triangles.len(), 2, "the face stays");
        for (record, vertex) in mesh.records.iter().zip(replicate(&mesh).iter().step_by(4)) {
            let [v0, v1, v2, v3] = [vertex.v0, vertex.v1, vertex.v2, vertex.v3].map(Vec3::from);
            let normal_a = (v1 - v0).cross(v2 - v0).normalize_or_zero();
            let plane = |face: u32| Vec3::from_slice(&mesh.face_planes[face as usize].normal);
            assert!(normal_a.dot(plane(record.face_a)) > 0.99, "{record:?} {vertex:?}");
            if record.face_b != NONE {
                let normal_b = (v3 - v0).cross(v1 - v0).normalize_or_zero();
                assert!(normal_b.dot(plane(record.face_b)) > 0.99, "{record:?} {vertex:?}");
            }
        }
    }

    #[test]
    fn sixteen_bits_say_the_same_up_to_their_steps() {
        let positions = [[0., 0., 0.], [1., 0.1, 0.], [0., 7.3, 0.], [1., 1., -2.]];
        let model = Model::from_polygons(&positions, &[&[0, 1, 2], &[1, 3, 2]]);
        let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default());
        let quantization = Quantization::of(&mesh.bounds);
        let (exact, rounded) = (replicate(&mesh), replicate_16(&mesh));
        assert_eq!(exact.len(), rounded.len());
        for (exact, rounded) in exact.iter().zip(&rounded) {
            assert_eq!((exact.corner(), exact.flags()), (rounded.corner(), rounded.flags()));
            assert!((0.0..1.0 / 64.0).contains(&(exact.r - rounded.random())));
            for (exact, rounded) in [(exact.v0, rounded.v0), (exact.v1, rounded.v1)]
                .into_iter()
                .chain([(exact.v2, rounded.v2), (exact.v3, rounded.v3)])
            {
                let back = quantization.dequantize(rounded);
                let error = (0..3).map(|axis| f64::from((exact[axis] - back[axis]).abs()));
                let error = error.fold(0.0, f64::max);
                assert!(error <= quantization.largest_error(), "{exact:?} {back:?}");
            }
            for (exact, rounded) in [(exact.n0, rounded.n0), (exact.n1, rounded.n1)] {
                for axis in 0..3 {
                    let error = f64::from(exact[axis]) - f64::from(rounded[axis]) / LARGEST_STEP;
                    assert!(error.abs() <= 0.5 / LARGEST_STEP, "{exact:?} {rounded:?}");
                }
            }
        }
    }

    #[test]
    fn the_corners_of_the_box_are_the_outermost_steps() {
        let bounds = Bounds { min: [-1.0, 0.0, 2.0], max: [3.0, 1.0, 3.0] };
        let quantization = Quantization::of(&bounds);
        assert_eq!(quantization.quantize([-1.0, 0.5, 2.5]), [-32767, 0, 0]);
        assert_eq!(quantization.quantize([3.0, 0.5, 2.5]), [32767, 0, 0]);
        let point = Quantization::of(&Bounds::default());
        assert_eq!(point.dequantize(point.quantize([0.0; 3])), [0.0; 3]);
    }
}
