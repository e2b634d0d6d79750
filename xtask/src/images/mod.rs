//! The images of techniques: toon maps, papers, tonal art maps. `cargo xtask brushes`
//! writes them.
//!
//! Only +, -, *, / and square roots are used, which round alike everywhere, so the
//! pictures are the same on every machine.

mod paper;
mod tonal_art_map;
mod toon_map;

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{DynamicImage, RgbImage};

/// Every image, by its folder and file in `brushes/`.
pub(crate) fn pictures() -> Vec<(String, RgbImage)> {
    let mut pictures = Vec::new();
    for (name, picture) in toon_map::pictures() {
        pictures.push((format!("toon_maps/{name}.png"), picture));
    }
    for (name, picture) in paper::pictures() {
        pictures.push((format!("papers/{name}.png"), picture));
    }
    for (name, picture) in tonal_art_map::pictures() {
        pictures.push((format!("tonal_art_maps/{name}.png"), picture));
    }
    pictures
}

/// A picture as a small PNG; a gray one has one channel.
pub(crate) fn encoded(picture: &RgbImage) -> Result<Vec<u8>, image::ImageError> {
    let mut bytes = Vec::new();
    let encoder =
        PngEncoder::new_with_quality(&mut bytes, CompressionType::Best, FilterType::Adaptive);
    let is_gray =
        picture.pixels().all(|pixel| pixel.0[0] == pixel.0[1] && pixel.0[1] == pixel.0[2]);
    if is_gray {
        DynamicImage::from(picture.clone()).to_luma8().write_with_encoder(encoder)?;
    } else {
        picture.write_with_encoder(encoder)?;
    }
    Ok(bytes)
}

/// A light from 0 to 1 as a byte.
fn to_byte(part: f64) -> u8 {
    #[expect(clippy::cast_possible_truncation, reason = "clamped to a byte")]
    let byte = (part.clamp(0.0, 1.0) * 255.0).round() as u8;
    byte
}

/// A pseudorandom number from 0 to 1.
fn hash(column: u32, row: u32, seed: u32) -> f64 {
    let mut bits = column.wrapping_mul(0x9E37_79B1);
    for word in [row, seed] {
        bits = (bits ^ word).wrapping_mul(0x85EB_CA6B);
        bits = (bits ^ (bits >> 15)).wrapping_mul(0xC2B2_AE35);
        bits ^= bits >> 13;
    }
    f64::from(bits) / f64::from(u32::MAX)
}

/// Smooth noise from 0 to 1 that repeats after 1 both ways, with `cells` periods of its
/// lattice.
fn noise(u: f64, v: f64, cells: u32, seed: u32) -> f64 {
    let (column, across) = cell_of(u * f64::from(cells));
    let (row, down) = cell_of(v * f64::from(cells));
    let at = |c: u32, r: u32| hash(c % cells, r % cells, seed);
    let mix = |a: f64, b: f64, part: f64| a + (b - a) * part;
    let top = mix(at(column, row), at(column + 1, row), across);
    let bottom = mix(at(column, row + 1), at(column + 1, row + 1), across);
    mix(top, bottom, down)
}

/// The lattice cell and where in it, eased so that cells join without a kink.
fn cell_of(position: f64) -> (u32, f64) {
    #[expect(clippy::cast_possible_truncation, reason = "positions are small")]
    let cell = position.max(0.0) as u32;
    let t = position - f64::from(cell);
    (cell, t * t * (3.0 - 2.0 * t))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_files_are_what_the_generator_writes() {
        for (name, picture) in pictures() {
            let path = crate::programs::workspace_root().join("brushes").join(&name);
            let file = image::open(&path).unwrap().to_rgb8();
            assert!(file == picture, "{name} is stale: run `cargo xtask brushes`");
            assert!(std::fs::metadata(&path).unwrap().len() < 200_000, "{name} is large");
        }
    }

    #[test]
    fn noise_repeats_both_ways() {
        for step in 0..500_u32 {
            let (u, v) = (hash(step, 0, 1), hash(step, 1, 1));
            let there = noise(u, v, 9, 4);
            assert!((there - noise(u + 1.0, v, 9, 4)).abs() < 1e-9, "along u at {u}, {v}");
            assert!((there - noise(u, v + 1.0, 9, 4)).abs() < 1e-9, "along v at {u}, {v}");
        }
    }
}
