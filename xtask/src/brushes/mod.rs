//! `cargo xtask brushes`: the stroke textures, and the images of techniques
//! (`crate::images`).
//!
//! u runs along the stroke and repeats, v from 0 at the outer rim (top row) to 1
//! at the inner rim. The color is ink; how much of it covers the paper is alpha.
//!
//! Only +, -, *, / and square roots are used, which round alike everywhere, so the
//! pictures are the same on every machine.

mod canvas;
mod charcoal;
mod dash;
mod fur;
mod noise;
mod pen;
mod watercolor;

use std::path::PathBuf;

use image::{GrayAlphaImage, LumaA};

use crate::failure::Failure;
use crate::{images, programs};

/// Black ink.
const INK: u8 = 0;

pub(crate) fn run() -> Result<(), Failure> {
    for (name, picture) in pictures() {
        let path = folder().join(name);
        picture.save(&path).map_err(|error| Failure::file("write", &path, error))?;
        println!("{}", path.display());
    }
    for (name, picture) in images::pictures() {
        let path = folder().join(name);
        let made = path.parent().map_or(Ok(()), std::fs::create_dir_all);
        made.map_err(|error| Failure::file("write", &path, error))?;
        let bytes = images::encoded(&picture);
        let written = bytes.map(|bytes| std::fs::write(&path, bytes));
        match written {
            Ok(Ok(())) => println!("{}", path.display()),
            Ok(Err(error)) => return Err(Failure::file("write", &path, error)),
            Err(error) => return Err(Failure::file("write", &path, error)),
        }
    }
    Ok(())
}

fn folder() -> PathBuf {
    programs::workspace_root().join("brushes")
}

/// Every brush and its file.
fn pictures() -> [(&'static str, GrayAlphaImage); 5] {
    [
        ("pen.png", pen::picture()),
        ("charcoal.png", charcoal::picture()),
        ("watercolor.png", watercolor::picture()),
        ("fur.png", fur::picture()),
        ("dash.png", dash::picture()),
    ]
}

/// A picture of a coverage that depends on u and v: the mean of `samples` x `samples`
/// points per pixel.
fn paint(
    width_px: u32,
    height_px: u32,
    samples: u32,
    coverage: impl Fn(f64, f64) -> f64,
) -> GrayAlphaImage {
    let place =
        |pixel: u32, sample: u32| f64::from(pixel) + (f64::from(sample) + 0.5) / f64::from(samples);
    GrayAlphaImage::from_fn(width_px, height_px, |x, y| {
        let mut sum = 0.0;
        for row in 0..samples {
            let v = place(y, row) / f64::from(height_px);
            for column in 0..samples {
                sum += coverage(place(x, column) / f64::from(width_px), v);
            }
        }
        LumaA([INK, to_byte(sum / f64::from(samples * samples))])
    })
}

fn to_byte(part: f64) -> u8 {
    #[expect(clippy::cast_possible_truncation, reason = "clamped to a byte")]
    let byte = (part.clamp(0.0, 1.0) * 255.0).round() as u8;
    byte
}

/// The share of a row that ink covers, 0 to 1.
#[cfg(test)]
fn mean_of_row(picture: &GrayAlphaImage, y: u32) -> f64 {
    let alpha = |x| f64::from(picture.get_pixel(x, y).0[1]) / 255.0;
    (0..picture.width()).map(alpha).sum::<f64>() / f64::from(picture.width())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The mean difference in alpha of two columns.
    fn step(picture: &GrayAlphaImage, left: u32, right: u32) -> f64 {
        let alpha = |x, y| picture.get_pixel(x, y).0[1];
        let rows = 0..picture.height();
        let sum: f64 = rows.map(|y| f64::from(alpha(left, y).abs_diff(alpha(right, y)))).sum();
        sum / f64::from(picture.height())
    }

    /// The step from the last column to the first one, and the 95th percentile of the steps
    /// between neighbors.
    fn seam(picture: &GrayAlphaImage) -> (f64, f64) {
        let mut inside: Vec<f64> = (1..picture.width()).map(|x| step(picture, x - 1, x)).collect();
        inside.sort_by(f64::total_cmp);
        (step(picture, picture.width() - 1, 0), inside[inside.len() * 95 / 100])
    }

    #[test]
    fn no_seam_shows() {
        for (name, picture) in pictures() {
            let (seam, inside) = seam(&picture);
            println!("{name}: {seam:.2} at the seam, up to {inside:.2} inside");
            assert!(seam <= inside, "{name}: {seam:.2} at the seam, {inside:.2} inside");
        }
    }

    #[test]
    fn a_seam_shows_in_half_a_brush() {
        for (name, picture) in pictures() {
            let (width, height) = picture.dimensions();
            let half = image::imageops::crop_imm(&picture, 0, 0, width / 2, height).to_image();
            let (seam, inside) = seam(&half);
            println!("half of {name}: {seam:.2} at the seam, up to {inside:.2} inside");
            assert!(seam > inside, "half of {name}: {seam:.2} at the seam, {inside:.2} inside");
        }
    }

    #[test]
    fn rims_are_paper_but_for_the_dash() {
        for (name, picture) in pictures().into_iter().filter(|&(name, _)| name != "dash.png") {
            for y in [0, picture.height() - 1] {
                let mean = mean_of_row(&picture, y);
                assert!(mean < 0.002, "{name} has ink in row {y}: {mean}");
            }
        }
    }

    #[test]
    fn the_files_are_what_the_generator_writes() {
        for (name, picture) in pictures() {
            let path = folder().join(name);
            let file = image::open(&path).unwrap();
            assert_eq!(file.color(), image::ColorType::La8, "{name}");
            let same = file.to_luma_alpha8() == picture;
            assert!(same, "{name} is stale: run `cargo xtask brushes`");
            assert!(std::fs::metadata(&path).unwrap().len() < 40_000, "{name} is large");
        }
    }
}
