//! A stick of charcoal on rough paper: dark and nearly closed in the middle,
//! grains toward the rims, where only the paper's teeth catch it.
//!
//! The ink is pressure against the height of the paper: it lies where the paper is
//! higher than the stick.
//!
//! ```text
//!   v = 0   .  '  . .  '  .     single grains
//!          ' :.:'::. :.':.:
//!          :::#:##::##:#::#     pressure grows to the middle
//!          ####:###:#######
//!          :#::##:#::#:##::
//!   v = 1   .' .  :.  '. .
//! ```

use image::GrayAlphaImage;

use super::noise::{grain, noise, smooth_step};
use super::paint;

const WIDTH_PX: u32 = 512;
const HEIGHT_PX: u32 = 64;

pub(super) fn picture() -> GrayAlphaImage {
    paint(WIDTH_PX, HEIGHT_PX, 3, coverage)
}

fn coverage(u: f64, v: f64) -> f64 {
    let depth = (v - rim(u, 1)).min(1.0 - rim(u, 2) - v);
    let valley = valley(u, v);
    // Grains of full strength, and dust that is rubbed into the valleys.
    let grain = smooth_step(-0.22, 0.26, pressure(u, v, depth) - valley);
    let dust = 0.42 * smooth_step(0.04, 0.36, depth) * (1.0 - 0.5 * valley);
    let touched = smooth_step(-0.05, 0.01, depth);
    touched * (dust + (0.95 - dust) * grain)
}

/// The pressure of the stick, from 0 at the rims to more than the deepest valley; less
/// where the hand was light and in the tracks of a worn stick.
fn pressure(u: f64, v: f64, depth: f64) -> f64 {
    let across = 0.55 * smooth_step(-0.05, 0.10, depth) + 0.45 * smooth_step(0.05, 0.40, depth);
    let hand = noise(u, 0.0, 5, 21) * 0.5 + noise(u, v * 2.0, 13, 22) * 0.5;
    let track = noise(u, v * 14.0, 5, 23) * 0.6 + noise(u, v * 22.0, 9, 24) * 0.4;
    across * (0.89 + 0.40 * (hand - 0.5) + 0.55 * (track - 0.5))
}

/// The depth of the paper, from 0 at its teeth to 1: lumps of about 4 pixels and finer
/// ones, with eight times fewer rows than columns, so that they are round.
fn valley(u: f64, v: f64) -> f64 {
    let lumps =
        grain(u, v, 127, 31) * 0.40 + grain(u, v, 199, 32) * 0.33 + grain(u, v, 307, 33) * 0.27;
    // Sums of noise cluster around the middle; this spreads them out.
    smooth_step(0.2, 0.8, lumps)
}

/// The place of a rim, as a fraction of the height.
fn rim(u: f64, seed: u32) -> f64 {
    let waver = noise(u, 0.0, 4, seed) * 0.5 + noise(u, 0.0, 9, seed + 4) * 0.5;
    let crumbs = noise(u, 0.0, 43, seed + 8) * 0.6 + noise(u, 0.0, 101, seed + 12) * 0.4;
    0.04 + 0.07 * waver + 0.08 * crumbs
}

#[cfg(test)]
mod tests {
    use super::super::mean_of_row;
    use super::*;

    #[test]
    fn darker_in_the_middle_than_towards_the_rims() {
        let charcoal = picture();
        let [rim, between, middle] = [4, 14, 32].map(|y| mean_of_row(&charcoal, y));
        assert!(rim < 0.2, "rim {rim}");
        assert!(rim < between && between < middle, "{rim}, {between}, {middle}");
        assert!(middle > 0.7, "middle {middle}");
    }
}
