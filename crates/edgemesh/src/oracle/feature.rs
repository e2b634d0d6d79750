//! Which edges are features of a view (paper, section 3.2, Equation 1).
//!
//! The indexed layout decides from facing bits and static flags
//! ([`classify_edge`]); the paper's replicated layout decides from the edge
//! vertex alone ([`equation_1`]). A property test holds them to each other.
//!
//! WGSL twin of [`classify_edge`]: `shaders/common/feature.wgsl`.

use glam::{Vec3, Vec4};

use crate::record::{EdgeFlags, EdgeVertex};

bitflags::bitflags! {
    /// What a view says of an edge. The two bits sit where the live list of the
    /// GPU carries them, above the edge's index.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub struct LineBits: u32 {
        /// Exactly one of the two faces looks at the eye.
        const CONTOUR = 1 << 31;
        /// Face A looks at the eye. For a contour this says which side is the
        /// outside: a front face lies left of its own direction of traversal.
        const A_FACES = 1 << 30;
        /// The edge is drawn: a contour, or of a class that always is.
        const DRAWN = 1 << 29;
    }
}

/// `CONTOUR[face A looks at the eye][face B looks at the eye]`.
const CONTOUR: [[bool; 2]; 2] = [
    [false, true], // A looks away: a contour if B does not
    [true, false], // A looks at the eye: a contour if B does not
];

/// Decides what a view makes of one edge.
///
/// `has_b` is false where there is no second face; `b_faces` is then unused.
/// Pairs of a non-manifold edge are drawn in every view and are no contours.
///
/// An edge of a solid with both faces turned away from an eye outside of it is
/// hidden by the solid itself, and is not drawn. Left to the depth test it would
/// show at its ends, where its width reaches past the faces in front.
#[must_use]
pub fn classify_edge(
    flags: EdgeFlags,
    has_b: bool,
    a_faces: bool,
    b_faces: bool,
    eye_is_outside: bool,
) -> LineBits {
    let b_faces = b_faces != flags.contains(EdgeFlags::CLASH);
    let is_manifold = has_b && !flags.contains(EdgeFlags::NON_MANIFOLD);
    let is_contour = is_manifold && CONTOUR[usize::from(a_faces)][usize::from(b_faces)];
    let is_behind_solid =
        flags.contains(EdgeFlags::SOLID) && eye_is_outside && !a_faces && !b_faces;
    let is_always_drawn = flags.intersects(EdgeFlags::ALWAYS_DRAWN) && !is_behind_solid;
    let mut bits = LineBits::empty();
    bits.set(LineBits::CONTOUR, is_contour);
    bits.set(LineBits::A_FACES, a_faces);
    bits.set(LineBits::DRAWN, is_contour || is_always_drawn);
    bits
}

/// Equation 1 as the paper evaluates it, from one edge vertex alone.
///
/// Returns whether the edge is a contour, and [`EdgeFlags::RIDGE`] or
/// [`EdgeFlags::VALLEY`] by the cosines of the thresholds, which are angles
/// between the face normals. Boundary and marked edges (`v3 = v0`) are neither.
///
/// The printed `-cos(theta)` takes theta as the internal angle; with theta = 150
/// degrees that is the cosine of 30 degrees, which is what goes in here.
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

/// Whether the eye lies outside of the box from `min` to `max`, and so outside of
/// every solid in it; a viewer at infinity (w = 0) does.
#[must_use]
pub fn eye_is_outside(eye: Vec4, min: Vec3, max: Vec3) -> bool {
    let eye_point = eye.truncate();
    eye.w == 0.0 || eye_point.cmplt(min).any() || eye_point.cmpgt(max).any()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_contour_has_one_face_of_each_kind() {
        let is_contour =
            |flags, a, b| classify_edge(flags, true, a, b, true).contains(LineBits::CONTOUR);
        for (a, b) in [(false, false), (true, true)] {
            assert!(!is_contour(EdgeFlags::empty(), a, b));
            assert!(is_contour(EdgeFlags::CLASH, a, b), "a clash turns face B around");
        }
        for (a, b) in [(false, true), (true, false)] {
            assert!(is_contour(EdgeFlags::empty(), a, b));
            assert!(is_contour(EdgeFlags::DIAGONAL, a, b), "a diagonal can be a contour");
            assert!(!is_contour(EdgeFlags::NON_MANIFOLD, a, b));
        }
    }

    #[test]
    fn what_is_drawn_without_a_contour() {
        let is_drawn =
            |flags| classify_edge(flags, false, true, false, true).contains(LineBits::DRAWN);
        assert!(!is_drawn(EdgeFlags::empty()));
        assert!(!is_drawn(EdgeFlags::DIAGONAL));
        for flags in EdgeFlags::ALWAYS_DRAWN.iter() {
            assert!(is_drawn(flags), "{flags:?}");
        }
    }

    #[test]
    fn a_solid_hides_its_own_back_from_an_eye_outside() {
        let ridge = EdgeFlags::RIDGE | EdgeFlags::SOLID;
        let is_drawn = |flags, a, b, outside| {
            classify_edge(flags, true, a, b, outside).contains(LineBits::DRAWN)
        };
        assert!(!is_drawn(ridge, false, false, true));
        assert!(is_drawn(ridge, false, false, false), "from inside it is seen");
        assert!(is_drawn(EdgeFlags::RIDGE, false, false, true), "an open surface hides nothing");
        for (a, b) in [(true, true), (true, false), (false, true)] {
            assert!(is_drawn(ridge, a, b, true));
        }
        let outside = |eye: [f32; 4]| eye_is_outside(eye.into(), Vec3::ZERO, Vec3::ONE);
        assert!(outside([0.5, 0.5, 1.1, 1.0]) && !outside([0.5, 0.5, 1.0, 1.0]));
        assert!(outside([0.5, 0.5, 0.5, 0.0]), "a direction");
    }
}
