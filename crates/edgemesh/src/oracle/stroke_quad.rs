//! The stroke quad (paper, Equation 2) and the half quad (Equation 3).
//!
//! ```text
//!   3 ---------------- 2    s + p        half quad, outside = +1:
//!   |                  |                 3 ------------- 2
//!   s0 ============== s1                 |               |
//!   |                  |                 0 ============= 1
//!   0 ---------------- 1    s - p
//! ```
//!
//! The quad of the paper is two units thick and scaled to taste; here widths are in pixels. A half
//! quad is as wide as the full quad of the same stroke, so that contours and creases of a style
//! look equally heavy.
//!
//! WGSL twin: `shaders/common/stroke_quad.wgsl`.

use glam::Vec2;

use crate::line::Placement;

/// The offsets of the near side (the paper's corners 0 and 1) and the far side (2 and 3) of a
/// stroke from the spine along p. `outside` is +1 for the side of p, -1 for the other side.
#[must_use]
pub(super) fn quad_offsets(placement: Placement, outside: f32, width_px: f32) -> Vec2 {
    match placement {
        Placement::Centered | Placement::Automatic => Vec2::new(-0.5, 0.5) * width_px,
        Placement::Outside => Vec2::new(0.0, outside * width_px),
        Placement::Inside => Vec2::new(0.0, -outside * width_px),
    }
}

/// The sign of the paper: -1 for a negative argument, +1 for any other.
#[must_use]
pub(super) fn stroke_sign(value: f32) -> f32 {
    if value < 0.0 { -1.0 } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_half_quad_is_as_wide_as_a_full_one() {
        for placement in [Placement::Centered, Placement::Outside, Placement::Inside] {
            for outside in [1.0, -1.0] {
                let sides = quad_offsets(placement, outside, 6.0);
                assert!(((sides.y - sides.x).abs() - 6.0).abs() < f32::EPSILON, "{placement:?}");
            }
        }
        assert_eq!(quad_offsets(Placement::Outside, -1.0, 6.0), Vec2::new(0.0, -6.0));
        assert_eq!(quad_offsets(Placement::Inside, -1.0, 6.0), Vec2::new(0.0, 6.0));
    }

    #[test]
    fn zero_counts_as_positive() {
        assert_eq!([-0.5, 0.0, 2.0].map(stroke_sign), [-1.0, 1.0, 1.0]);
    }
}
