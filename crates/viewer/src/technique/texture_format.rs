//! Formats and sizes of generated textures.

use super::program::FieldKind;

/// The formats that a render target can have, by the words that files use.
pub const FORMATS: [(&str, wgpu::TextureFormat); 10] = [
    ("r8", wgpu::TextureFormat::R8Unorm),
    ("rg8", wgpu::TextureFormat::Rg8Unorm),
    ("rgba8", wgpu::TextureFormat::Rgba8Unorm),
    ("r16f", wgpu::TextureFormat::R16Float),
    ("rg16f", wgpu::TextureFormat::Rg16Float),
    ("rgba16f", wgpu::TextureFormat::Rgba16Float),
    ("r32f", wgpu::TextureFormat::R32Float),
    ("rg32f", wgpu::TextureFormat::Rg32Float),
    ("rgba32f", wgpu::TextureFormat::Rgba32Float),
    ("r32u", wgpu::TextureFormat::R32Uint),
];

/// The format of depth textures: reversed, 1 near, 0 far.
pub const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// A texture that passes draw for each other.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PassTexture {
    /// Its name, without the directory.
    pub name: String,
    /// Its format.
    pub format: wgpu::TextureFormat,
}

/// The format of a word.
#[must_use]
pub fn format_of(word: &str) -> Option<wgpu::TextureFormat> {
    FORMATS.iter().find(|(known, _)| *known == word).map(|(_, format)| *format)
}

/// The word of a format.
#[must_use]
pub fn word_of(format: wgpu::TextureFormat) -> &'static str {
    FORMATS.iter().find(|(_, known)| *known == format).map_or("depth32f", |(word, _)| *word)
}

/// What numbers a format holds.
#[must_use]
pub const fn kind_of(format: wgpu::TextureFormat) -> FieldKind {
    match format {
        wgpu::TextureFormat::R32Uint => FieldKind::Uint,
        _ => FieldKind::Float,
    }
}

/// Whether textures of a format can be sampled between their texels on every adapter.
#[must_use]
pub const fn is_filterable(format: wgpu::TextureFormat) -> bool {
    !matches!(
        format,
        wgpu::TextureFormat::R32Float
            | wgpu::TextureFormat::Rg32Float
            | wgpu::TextureFormat::Rgba32Float
            | wgpu::TextureFormat::R32Uint
            | wgpu::TextureFormat::Depth32Float
    )
}

/// Whether fixed-function blending works in a format on every adapter.
#[must_use]
pub const fn is_blendable(format: wgpu::TextureFormat) -> bool {
    is_filterable(format)
}

/// The size of a generated texture, absolute or by the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TextureSize {
    /// Width and height: pixels, or 0 for the picture's, or -n for the n-th part of it.
    pub sides: [i32; 2],
    /// Times as large.
    pub scale: f32,
}

impl TextureSize {
    /// The size of the picture.
    pub const PICTURE: Self = Self { sides: [0; 2], scale: 1.0 };

    /// Pixels in a picture of `picture` pixels, at least one.
    #[must_use]
    pub fn pixels(&self, picture: [u32; 2]) -> [u32; 2] {
        std::array::from_fn(|axis| {
            let side = match self.sides[axis] {
                0 => picture[axis],
                part @ ..0 => picture[axis] / part.unsigned_abs(),
                pixels => pixels.unsigned_abs(),
            };
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                clippy::cast_precision_loss,
                reason = "sides are small and not negative"
            )]
            let scaled = (side as f32 * self.scale).round() as u32;
            scaled.max(1)
        })
    }
}

impl std::fmt::Display for TextureSize {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let side = |side: i32| match side {
            0 => "picture".to_owned(),
            part @ ..0 => format!("picture/{}", part.unsigned_abs()),
            pixels => pixels.to_string(),
        };
        match self.sides {
            [0, 0] => formatter.write_str("picture"),
            [width, height] => write!(formatter, "{} x {}", side(width), side(height)),
        }?;
        if (self.scale - 1.0).abs() > f32::EPSILON {
            write!(formatter, " x {}", self.scale)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_absolute_or_parts_of_the_picture() {
        let size = |sides, scale| TextureSize { sides, scale }.pixels([640, 480]);
        assert_eq!(size([0, 0], 1.0), [640, 480]);
        assert_eq!(size([-2, -4], 1.0), [320, 120]);
        assert_eq!(size([64, 32], 1.0), [64, 32]);
        assert_eq!(size([0, 0], 2.0), [1280, 960]);
        assert_eq!(size([-2000, 0], 1.0), [1, 480], "never nothing");
    }

    #[test]
    fn every_format_has_its_word() {
        for (word, format) in FORMATS {
            assert_eq!((format_of(word), word_of(format)), (Some(format), word));
        }
        assert_eq!(format_of("rgb8"), None);
    }
}
