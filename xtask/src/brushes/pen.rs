//! A steel pen: dark up to the rims, which the grain of the paper roughens.
//!
//! ```text
//!   v = 0  . . . . . . . . .   paper
//!          ~-_~~-__~~-_-~~~    ragged rim
//!          ================
//!          ==== -- ====- ==    full ink, thin streaks where it runs short
//!          ================
//!          _~~-_-~~__-~~_-~    ragged rim
//!   v = 1  . . . . . . . . .   paper
//! ```

use image::GrayAlphaImage;

use super::noise::{noise, smooth_step};
use super::paint;

const WIDTH_PX: u32 = 512;
const HEIGHT_PX: u32 = 64;

pub(super) fn picture() -> GrayAlphaImage {
    paint(WIDTH_PX, HEIGHT_PX, 1, coverage)
}

fn coverage(u: f64, v: f64) -> f64 {
    let outer = rim_depth(u, 1);
    let inner = rim_depth(u, 2);
    // Height above the nearer rim, in pixels of the texture.
    let depth_px = (v - outer).min(1.0 - inner - v) * f64::from(HEIGHT_PX);
    smooth_step(0.0, 2.5, depth_px) * (1.0 - streak(u, v, depth_px))
}

/// The distance of the ink from one rim of the texture, as a fraction of its height: the
/// slow waver of the hand and the grain of the paper.
fn rim_depth(u: f64, seed: u32) -> f64 {
    let waver = noise(u, 0.0, 4, seed) * 0.6 + noise(u, 0.0, 11, seed + 10) * 0.4;
    let grain = noise(u, 0.0, 61, seed + 20) * 0.6 + noise(u, 0.0, 149, seed + 30) * 0.4;
    0.02 + 0.13 * waver + 0.05 * grain * grain
}

/// The share of ink that is missing: fine lines along the stroke, more of them where the
/// ink runs short and near the rims, where the tines of the pen press.
fn streak(u: f64, v: f64, depth_px: f64) -> f64 {
    let short = noise(u, v * 3.0, 5, 41) * 0.6 + noise(u, v * 3.0, 11, 42) * 0.4;
    let near_rim = 1.0 - smooth_step(2.0, 12.0, depth_px);
    let line = noise(u, v * 26.0, 6, 43) * 0.6
        + noise(u, v * 45.0, 17, 44) * 0.3
        + noise(u, v * 64.0, 83, 45) * 0.1;
    let amount = 0.9 * smooth_step(0.3, 0.8, short) + 0.3 * near_rim;
    (amount * smooth_step(0.48, 0.8, line)).min(0.9)
}

#[cfg(test)]
mod tests {
    use super::super::mean_of_row;
    use super::*;

    #[test]
    fn ink_in_the_core_and_none_at_the_rims() {
        let pen = picture();
        assert_eq!((mean_of_row(&pen, 0), mean_of_row(&pen, HEIGHT_PX - 1)), (0.0, 0.0));
        for y in 16..48 {
            let mean = mean_of_row(&pen, y);
            assert!(mean > 0.78, "row {y} holds too little ink: {mean}");
        }
    }
}
