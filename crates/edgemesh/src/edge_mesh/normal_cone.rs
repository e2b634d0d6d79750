//! Normal cones: bounds of clusters of faces that all look at the eye, or all away from it.
//!
//! Only a few percent of the edges of a fine mesh are contours; clusters skip most of the others.
//! A cluster has a sphere around its points and a cone around its normals. If the whole cone looks
//! one way from everywhere in the sphere, so do all faces, and no edge between them is a contour
//! (Johnson and Cohen 2001, spatialized normal cones).
//!
//! The bounds are rounded outward by more than the arithmetic errs, so the test never skips a
//! contour.
//!
//! ```text
//!        axis           for each p in the sphere and n in the cone
//!     \\   |   /          n . (eye - p)  >=  |d| cos(angle + half) - radius,
//!      \\  |  /           d = eye - center
//!    ( . \\|/ . )
//! ```
//!
//! Rejected: a tree of clusters (Sander et al. 2000). With one level, a test covers 32 faces, and
//! no thread waits for another.
//!
//! WGSL twin: `shaders/common/normal_cone.wgsl`.

use bytemuck::{Pod, Zeroable};
use glam::{Vec3, Vec4};

use crate::edge_mesh::FacePlane;

/// The margin of a bound, as a fraction of its distances. WGSL twin: the constant of this name.
pub const CONE_MARGIN: f32 = 1e-4;

/// The bounds of a cluster of faces: 32 bytes.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct NormalCone {
    /// Center of a sphere around a point of each face.
    pub center: [f32; 3],
    /// Radius of the sphere.
    pub radius: f32,
    /// Axis of a cone around the normals.
    pub axis: [f32; 3],
    /// Cosine of the half angle of the cone; 0 or less if there is no such cone.
    pub cosine: f32,
}

/// The facing of a cluster. WGSL twins: the constants `MIXED`, `ALL_FACE` and `ALL_AWAY`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum ConeFacing {
    /// Unknown: faces can look either way.
    Mixed = 0,
    /// All faces look at the eye.
    AllFace = 1,
    /// All faces look away from the eye.
    AllAway = 2,
}

impl NormalCone {
    /// The bounds of the faces with these planes.
    #[must_use]
    pub fn of<'a>(planes: impl Iterator<Item = &'a FacePlane> + Clone) -> Self {
        let normal = |plane: &FacePlane| Vec3::from_slice(&plane.normal);
        let point = |plane: &FacePlane| Vec3::from_slice(&plane.point);
        let sum: Vec3 = planes.clone().map(normal).sum();
        let axis = sum.normalize_or_zero();
        // A face without a normal looks away from every eye.
        let cosine = planes.clone().map(|plane| normal(plane).dot(axis)).fold(1.0, f32::min);
        let low = planes.clone().map(point).reduce(Vec3::min).unwrap_or_default();
        let high = planes.clone().map(point).reduce(Vec3::max).unwrap_or_default();
        let center = low.midpoint(high);
        let radius = planes.map(|plane| point(plane).distance(center)).fold(0.0, f32::max);
        Self {
            center: center.to_array(),
            radius: radius * (1.0 + 1e-5),
            axis: axis.to_array(),
            cosine: cosine - 1e-5,
        }
    }
}

/// The facing of a cluster, seen by `eye` (w = 1), or by a viewer in that direction (w = 0).
#[must_use]
pub fn cone_facing(cone: &NormalCone, eye: Vec4) -> ConeFacing {
    if cone.cosine <= 0.0 {
        return ConeFacing::Mixed;
    }
    let to_eye = eye.truncate() - eye.w * Vec3::from(cone.center);
    let distance = to_eye.length();
    let along = Vec3::from(cone.axis).dot(to_eye);
    let across = (distance * distance - along * along).max(0.0).sqrt();
    let sine = (1.0 - cone.cosine * cone.cosine).max(0.0).sqrt();
    let reach = eye.w.abs() * cone.radius;
    // The margin covers rounding.
    let bound = reach + CONE_MARGIN * (distance + reach);
    if along * cone.cosine - across * sine > bound {
        ConeFacing::AllFace
    } else if along * cone.cosine + across * sine < -bound {
        ConeFacing::AllAway
    } else {
        ConeFacing::Mixed
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::faces_eye;

    fn plane(normal: Vec3, point: Vec3) -> FacePlane {
        FacePlane {
            normal: normal.normalize_or_zero().extend(0.0).to_array(),
            point: point.extend(1.0).to_array(),
        }
    }

    #[test]
    fn a_flat_cluster_is_seen_from_one_side() {
        let planes = [plane(Vec3::Z, Vec3::ZERO), plane(Vec3::Z, Vec3::X)];
        let cone = NormalCone::of(planes.iter());
        assert_eq!(cone_facing(&cone, Vec4::new(0.0, 0.0, 5.0, 1.0)), ConeFacing::AllFace);
        assert_eq!(cone_facing(&cone, Vec4::new(0.0, 0.0, -5.0, 1.0)), ConeFacing::AllAway);
        assert_eq!(cone_facing(&cone, Vec4::new(9.0, 0.0, 0.1, 1.0)), ConeFacing::Mixed);
        assert_eq!(cone_facing(&cone, Vec4::new(0.0, 0.0, 1.0, 0.0)), ConeFacing::AllFace);
        assert_eq!(cone_facing(&cone, Vec4::new(0.0, 1.0, 0.0, 0.0)), ConeFacing::Mixed);
    }

    #[test]
    fn nothing_is_claimed_of_a_ball_or_a_face_without_a_normal() {
        let ball = [Vec3::X, Vec3::NEG_X, Vec3::Y].map(|normal| plane(normal, normal));
        let lost = [plane(Vec3::Z, Vec3::ZERO), plane(Vec3::ZERO, Vec3::ZERO)];
        for planes in [&ball[..], &lost, &[]] {
            let cone = NormalCone::of(planes.iter());
            assert_eq!(cone_facing(&cone, Vec4::new(0.0, 0.0, 9.0, 1.0)), ConeFacing::Mixed);
        }
    }

    /// Whatever a cone says is true of each of its faces.
    #[test]
    fn claims_hold_for_every_face() {
        let number = |at: u32| {
            let hash = at.wrapping_mul(2_654_435_761) >> 8;
            f32::from(u16::try_from(hash & 0xffff).unwrap()) / 32_768.0 - 1.0
        };
        let vector = |at: u32| Vec3::new(number(at), number(at + 1), number(at + 2));
        let mut claims = 0;
        for case in 0..4000_u32 {
            let spread = [0.01, 0.1, 0.5, 1.5][case as usize % 4];
            let axis = vector(case * 100);
            let planes: Vec<FacePlane> = (0..8)
                .map(|face| {
                    let at = case * 100 + face * 7 + 3;
                    plane(axis + vector(at) * spread, vector(at + 3))
                })
                .collect();
            let eye = (vector(case * 100 + 90) * 6.0).extend(if case % 3 == 0 { 0.0 } else { 1.0 });
            let claim = cone_facing(&NormalCone::of(planes.iter()), eye);
            let facing = planes.iter().filter(|plane| faces_eye(plane, eye)).count();
            match claim {
                ConeFacing::AllFace => assert_eq!(facing, 8),
                ConeFacing::AllAway => assert_eq!(facing, 0),
                ConeFacing::Mixed => continue,
            }
            claims += 1;
        }
        assert!(claims > 1000, "{claims}");
    }
}
