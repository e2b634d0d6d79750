//! A wash of watercolor: translucent, with dark rims where it dries last.
//!
//! ```text
//!   v = 0  . . . . . . . . .   paper
//!          __---___-----___    dark rim, wandering, sharp to the outside
//!          : .  :   .. :  .
//!           .  .::  . : .      thin wash: blotches, grains of pigment
//!          : .   .  : :  .
//!          --___---___--___    dark rim
//!   v = 1  . . . . . . . . .   paper
//! ```

use image::GrayAlphaImage;

use super::noise::{grain, mix, noise, smooth_step};
use super::paint;

const WIDTH_PX: u32 = 512;
const HEIGHT_PX: u32 = 64;

pub(super) fn picture() -> GrayAlphaImage {
    paint(WIDTH_PX, HEIGHT_PX, 3, coverage)
}

fn coverage(u: f64, v: f64) -> f64 {
    let outer_px = (v - rim(u, 1)) * f64::from(HEIGHT_PX);
    let inner_px = (1.0 - rim(u, 2) - v) * f64::from(HEIGHT_PX);
    let grains = grains(u, v);
    let wash = 0.30 + 0.26 * blotches(u, v) + 0.12 * (grains - 0.5);
    let dark = rim_pigment(u, outer_px, 3).max(rim_pigment(u, inner_px, 4));
    // Pigment adds up like layers of glass.
    let layers = 1.0 - (1.0 - wash) * (1.0 - dark * (0.85 + 0.3 * grains));
    smooth_step(-0.7, 1.3, outer_px.min(inner_px)) * layers
}

/// Pigment that flowed to a rim: sharp toward the paper, fading into the wash.
fn rim_pigment(u: f64, depth_px: f64, seed: u32) -> f64 {
    let strength = mix(0.40, 0.85, noise(u, 0.0, 9, seed + 50));
    let width_px = mix(6.0, 13.0, noise(u, 0.0, 13, seed + 60));
    let fade = 1.0 - smooth_step(1.0, width_px, depth_px);
    strength * fade
}

/// How long the wash stood, from 0 to 1. Water that ran back into the wash left some of
/// the borders sharp.
fn blotches(u: f64, v: f64) -> f64 {
    let cloud = noise(u, v * 1.3, 5, 11) * 0.5
        + noise(u, v * 2.2, 12, 12) * 0.3
        + grain(u, v, 31, 13) * 0.15
        + grain(u, v, 71, 14) * 0.05;
    let border = smooth_step(0.50, 0.54, cloud) * (1.0 - smooth_step(0.54, 0.64, cloud));
    0.85 * smooth_step(0.25, 0.75, cloud) + 0.3 * border * noise(u, v, 9, 15)
}

/// Pigment in the hollows of the paper, from 0 to 1.
fn grains(u: f64, v: f64) -> f64 {
    let paper = grain(u, v, 113, 23) * 0.5 + grain(u, v, 211, 24) * 0.5;
    smooth_step(0.2, 0.8, paper)
}

/// The place of a rim, as a fraction of the height.
fn rim(u: f64, seed: u32) -> f64 {
    let waver = noise(u, 0.0, 4, seed) * 0.45 + noise(u, 0.0, 11, seed + 30) * 0.4;
    let paper = noise(u, 0.0, 29, seed + 40) * 0.10 + noise(u, 0.0, 67, seed + 45) * 0.05;
    0.03 + 0.18 * (waver + paper)
}

#[cfg(test)]
mod tests {
    use super::super::mean_of_row;
    use super::*;

    #[test]
    fn a_thin_wash_between_darker_rims() {
        let wash = picture();
        let middle = mean_of_row(&wash, 32);
        assert!((0.35..0.6).contains(&middle), "middle {middle}");
        for rows in [4..20, 44..60] {
            let darkest = rows.map(|y| mean_of_row(&wash, y)).fold(0.0, f64::max);
            assert!(darkest > middle + 0.05, "rim {darkest}, middle {middle}");
        }
    }
}
