//! Start and finish caps (paper, Equations 4 and 5), and half disks in their place (section 6).
//!
//! A cap is the triangle between the end of the spine, the end of the quad and the tip of the
//! projected vertex normal m. Edges at a vertex do not know each other, but all of them know m, so
//! their caps meet there:
//!
//! ```text
//!          m                the gap between two quads is filled by
//!        . | .              two triangles that share the side s - m
//!   p  /   |   \  p'
//!    |_____s_____|
//! ```
//!
//! As printed, Equation 5 uses the side of m1 and the half quad the side of m0; if these differ,
//! the cap would lie across its quad. Here the cap follows its quad: `outside` is given, and m is
//! turned to that side.
//!
//! Only the convex side of a bend has a gap; where m leans back over the quad, two quads overlap.
//! The winding by j in the paper makes such a cap a back face. It is left out, because it would
//! only add ink over its quad.
//!
//! WGSL twin: `shaders/common/stroke_cap.wgsl`.

use std::cmp::Ordering;

use glam::Vec2;

use super::stroke_quad::stroke_sign;
use crate::line::DISK_STEPS;

/// The corner number j of the paper for corner `i` (0 to 2): reversed if `outside` is -1, so that
/// the triangle always has the same winding.
#[must_use]
pub(super) fn cap_corner(outside: f32, i: u32) -> u32 {
    if outside > 0.0 { i } else { 2 - i }
}

/// Corner `j` of the cap at the end `s` of a spine with perpendicular `p`.
///
/// `m` is the projected vertex normal, of unit length or zero. `reach_px` is the reach of the cap:
/// the width of a half quad, or half the width of a full quad. Equation 4 with s0 and m0, Equation
/// 5 with s1 and m1.
#[must_use]
pub(super) fn stroke_cap(s: Vec2, p: Vec2, m: Vec2, outside: f32, reach_px: f32, j: u32) -> Vec2 {
    match j {
        0 => s,
        1 => s + p * (outside * reach_px),
        _ => s + m * (stroke_sign(m.dot(p)) * outside * reach_px),
    }
}

/// Whether a cap fills a gap: `m`, turned to the side `outside`, leans out beyond the end of the
/// quad. `forward` is +1 at the finish and -1 at the start.
#[must_use]
pub(super) fn cap_fills_gap(p: Vec2, m: Vec2, outside: f32, forward: f32) -> bool {
    let beyond = Vec2::new(p.y, -p.x) * forward;
    m.dot(beyond) * stroke_sign(m.dot(p)) * outside > 0.0
}

/// The offset of step `k` (0 to [`DISK_STEPS`]) of the half disk from the end of the spine. The
/// steps go from the left rim (the side of p) around the end to the right rim.
///
/// `forward` is +1 at the finish and -1 at the start. `left_px` and `right_px` are the reach of the
/// quad on each side. One of them is 0 for a half quad, which gets a quarter disk, enough for turns
/// of up to 90 degrees.
#[must_use]
pub(super) fn half_disk(p: Vec2, forward: f32, left_px: f32, right_px: f32, k: u32) -> Vec2 {
    #[expect(clippy::cast_precision_loss, reason = "at most DISK_STEPS")]
    let angle = std::f32::consts::PI * k as f32 / DISK_STEPS as f32;
    let beyond = Vec2::new(p.y, -p.x) * forward;
    let radius_px = match (2 * k).cmp(&DISK_STEPS) {
        Ordering::Less => left_px,
        // Both radii meet here; that of a half quad must not be cut off.
        Ordering::Equal => left_px.max(right_px),
        Ordering::Greater => right_px,
    };
    (p * angle.cos() + beyond * angle.sin()) * radius_px
}

#[cfg(test)]
mod tests {
    use super::*;

    const P: Vec2 = Vec2::Y;

    #[test]
    fn equation_4_on_the_side_of_the_normal() {
        let m = Vec2::new(-0.6, 0.8);
        let s = Vec2::new(5.0, 5.0);
        let corners = [0, 1, 2].map(|j| stroke_cap(s, P, m, 1.0, 10.0, j).to_array());
        assert_eq!(corners, [[5., 5.], [5., 15.], [-1., 13.]]);
    }

    #[test]
    fn the_cap_follows_its_quad() {
        let m = Vec2::new(0.6, -0.8);
        for outside in [1.0, -1.0] {
            let tip = stroke_cap(Vec2::ZERO, P, m, outside, 1.0, 2);
            assert!(tip.dot(P) * outside > 0.0, "{tip}");
        }
    }

    #[test]
    fn j_keeps_the_winding() {
        for outside in [1.0, -1.0] {
            let m = Vec2::new(-0.6, 0.8 * outside);
            let corner = |i| stroke_cap(Vec2::ZERO, P, m, outside, 1.0, cap_corner(outside, i));
            let [a, b, c] = [0, 1, 2].map(corner);
            assert!((b - a).perp_dot(c - a) > 0.0, "outside {outside}");
        }
    }

    #[test]
    fn caps_fill_gaps_and_do_not_lie_over_their_quads() {
        // p points up, so the spine runs to the right.
        for (m, at_start) in [
            (Vec2::new(-0.6, 0.8), true),
            (Vec2::new(0.6, 0.8), false),
            // Turned to the outside, the normals point the other way.
            (Vec2::new(0.6, -0.8), true),
            (Vec2::new(-0.6, -0.8), false),
        ] {
            assert_eq!(cap_fills_gap(P, m, 1.0, -1.0), at_start, "start, {m}");
            assert_eq!(cap_fills_gap(P, m, 1.0, 1.0), !at_start, "finish, {m}");
            assert_eq!(cap_fills_gap(P, m, -1.0, -1.0), !at_start, "start below, {m}");
        }
        assert!(!cap_fills_gap(P, P, 1.0, 1.0), "no bend, no gap");
    }

    #[test]
    fn a_normal_along_the_line_of_sight_leaves_no_cap() {
        let tip = stroke_cap(Vec2::ONE, P, Vec2::ZERO, 1.0, 10.0, 2);
        assert_eq!(tip, Vec2::ONE);
    }

    #[test]
    fn half_disks_go_around_the_end() {
        let around = |forward: f32| {
            [0, DISK_STEPS / 2, DISK_STEPS].map(|k| half_disk(Vec2::Y, forward, 2.0, 2.0, k))
        };
        for (forward, tip) in [(1.0, Vec2::X), (-1.0, Vec2::NEG_X)] {
            for (got, want) in around(forward).into_iter().zip([Vec2::Y, tip, Vec2::NEG_Y]) {
                assert!(got.distance(want * 2.0) < 1e-5, "{got} {want}");
            }
        }
        // A half quad has a quarter of one.
        let quarter = |k| half_disk(Vec2::Y, 1.0, 2.0, 0.0, k).length();
        assert!((quarter(DISK_STEPS / 2) - 2.0).abs() < 1e-5);
        assert!(quarter(DISK_STEPS / 2 + 1) < 1e-5);
    }
}
