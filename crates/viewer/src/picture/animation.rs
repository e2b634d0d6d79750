//! Animated pictures: GIF, which every program shows, and animated PNG, which keeps all
//! colors.
//!
//! Frames are encoded as they are drawn; only the encoded bytes stay in memory.

use std::path::Path;
use std::time::Duration;

use image::codecs::gif::{GifEncoder, Repeat};
use image::{Delay, Frame, RgbaImage};

use crate::error::Error;

/// Duration of a frame, for 25 frames per second.
const FRAME_MS: u16 = 40;

/// Speed of the GIF encoder, 1 (best colors) to 30; line drawings have few colors, so the
/// library's default is enough.
const GIF_SPEED: i32 = 10;

/// File format of an animation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum AnimationKind {
    /// `.gif`
    Gif,
    /// `.apng`
    Apng,
}

impl AnimationKind {
    /// The format by the ending of `path`; `None` for any other ending.
    #[must_use]
    pub(crate) fn of(path: &Path) -> Option<Self> {
        let ending = path.extension()?;
        if ending.eq_ignore_ascii_case("gif") {
            Some(Self::Gif)
        } else if ending.eq_ignore_ascii_case("apng") {
            Some(Self::Apng)
        } else {
            None
        }
    }
}

/// Encodes `count` frames of `size` as an endless animation. `draw` returns each frame with
/// straight alpha.
///
/// # Errors
/// The first error of `draw`, or [`Error::Encode`].
pub(crate) fn encode_animation(
    kind: AnimationKind,
    count: u32,
    size: [u32; 2],
    draw: impl FnMut(u32) -> Result<RgbaImage, Error>,
) -> Result<Vec<u8>, Error> {
    match kind {
        AnimationKind::Gif => encode_gif(count, draw),
        AnimationKind::Apng => encode_apng(count, size, draw),
    }
}

fn encode_gif(
    count: u32,
    mut draw: impl FnMut(u32) -> Result<RgbaImage, Error>,
) -> Result<Vec<u8>, Error> {
    let mut bytes = Vec::new();
    {
        let mut encoder = GifEncoder::new_with_speed(&mut bytes, GIF_SPEED);
        encoder.set_repeat(Repeat::Infinite).map_err(failed)?;
        let delay = Delay::from_saturating_duration(Duration::from_millis(FRAME_MS.into()));
        for index in 0..count {
            let frame = Frame::from_parts(draw(index)?, 0, 0, delay);
            encoder.encode_frame(frame).map_err(failed)?;
        }
    }
    Ok(bytes)
}

fn encode_apng(
    count: u32,
    [width, height]: [u32; 2],
    mut draw: impl FnMut(u32) -> Result<RgbaImage, Error>,
) -> Result<Vec<u8>, Error> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    // 0 means forever.
    encoder.set_animated(count, 0).map_err(failed)?;
    encoder.set_frame_delay(FRAME_MS, 1000).map_err(failed)?;
    let mut writer = encoder.write_header().map_err(failed)?;
    for index in 0..count {
        writer.write_image_data(&draw(index)?).map_err(failed)?;
    }
    writer.finish().map_err(failed)?;
    Ok(bytes)
}

fn failed(error: impl std::error::Error + Send + Sync + 'static) -> Error {
    Error::Encode { what: "animation", reason: error.into() }
}

#[cfg(test)]
mod tests {
    use image::{AnimationDecoder as _, Rgba};

    use super::*;

    fn encoded(kind: AnimationKind) -> Vec<u8> {
        encode_animation(kind, 3, [4, 2], |index| {
            let gray = u8::try_from(index * 100).unwrap();
            Ok(RgbaImage::from_pixel(4, 2, Rgba([gray, gray, gray, 255])))
        })
        .unwrap()
    }

    #[test]
    fn gif_frames_come_back() {
        let bytes = encoded(AnimationKind::Gif);
        let decoder = image::codecs::gif::GifDecoder::new(std::io::Cursor::new(bytes)).unwrap();
        let frames = decoder.into_frames().collect_frames().unwrap();
        assert_eq!(frames.len(), 3);
        assert_eq!(frames[2].buffer().get_pixel(3, 1), &Rgba([200, 200, 200, 255]));
    }

    #[test]
    fn apng_frames_come_back() {
        let bytes = encoded(AnimationKind::Apng);
        let decoder = image::codecs::png::PngDecoder::new(std::io::Cursor::new(bytes)).unwrap();
        let frames = decoder.apng().unwrap().into_frames().collect_frames().unwrap();
        assert_eq!(frames.len(), 3);
        assert_eq!(frames[1].buffer().get_pixel(0, 0), &Rgba([100, 100, 100, 255]));
    }

    #[test]
    fn a_frame_that_fails_ends_the_animation() {
        let result = encode_animation(AnimationKind::Gif, 2, [1, 1], |_| Err(Error::Canceled));
        assert!(matches!(result, Err(Error::Canceled)), "{result:?}");
    }

    #[test]
    fn kinds_follow_the_ending() {
        assert_eq!(AnimationKind::of(Path::new("a.GIF")), Some(AnimationKind::Gif));
        assert_eq!(AnimationKind::of(Path::new("a.apng")), Some(AnimationKind::Apng));
        assert_eq!(AnimationKind::of(Path::new("a.png")), None);
    }
}
