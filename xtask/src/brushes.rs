//! `cargo xtask brushes`: the stroke textures.
//!
//! u runs along the stroke and repeats, v from 0 at the outer rim (top row) to 1
//! at the inner rim. The colour is ink; how much of it covers the paper is alpha.
//!
//! Only +, -, * and / are used, so the pictures are the same on every machine.
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

use std::path::PathBuf;

use image::{GrayAlphaImage, LumaA};

use crate::failure::Failure;
use crate::programs;

const WIDTH_PX: u32 = 512;
const HEIGHT_PX: u32 = 64;

/// Black ink.
const INK: u8 = 0;

pub(crate) fn run() -> Result<(), Failure> {
    let path = pen_path();
    pen().save(&path).map_err(|error| Failure::file("write", &path, error))?;
    println!("{}", path.display());
    Ok(())
}

fn pen_path() -> PathBuf {
    programs::workspace_root().join("brushes/pen.png")
}

/// A pen of steel: dark to the rims, which the paper's grain roughens.
fn pen() -> GrayAlphaImage {
    GrayAlphaImage::from_fn(WIDTH_PX, HEIGHT_PX, |x, y| {
        let u = (f64::from(x) + 0.5) / f64::from(WIDTH_PX);
        let v = (f64::from(y) + 0.5) / f64::from(HEIGHT_PX);
        LumaA([INK, to_byte(pen_coverage(u, v))])
    })
}

fn pen_coverage(u: f64, v: f64) -> f64 {
    let outer = rim_depth(u, 1);
    let inner = rim_depth(u, 2);
    // Height above the nearer rim, in pixels of the texture.
    let depth_px = (v - outer).min(1.0 - inner - v) * f64::from(HEIGHT_PX);
    smooth_step(0.0, 2.5, depth_px) * (1.0 - streak(u, v, depth_px))
}

/// How far the ink stays from one rim of the texture, as a part of its height:
/// the hand's slow waver and the paper's grain.
fn rim_depth(u: f64, seed: u32) -> f64 {
    let waver = noise(u, 0.0, 4, seed) * 0.6 + noise(u, 0.0, 11, seed + 10) * 0.4;
    let grain = noise(u, 0.0, 61, seed + 20) * 0.6 + noise(u, 0.0, 149, seed + 30) * 0.4;
    0.02 + 0.13 * waver + 0.05 * grain * grain
}

/// How much ink is missing: fine lines along the stroke, more of them where the
/// ink runs short and near the rims, where the pen's tines press.
fn streak(u: f64, v: f64, depth_px: f64) -> f64 {
    let short = noise(u, v * 3.0, 5, 41) * 0.6 + noise(u, v * 3.0, 11, 42) * 0.4;
    let near_rim = 1.0 - smooth_step(2.0, 12.0, depth_px);
    let line = noise(u, v * 26.0, 6, 43) * 0.6
        + noise(u, v * 45.0, 17, 44) * 0.3
        + noise(u, v * 64.0, 83, 45) * 0.1;
    let amount = 0.9 * smooth_step(0.3, 0.8, short) + 0.3 * near_rim;
    (amount * smooth_step(0.48, 0.8, line)).min(0.9)
}

/// Smooth noise from 0 to 1, with `cells` periods of the lattice along u, after
/// which it repeats; along v it does not.
fn noise(u: f64, v: f64, cells: u32, seed: u32) -> f64 {
    let (column, across) = cell_of(u * f64::from(cells));
    let (row, down) = cell_of(v);
    let at = |c: u32, r: u32| hash(c % cells, r, seed);
    let top = mix(at(column, row), at(column + 1, row), across);
    let bottom = mix(at(column, row + 1), at(column + 1, row + 1), across);
    mix(top, bottom, down)
}

/// The lattice cell and where in it, eased so that cells join without a kink.
fn cell_of(position: f64) -> (u32, f64) {
    #[expect(clippy::cast_possible_truncation, reason = "positions lie between 0 and 512")]
    let cell = position.max(0.0) as u32;
    (cell, smooth_step(0.0, 1.0, position - f64::from(cell)))
}

/// A number from 0 to 1 that seems to follow from nothing.
fn hash(column: u32, row: u32, seed: u32) -> f64 {
    let mut bits = column.wrapping_mul(0x9E37_79B1);
    for word in [row, seed] {
        bits = (bits ^ word).wrapping_mul(0x85EB_CA6B);
        bits = (bits ^ (bits >> 15)).wrapping_mul(0xC2B2_AE35);
        bits ^= bits >> 13;
    }
    f64::from(bits) / f64::from(u32::MAX)
}

fn mix(a: f64, b: f64, part: f64) -> f64 {
    a + (b - a) * part
}

/// 0 below `low`, 1 above `high`, a smooth slope between.
fn smooth_step(low: f64, high: f64, value: f64) -> f64 {
    let t = ((value - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

fn to_byte(part: f64) -> u8 {
    #[expect(clippy::cast_possible_truncation, reason = "clamped to a byte")]
    let byte = (part.clamp(0.0, 1.0) * 255.0).round() as u8;
    byte
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest step of alpha between two columns, over all rows.
    fn largest_step(pen: &GrayAlphaImage, left: u32, right: u32) -> u8 {
        let alpha = |x, y| pen.get_pixel(x, y).0[1];
        (0..HEIGHT_PX).map(|y| alpha(left, y).abs_diff(alpha(right, y))).max().unwrap()
    }

    #[test]
    fn the_seam_does_not_show() {
        let pen = pen();
        let seam = largest_step(&pen, WIDTH_PX - 1, 0);
        let elsewhere = (1..WIDTH_PX).map(|x| largest_step(&pen, x - 1, x)).max().unwrap();
        assert!(seam <= elsewhere, "a step of {seam} at the seam, {elsewhere} elsewhere");
    }

    #[test]
    fn ink_in_the_core_and_none_at_the_rims() {
        let pen = pen();
        let mean = |y| {
            let sum: u32 = (0..WIDTH_PX).map(|x| u32::from(pen.get_pixel(x, y).0[1])).sum();
            sum / WIDTH_PX
        };
        assert_eq!((mean(0), mean(HEIGHT_PX - 1)), (0, 0), "the rims are paper");
        for y in 16..48 {
            assert!(mean(y) > 200, "row {y} holds too little ink: {}", mean(y));
        }
    }

    #[test]
    fn the_file_is_what_the_generator_writes() {
        let file = image::open(pen_path()).unwrap();
        assert_eq!(file.color(), image::ColorType::La8);
        assert!(file.to_luma_alpha8() == pen(), "pen.png is stale: run `cargo xtask brushes`");
    }
}
