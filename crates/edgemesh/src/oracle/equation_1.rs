//! Equation 1 as the paper evaluates it (section 3.2), from one replicated edge vertex.
//!
//! A property test compares it with [`crate::view::classify_edge`], which decides from one facing
//! bit for each face.

use glam::{Vec3, Vec4};

use crate::edge_mesh::{EdgeFlags, EdgeVertex};

/// Evaluates Equation 1 for one edge vertex.
///
/// Returns whether the edge is a contour, and [`EdgeFlags::RIDGE`] or [`EdgeFlags::VALLEY`] by the
/// cosines of the thresholds, which are angles between the face normals. Boundary edges (`v3 = v0`)
/// are neither.
///
/// The paper prints `-cos(theta)` with the internal angle theta: 150 degrees there are 30 degrees
/// here.
#[must_use]
pub fn equation_1(
    vertex: &EdgeVertex,
    eye: Vec4,
    ridge_cosine: f32,
    valley_cosine: f32,
) -> (bool, EdgeFlags) {
    let [v0, v1, v2, v3] = [vertex.v0, vertex.v1, vertex.v2, vertex.v3].map(Vec3::from);
    if v3 == v0 {
        return (false, EdgeFlags::empty());
    }
    let normal_a = (v1 - v0).cross(v2 - v0).normalize_or_zero();
    let normal_b = (v3 - v0).cross(v1 - v0).normalize_or_zero();
    let to_eye = eye.truncate() - eye.w * v0;
    let is_contour = (normal_a.dot(to_eye) > 0.0) != (normal_b.dot(to_eye) > 0.0);
    let cosine = normal_a.dot(normal_b);
    let is_concave = (v3 - v2).dot(normal_a) > 0.0;
    let crease = if !is_concave && cosine < ridge_cosine {
        EdgeFlags::RIDGE
    } else if is_concave && cosine < valley_cosine {
        EdgeFlags::VALLEY
    } else {
        EdgeFlags::empty()
    };
    (is_contour, crease)
}
