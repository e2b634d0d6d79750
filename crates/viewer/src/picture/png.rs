//! PNG in and out, and the comparison with a reference.

use std::io::Write as _;
use std::path::Path;

use image::{Rgba, RgbaImage};

use crate::error::{Error, ImageError};

/// Two pixels differ if a channel differs by more than this, of 255. Adapters round
/// differently by less; a larger value would hide a gray stroke.
pub(crate) const PIXEL_TOLERANCE: u8 = 16;

/// The default share of pixels that may differ: 0.04 %, which other renderers found between
/// drivers.
pub(crate) const DEFAULT_REFERENCE_THRESHOLD: f64 = 0.0004;

/// Encodes a picture with premultiplied alpha as PNG: with straight alpha if
/// `is_transparent`, else over white.
///
/// # Errors
/// [`Error::Encode`].
pub(crate) fn encode_png(picture: &RgbaImage, is_transparent: bool) -> Result<Vec<u8>, Error> {
    encode_png_with_text(picture, is_transparent, None)
}

/// As [`encode_png`], with an optional text chunk: its keyword and its text.
///
/// # Errors
/// As [`encode_png`].
pub(crate) fn encode_png_with_text(
    picture: &RgbaImage,
    is_transparent: bool,
    text: Option<(&str, &str)>,
) -> Result<Vec<u8>, Error> {
    let failed = |error: png::EncodingError| Error::Encode { what: "PNG", reason: error.into() };
    let color = if is_transparent { png::ColorType::Rgba } else { png::ColorType::Rgb };
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, picture.width(), picture.height());
    encoder.set_color(color);
    encoder.set_depth(png::BitDepth::Eight);
    if let Some((keyword, text)) = text {
        encoder.add_itxt_chunk(keyword.to_owned(), text.to_owned()).map_err(failed)?;
    }
    let mut writer = encoder.write_header().map_err(failed)?;
    let mut stream = writer.stream_writer().map_err(failed)?;
    // Row by row, since memory may not hold a large picture twice.
    let mut row = Vec::new();
    for pixels in picture.rows() {
        row.clear();
        for pixel in pixels {
            match is_transparent {
                true => row.extend_from_slice(&straight(*pixel).0),
                false => row.extend_from_slice(&over_white(*pixel).0[..3]),
            }
        }
        stream.write_all(&row).map_err(|error| failed(error.into()))?;
    }
    stream.finish().map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(bytes)
}

/// The text under a keyword in a PNG; `None` if there is none.
#[must_use]
pub(crate) fn read_png_text(path: &Path, keyword: &str) -> Option<String> {
    let file = std::io::BufReader::new(std::fs::File::open(path).ok()?);
    let reader = png::Decoder::new(file).read_info().ok()?;
    let chunk = reader.info().utf8_text.iter().find(|chunk| chunk.keyword == keyword)?;
    chunk.get_text().ok()
}

/// The colors as files store them: with straight alpha if `is_transparent`, else over white.
#[must_use]
pub(crate) fn as_stored(picture: &RgbaImage, is_transparent: bool) -> RgbaImage {
    let mut pixels = picture.clone();
    for pixel in pixels.pixels_mut() {
        *pixel = if is_transparent { straight(*pixel) } else { over_white(*pixel) };
    }
    pixels
}

/// A premultiplied color over white.
fn over_white(Rgba([r, g, b, a]): Rgba<u8>) -> Rgba<u8> {
    let [r, g, b] = [r, g, b].map(|channel| channel.saturating_add(255 - a));
    Rgba([r, g, b, 255])
}

/// A color with straight alpha.
fn straight(Rgba([r, g, b, a]): Rgba<u8>) -> Rgba<u8> {
    if a == 0 {
        return Rgba([r, g, b, a]);
    }
    let [r, g, b] = [r, g, b].map(|channel| {
        let value = (u32::from(channel) * 255 + u32::from(a) / 2) / u32::from(a);
        u8::try_from(value).unwrap_or(u8::MAX)
    });
    Rgba([r, g, b, a])
}

/// # Errors
/// [`Error::Image`].
pub fn read_png(path: &Path) -> Result<RgbaImage, Error> {
    let failed = |reason| Error::Image { file: path.display().to_string(), reason };
    let bytes = std::fs::read(path).map_err(ImageError::Io).map_err(failed)?;
    let picture = image::load_from_memory_with_format(&bytes, image::ImageFormat::Png);
    Ok(picture.map_err(ImageError::Decode).map_err(failed)?.to_rgba8())
}

/// The difference between two pictures.
#[derive(Debug)]
pub struct Difference {
    /// Number of pixels that differ by more than [`PIXEL_TOLERANCE`].
    pub(crate) wrong_pixels: usize,
    /// The share of these pixels, 0 to 1.
    pub share: f64,
    /// The absolute difference of each channel, opaque.
    pub picture: RgbaImage,
}

/// Compares two pictures; `None` if their sizes differ.
#[must_use]
#[expect(clippy::cast_precision_loss, reason = "a share needs no more digits")]
pub fn compare(picture: &RgbaImage, reference: &RgbaImage) -> Option<Difference> {
    if picture.dimensions() != reference.dimensions() {
        return None;
    }
    let mut wrong_pixels = 0;
    let difference = RgbaImage::from_fn(picture.width(), picture.height(), |x, y| {
        let (Rgba(ours), Rgba(theirs)) = (picture.get_pixel(x, y), reference.get_pixel(x, y));
        let [r, g, b, a] = [0, 1, 2, 3].map(|channel| ours[channel].abs_diff(theirs[channel]));
        wrong_pixels += usize::from([r, g, b, a].iter().any(|&step| step > PIXEL_TOLERANCE));
        // A difference of alpha alone must be visible.
        Rgba([r.max(a), g.max(a), b.max(a), 255])
    });
    let share = wrong_pixels as f64 / f64::from(picture.width()) / f64::from(picture.height());
    Some(Difference { wrong_pixels, share, picture: difference })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stroke_that_is_gone_counts_and_rounding_does_not() {
        let paper = RgbaImage::from_pixel(8, 8, Rgba([255; 4]));
        let mut rounded = paper.clone();
        rounded.put_pixel(1, 1, Rgba([250, 255, 255, 255]));
        assert_eq!(compare(&paper, &rounded).unwrap().wrong_pixels, 0);
        let mut stroke = paper.clone();
        for x in 0..8 {
            stroke.put_pixel(x, 4, Rgba([0, 0, 0, 255]));
        }
        let difference = compare(&paper, &stroke).unwrap();
        assert_eq!(difference.wrong_pixels, 8);
        assert!((difference.share - 0.125).abs() < 1e-9);
        assert_eq!(difference.picture.get_pixel(3, 4), &Rgba([255; 4]));
        assert!(compare(&paper, &RgbaImage::new(4, 8)).is_none());
    }

    #[test]
    fn transparency_is_stored_straight() {
        let gray = RgbaImage::from_pixel(1, 1, Rgba([64, 64, 64, 128]));
        let png = encode_png(&gray, true).unwrap();
        let back = image::load_from_memory(&png).unwrap().to_rgba8();
        assert_eq!(back.get_pixel(0, 0), &Rgba([128, 128, 128, 128]));
        let png = encode_png(&gray, false).unwrap();
        let back = image::load_from_memory(&png).unwrap().to_rgba8();
        assert_eq!(back.get_pixel(0, 0), &Rgba([191, 191, 191, 255]), "over white");
    }
}
