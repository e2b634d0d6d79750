//! Facing: the side of a face that the eye is on (paper, section 3.2, Equation 1).
//!
//! One bit for each face, computed once: computed for each edge, two edges of a face could disagree
//! in the last bit, and a contour would not close.
//!
//! In the paper a face is a back face if n . (eye - v0) < 0, so zero counts as front. Here zero
//! counts as back everywhere: a cube seen exactly from the front then draws its front outline,
//! once.
//!
//! WGSL twin: `shaders/common/facing.wgsl`.

use glam::{Vec3, Vec4};

use crate::edge_mesh::FacePlane;

/// Whether the face looks at the eye: n . (eye.xyz - eye.w p) > 0.
///
/// `eye` is the eye with w = 1, or in orthographic views the direction to the viewer with w = 0.
#[must_use]
pub fn faces_eye(plane: &FacePlane, eye: Vec4) -> bool {
    let [nx, ny, nz, _] = plane.normal;
    let [px, py, pz, _] = plane.point;
    let to_eye = eye.truncate() - eye.w * Vec3::new(px, py, pz);
    Vec3::new(nx, ny, nz).dot(to_eye) > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zero_is_back() {
        let plane = FacePlane { normal: [0.0, 0.0, 1.0, 0.0], point: [5.0, 5.0, 1.0, 1.0] };
        assert!(faces_eye(&plane, Vec4::new(0.0, 0.0, 2.0, 1.0)));
        assert!(!faces_eye(&plane, Vec4::new(0.0, 0.0, 1.0, 1.0)));
        assert!(!faces_eye(&plane, Vec4::new(0.0, 0.0, 0.0, 1.0)));
        assert!(faces_eye(&plane, Vec4::new(0.0, 0.0, 0.1, 0.0)), "a direction has no place");
        assert!(!faces_eye(&plane, Vec4::new(1.0, 0.0, 0.0, 0.0)));
    }
}
