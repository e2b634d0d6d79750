//! Crease angles: how far two faces turn at their edge (paper, Equation 1).
//!
//! Idea: an angle is what is certain of it. What rounding may have added is taken off, so an edge
//! whose angle is the threshold is no crease, whatever the last bits of its corners are. The
//! normals of the planes are in 32 bits, whose rounding is taken off as well.
//!
//! A polygon that is not flat turns at its diagonals, and differently at each of its sides than the
//! triangle there. So creases are judged by the normal of the whole polygon (Newell's method),
//! which does not depend on how it is cut; contours follow the triangles, as they are drawn.
//!
//! Rejected: comparing cosines, whose steps are uneven: near 0 degrees, 32 bits cannot tell a
//! hundredth of a degree.

use std::ops::RangeInclusive;

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::faces::FaceSources;
use super::planes::{DOUBTFUL_TILT_RAD, Planes, tilt};
use super::rounding::Rounding;
use crate::edge_mesh::{EdgeFlags, EdgeWord};
use crate::model::Model;

/// The most that is taken off an angle, in radians: 0.006 degrees. Coarser coordinates leave angles
/// that could be anything, as on a scan, and then the number that they have is the best guess.
const MOST_IN_DOUBT_RAD: f64 = 1e-4;

/// What the rounding of two unit normals in 32 bits may add to their angle, in radians.
const NORMALS_IN_32_BITS_RAD: f64 = 4e-7;

/// The cosines of the angles of a groove: from 1 to 150 degrees. Flatter edges could be concave by
/// rounding alone, most of all at 16 bits; sharper ones are folds, which in many meshes are faces
/// turned over that nothing hides.
const GROOVE_COSINES: RangeInclusive<f32> = -0.866_025_4..=0.999_847_7;

/// The normals that creases are judged by.
#[derive(Debug)]
pub(crate) struct CreaseNormals<'a> {
    planes: &'a Planes,
    sources: &'a FaceSources,
    /// One for each polygon; empty if all polygons are triangles.
    polygons: Vec<CreaseNormal>,
}

/// A normal, and by how much rounding may have tilted it.
#[derive(Debug, Clone, Copy)]
struct CreaseNormal {
    /// Unit length, or zero.
    normal: Vec3,
    tilt_rad: f32,
}

impl<'a> CreaseNormals<'a> {
    /// The normals of the faces of `sources`; `vertex_of` is the welded position of a corner.
    pub(crate) fn of(
        model: &Model,
        planes: &'a Planes,
        sources: &'a FaceSources,
        rounding: &Rounding,
        vertex_of: impl Fn(usize) -> DVec3 + Sync,
    ) -> Self {
        let polygon = |polygon: usize| {
            let range = model.corner_range(polygon);
            if range.len() == 3 {
                return CreaseNormal { normal: Vec3::ZERO, tilt_rad: 0.0 };
            }
            let corners: Vec<DVec3> = range.map(&vertex_of).collect();
            let (first, rest) = (corners[0], &corners[1..]);
            let sides = rest.windows(2).map(|side| (side[0] - first).cross(side[1] - first));
            let normal = sides.sum::<DVec3>().normalize_or_zero().as_vec3();
            CreaseNormal { normal, tilt_rad: tilt(&corners, rounding) }
        };
        let count = if model.is_triangles() { 0 } else { model.polygon_count() };
        let polygons = (0..count).into_par_iter().with_min_len(1 << 12).map(polygon).collect();
        Self { planes, sources, polygons }
    }

    fn get(&self, face: u32) -> CreaseNormal {
        let face = face as usize;
        if !self.polygons.is_empty() {
            let polygon = self.polygons[self.sources.polygon(face)];
            // A polygon that is too narrow to judge by leaves it to its triangles.
            if polygon.normal != Vec3::ZERO && polygon.tilt_rad <= DOUBTFUL_TILT_RAD {
                let turned = if self.sources.is_turned(face) { -1.0 } else { 1.0 };
                return CreaseNormal { normal: polygon.normal * turned, ..polygon };
            }
        }
        let [x, y, z, _] = self.planes.planes[face].normal;
        CreaseNormal { normal: Vec3::new(x, y, z), tilt_rad: self.planes.tilts[face] }
    }

    /// The word of an edge along `direction` with face A on its left, with the angle and no class
    /// but [`EdgeFlags::GROOVE`]; `clashes` if face B is wound the other way.
    pub(crate) fn word(&self, faces: [u32; 2], direction: DVec3, clashes: bool) -> EdgeWord {
        let [a, b] = faces.map(|face| self.get(face));
        if a.normal == Vec3::ZERO || b.normal == Vec3::ZERO {
            return EdgeWord::default();
        }
        let [normal_a, mut normal_b] = [a.normal, b.normal].map(Vec3::as_dvec3);
        if clashes {
            normal_b = -normal_b;
        }
        let in_doubt = f64::from(a.tilt_rad) + f64::from(b.tilt_rad) + NORMALS_IN_32_BITS_RAD;
        let in_doubt = in_doubt.min(MOST_IN_DOUBT_RAD);
        let is_concave = normal_a.cross(normal_b).dot(direction) < 0.0;
        let mut flags = EdgeFlags::empty();
        flags.set(EdgeFlags::GROOVE, !clashes && self.is_groove(faces, direction));
        EdgeWord::new(flags, angle_between(normal_a, normal_b) - in_doubt, is_concave)
    }
}

impl CreaseNormals<'_> {
    /// Whether the triangles at an edge form a groove.
    fn is_groove(&self, faces: [u32; 2], direction: DVec3) -> bool {
        let [a, b] = faces.map(|face| {
            let [x, y, z, _] = self.planes.planes[face as usize].normal;
            Vec3::new(x, y, z)
        });
        GROOVE_COSINES.contains(&a.dot(b)) && a.cross(b).dot(direction.as_vec3()) < 0.0
    }
}

/// The angle between unit vectors, in radians: the arc sine of half their distance keeps what the
/// arc cosine would lose near 0.
fn angle_between(a: DVec3, b: DVec3) -> f64 {
    let half_sine = |distance: f64| 2.0 * (0.5 * distance).min(1.0).asin();
    if a.dot(b) >= 0.0 {
        half_sine(a.distance(b))
    } else {
        std::f64::consts::PI - half_sine((a + b).length())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::{BuildOptions, build_edge_mesh};
    use crate::edge_mesh::EdgeMesh;
    use crate::report::Report;

    fn count(mesh: &EdgeMesh, class: EdgeFlags) -> usize {
        mesh.records.iter().filter(|record| record.flags().contains(class)).count()
    }

    /// A prism without a bottom and a top: `sides` quads, rounded by `round`.
    fn prism(sides: u32, round: impl Fn(f64) -> f64) -> Model {
        let at = |k: u32, z: f64| {
            let angle = std::f64::consts::TAU * f64::from(k) / f64::from(sides);
            [round(10.0 * angle.cos()), round(10.0 * angle.sin()), z]
        };
        let positions = (0..sides).flat_map(|k| [at(k, 0.0), at(k, 12.5)]).collect();
        let mut model = Model { positions, ..Model::default() };
        for k in 0..sides {
            let (a, b) = (2 * k, 2 * ((k + 1) % sides));
            model.push_polygon(&[a, b, b + 1, a + 1].map(crate::model::Corner::at), 0);
        }
        model
    }

    #[test]
    fn all_sides_of_a_prism_are_creases_or_none() {
        let rounds: [fn(f64) -> f64; 3] =
            [|x| x, |x| (x * 1e5).round() / 1e5, |x| (x * 1e6).round() / 1e6];
        for sides in [5, 6, 7, 9, 12, 18, 20, 24, 30, 36, 45, 90] {
            for round in rounds {
                let ridges = |degrees: f64| {
                    let ridge_angle_rad = degrees.to_radians();
                    let options = BuildOptions { ridge_angle_rad, ..BuildOptions::default() };
                    let model = prism(sides, round);
                    let mesh = build_edge_mesh(&model, &options, &mut Report::default());
                    count(&mesh, EdgeFlags::RIDGE)
                };
                let turn = 360.0 / f64::from(sides);
                assert_eq!(ridges(turn), 0, "{sides} sides at their own angle");
                assert_eq!(ridges(turn - 0.01), sides as usize, "{sides} below");
                assert_eq!(ridges(turn + 0.01), 0, "{sides} above");
            }
        }
    }

    /// A row of bent quads, each the last one mirrored: their sides do not turn, but the triangles
    /// at a side do.
    #[test]
    fn bent_quads_are_judged_whole() {
        let mut positions = Vec::new();
        for k in 0..6_u8 {
            let lift = if k % 2 == 0 { 0.3 } else { -0.3 };
            positions.push([f64::from(k), 0.0, lift]);
            positions.push([f64::from(k), 1.0, -lift]);
        }
        let mut model = Model { positions, ..Model::default() };
        for k in 0..5 {
            let corners = [2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1];
            model.push_polygon(&corners.map(crate::model::Corner::at), 0);
        }
        let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default());
        assert_eq!(count(&mesh, EdgeFlags::RIDGE | EdgeFlags::VALLEY), 0);
        assert_eq!(count(&mesh, EdgeFlags::DIAGONAL), 5);
    }

    #[test]
    fn angles_are_exact_at_both_ends() {
        for degrees in [0.0, 1e-4, 0.5, 30.0, 90.0, 150.0, 179.999, 180.0_f64] {
            let angle = degrees.to_radians();
            let turned = DVec3::new(angle.cos(), angle.sin(), 0.0);
            assert!((angle_between(DVec3::X, turned) - angle).abs() < 1e-12, "{degrees}");
        }
    }
}
