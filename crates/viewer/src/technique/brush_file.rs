//! Brushes from PNG files.

use std::io::Cursor;

use strokes::{Brush, BrushError};
use thiserror::Error;

/// Why an image cannot be a brush.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum BrushFileError {
    /// It is not a PNG.
    #[error("{name}: not a readable PNG: {reason}")]
    Picture {
        /// The name of the file or the brush.
        name: String,
        /// The decoder's error.
        reason: image::ImageError,
    },
    /// It is too large.
    #[error("{name}: {reason}")]
    Size {
        /// The name of the file or the brush.
        name: String,
        /// The size and the limit.
        reason: BrushError,
    },
}

/// A built-in brush, by a name of [`edgemesh_brushes::BRUSH_NAMES`]; `None` for other names.
///
/// # Errors
/// If the embedded image cannot be read; a test excludes this.
#[must_use]
pub fn shipped_brush(name: &str) -> Option<Result<Brush, BrushFileError>> {
    let image = edgemesh_brushes::image("brushes", name)?;
    Some(brush_from_png(name, image.png))
}

/// Reads a brush from a PNG. The coverage is the alpha channel, or the darkness of an opaque
/// image; `name` is for messages.
///
/// # Errors
/// If the image cannot be read, or a side is longer than [`Brush::MAX_SIDE`].
pub(crate) fn brush_from_png(name: &str, png: &[u8]) -> Result<Brush, BrushFileError> {
    let wrong = |reason| BrushFileError::Picture { name: name.to_owned(), reason };
    let mut reader = image::ImageReader::with_format(Cursor::new(png), image::ImageFormat::Png);
    // Enough for the largest brush with 16 bits per channel.
    let mut limits = image::Limits::default();
    limits.max_alloc = Some(u64::from(Brush::MAX_SIDE) * u64::from(Brush::MAX_SIDE) * 8);
    reader.limits(limits);
    let picture = reader.decode().map_err(wrong)?.to_luma_alpha8();
    let (width, height) = picture.dimensions();
    let is_opaque = picture.pixels().all(|pixel| pixel.0[1] == u8::MAX);
    let coverage = picture.pixels().map(|pixel| {
        let [gray, alpha] = pixel.0;
        if is_opaque { u8::MAX - gray } else { alpha }
    });
    Brush::new(width, height, coverage.collect())
        .map_err(|reason| BrushFileError::Size { name: name.to_owned(), reason })
}

#[cfg(test)]
mod tests {
    use image::GrayImage;

    use super::*;

    #[test]
    fn brushes_that_ship_have_ink_at_every_level() {
        for name in edgemesh_brushes::BRUSH_NAMES {
            let levels = shipped_brush(name).unwrap().unwrap().mip_levels();
            let ink = |level: &GrayImage| {
                level.iter().map(|&alpha| f64::from(alpha)).sum::<f64>() / level.len() as f64
            };
            for level in &levels {
                assert!((ink(level) - ink(&levels[0])).abs() < 3.0, "{:?}", level.dimensions());
            }
            assert!(ink(&levels[0]) > 40.0, "a brush has ink");
        }
        assert!(shipped_brush("oil").is_none());
    }

    fn png(picture: &image::DynamicImage) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        picture.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
        bytes.into_inner()
    }

    #[test]
    fn a_brush_is_its_alpha_or_else_its_darkness() {
        let coverage = |brush: Brush| brush.mip_levels()[0].as_raw().clone();
        let opaque = GrayImage::from_raw(2, 1, vec![0, 200]).unwrap();
        let opaque = brush_from_png("opaque", &png(&opaque.into())).unwrap();
        assert_eq!(coverage(opaque), [255, 55]);
        let alpha = image::GrayAlphaImage::from_raw(2, 1, vec![9, 255, 200, 30]).unwrap();
        let alpha = brush_from_png("alpha", &png(&alpha.into())).unwrap();
        assert_eq!(coverage(alpha), [255, 30]);
    }

    #[test]
    fn what_is_no_brush_says_why() {
        let error = brush_from_png("a.png", b"not a picture").unwrap_err().to_string();
        assert!(error.starts_with("a.png: not a readable PNG"), "{error}");
        let long = GrayImage::new(Brush::MAX_SIDE + 1, 1);
        let error = brush_from_png("long.png", &png(&long.into())).unwrap_err().to_string();
        assert!(error.contains("8193x1"), "{error}");
    }
}
