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
//! The paper's quad is two units thick and scaled to taste; here widths are in
//! pixels. A half quad is as wide as the whole quad of the same stroke, so that
//! contours and creases of one style look equally heavy.
//!
//! WGSL twin: `shaders/common/stroke_quad.wgsl`.

use glam::Vec2;

use super::spine::Spine;

/// Corner `i` (0 to 3) of the full quad, `half_width_px` to each side.
#[must_use]
pub fn stroke_quad(spine: &Spine, half_width_px: f32, i: u32) -> Vec2 {
    let s = if i == 1 || i == 2 { spine.s1 } else { spine.s0 };
    let side = if i >= 2 { 1.0 } else { -1.0 };
    s + spine.p * (half_width_px * side)
}

/// Corner `i` (0 to 3) of the half quad on the side `outside` (+1 is the side
/// of p, -1 the other).
#[must_use]
pub fn half_quad(spine: &Spine, width_px: f32, outside: f32, i: u32) -> Vec2 {
    let s = if i == 1 || i == 2 { spine.s1 } else { spine.s0 };
    let reach = if i >= 2 { outside * width_px } else { 0.0 };
    s + spine.p * reach
}

/// The paper's sign: -1 for a negative argument and +1 for any other.
#[must_use]
pub fn sign(value: f32) -> f32 {
    if value < 0.0 { -1.0 } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spine() -> Spine {
        Spine { s1: Vec2::new(10.0, 0.0), p: Vec2::Y, t1: 1.0, ..Spine::default() }
    }

    #[test]
    fn equation_2() {
        let corners = [0, 1, 2, 3].map(|i| stroke_quad(&spine(), 3.0, i).to_array());
        assert_eq!(corners, [[0., -3.], [10., -3.], [10., 3.], [0., 3.]]);
    }

    #[test]
    fn equation_3_on_either_side() {
        for outside in [1.0, -1.0] {
            let corners = [0, 1, 2, 3].map(|i| half_quad(&spine(), 3.0, outside, i).to_array());
            assert_eq!(corners, [[0., 0.], [10., 0.], [10., 3. * outside], [0., 3. * outside]]);
        }
    }

    #[test]
    fn the_sign_of_zero_is_plus() {
        assert!(sign(0.0) > 0.0 && sign(-1e-9) < 0.0);
    }
}
