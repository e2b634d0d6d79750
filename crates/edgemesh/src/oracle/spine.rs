//! The spine: an edge projected to the screen, clipped before the divide.
//!
//! The paper projects first, and notes (section 6) that an edge across the eye plane then has no
//! finite ends, which clipping at the near plane would solve. Here edges are clipped in clip space,
//! where the clip parameter is exact. They are also clipped at the sides, far outside of the
//! picture, so that the coordinates of an edge close to the eye fit into 32 bits.
//!
//! Screen positions are in pixels from the middle of the picture, y up. The equations of the paper
//! leave out the divide and the scale of the viewport, without which strokes skew on pictures that
//! are not square.
//!
//! ```text
//!            p      left of the edge
//!            ^
//!   s0 ------+-----> s1
//! ```
//!
//! WGSL twin: `shaders/common/spine.wgsl`.

use glam::{Vec2, Vec4};

use crate::view::to_pixels;

/// The least length of an edge on the screen, in pixels. A shorter edge has no direction, because
/// the eye looks along it, and is not drawn.
pub const MIN_LENGTH_PX: f32 = 1e-4;

/// An edge on the screen.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Spine {
    /// Start, in pixels from the middle of the picture.
    pub s0: Vec2,
    /// End, in pixels from the middle of the picture.
    pub s1: Vec2,
    /// Depth at the start.
    pub z0: f32,
    /// Depth at the end.
    pub z1: f32,
    /// Unit perpendicular, to the left of `s0 -> s1`; zero if nothing is drawn.
    pub p: Vec2,
    /// Parameter of the start on the edge: 0 unless it was clipped.
    pub t0: f32,
    /// Parameter of the end on the edge: 1 unless it was clipped.
    pub t1: f32,
}

/// Clips the segment from `c0` to `c1`, in clip space with depth 1 at the near plane, against
/// the near plane and the guard band: left, right, bottom and top, at w = 1.
///
/// Returns the parameters of the remaining part, `t0 <= t1`; `t0 > t1` if nothing remains.
#[must_use]
fn clip_segment(c0: Vec4, c1: Vec4, band: Vec4) -> Vec2 {
    let mut range = Vec2::new(0.0, 1.0);
    range = clip_by_plane(range, c0.w - c0.z, c1.w - c1.z);
    range = clip_by_plane(range, band.y * c0.w - c0.x, band.y * c1.w - c1.x);
    range = clip_by_plane(range, c0.x - band.x * c0.w, c1.x - band.x * c1.w);
    range = clip_by_plane(range, band.w * c0.w - c0.y, band.w * c1.w - c1.y);
    clip_by_plane(range, c0.y - band.z * c0.w, c1.y - band.z * c1.w)
}

/// Narrows `range` to the part where the distance, `d0` at 0 and `d1` at 1, is not negative.
fn clip_by_plane(range: Vec2, d0: f32, d1: f32) -> Vec2 {
    if d0 < 0.0 && d1 < 0.0 {
        return Vec2::new(1.0, 0.0);
    }
    let crossing = d0 / (d0 - d1);
    if d0 < 0.0 {
        return Vec2::new(range.x.max(crossing), range.y);
    }
    if d1 < 0.0 {
        return Vec2::new(range.x, range.y.min(crossing));
    }
    range
}

/// Projects the edge from `c0` to `c1`, in clip space with depth 1 at the near plane, to a picture
/// of `viewport_px` pixels. `band` is the guard band: left, right, bottom and top, at w = 1.
#[must_use]
pub fn project_spine(c0: Vec4, c1: Vec4, viewport_px: Vec2, band: Vec4) -> Spine {
    let range = clip_segment(c0, c1, band);
    let mut spine = Spine { t0: range.x, t1: range.y, ..Spine::default() };
    if range.x >= range.y {
        return spine;
    }
    let a = lerp(c0, c1, range.x);
    let b = lerp(c0, c1, range.y);
    spine.s0 = to_pixels(a, viewport_px);
    spine.s1 = to_pixels(b, viewport_px);
    spine.z0 = a.z / a.w;
    spine.z1 = b.z / b.w;
    let along = spine.s1 - spine.s0;
    let length = along.length();
    if length >= MIN_LENGTH_PX {
        spine.p = Vec2::new(-along.y, along.x) / length;
    }
    spine
}

/// Interpolates linearly from `c0` at 0 to `c1` at 1, exact at both ends.
#[must_use]
pub fn lerp(c0: Vec4, c1: Vec4, t: f32) -> Vec4 {
    c0 * (1.0 - t) + c1 * t
}

/// The unit direction m of a normal on the screen; zero if the normal points along the line of
/// sight. `clip` is the vertex in clip space, `normal_clip` the normal in clip space, as a
/// direction.
///
/// The paper uses `normalize(MVP [v + n] - s)`. This is its limit for short normals, which does not
/// depend on the size of the model and never crosses the eye plane.
#[must_use]
pub fn screen_normal(clip: Vec4, normal_clip: Vec4, viewport_px: Vec2) -> Vec2 {
    let moved =
        normal_clip.truncate().truncate() * clip.w - clip.truncate().truncate() * normal_clip.w;
    let scaled = moved * viewport_px;
    // Divided by the larger part first, because the square of a tiny vector is zero.
    let largest = scaled.x.abs().max(scaled.y.abs());
    if largest <= 0.0 {
        return Vec2::ZERO;
    }
    let even = scaled / largest;
    even / even.length()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::{GUARD_BAND, WHOLE_BAND};

    const VIEWPORT: Vec2 = Vec2::new(200.0, 100.0);

    #[test]
    fn pixels_are_square_on_a_wide_picture() {
        let spine = project_spine(
            Vec4::new(0.0, 0.0, 0.5, 1.0),
            Vec4::new(0.2, 0.4, 0.5, 1.0),
            VIEWPORT,
            WHOLE_BAND,
        );
        assert_eq!(spine.s1, Vec2::new(20.0, 20.0));
        let root = 0.5_f32.sqrt();
        assert!(spine.p.abs_diff_eq(Vec2::new(-root, root), 1e-6), "left, and of unit length");
    }

    #[test]
    fn an_edge_through_the_eye_plane_is_cut_at_the_near_plane() {
        // w runs from -1 to 1; the near plane is at w = z, here 0.1.
        let c0 = Vec4::new(0.0, 0.0, 0.1, -1.0);
        let c1 = Vec4::new(0.2, 0.0, 0.1, 1.0);
        let spine = project_spine(c0, c1, VIEWPORT, WHOLE_BAND);
        assert!((spine.t0 - 0.55).abs() < 1e-6, "{}", spine.t0);
        assert!((spine.z0 - 1.0).abs() < 1e-5, "{}", spine.z0);
        assert!((spine.t1 - 1.0).abs() < f32::EPSILON);
    }

    #[test]
    fn what_lies_behind_or_points_at_the_eye_is_not_drawn() {
        let behind = Vec4::new(0.0, 0.0, 0.1, -1.0);
        assert_eq!(project_spine(behind, behind * 2.0, VIEWPORT, WHOLE_BAND).p, Vec2::ZERO);
        let near = Vec4::new(0.1, 0.1, 0.1, 1.0);
        assert_eq!(
            project_spine(near, near * Vec4::new(2., 2., 1., 2.), VIEWPORT, WHOLE_BAND).p,
            Vec2::ZERO
        );
    }

    #[test]
    fn far_ends_stay_in_the_guard_band() {
        let c1 = Vec4::new(1e6, 0.0, 0.5, 1.0);
        let spine = project_spine(Vec4::new(0.0, 0.0, 0.5, 1.0), c1, VIEWPORT, WHOLE_BAND);
        assert!(spine.s1.x <= 1.01 * GUARD_BAND * 100.0, "{}", spine.s1.x);
    }

    #[test]
    fn screen_normals_agree_with_a_short_displacement() {
        let clip = Vec4::new(0.3, -0.4, 0.5, 2.0);
        let normal = Vec4::new(0.1, 0.5, -0.2, 0.7);
        let moved = clip + normal * 1e-3;
        let expected = to_pixels(moved, VIEWPORT) - to_pixels(clip, VIEWPORT);
        let m = screen_normal(clip, normal, VIEWPORT);
        assert!(m.abs_diff_eq(expected.normalize_or_zero(), 1e-3), "{m}");
        assert_eq!(screen_normal(clip, clip, VIEWPORT), Vec2::ZERO, "toward the eye");
    }
}
