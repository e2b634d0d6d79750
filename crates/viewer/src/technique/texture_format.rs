//! Formats and sizes of generated textures, without a graphics API.

use super::program::FieldKind;

/// The format of a generated texture. `pass_graph/textures.rs` converts it to that of
/// wgpu.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TextureFormat {
    /// One channel, 8 bits, 0 to 1.
    R8,
    /// Two channels, 8 bits each, 0 to 1.
    Rg8,
    /// Four channels, 8 bits each, 0 to 1.
    Rgba8,
    /// One channel, a 16-bit float.
    R16Float,
    /// Two channels, 16-bit floats.
    Rg16Float,
    /// Four channels, 16-bit floats.
    Rgba16Float,
    /// One channel, a 32-bit float.
    R32Float,
    /// Two channels, 32-bit floats.
    Rg32Float,
    /// Four channels, 32-bit floats.
    Rgba32Float,
    /// One channel, a 32-bit unsigned integer.
    R32Uint,
    /// Depth, a 32-bit float; reversed: 1 near, 0 far.
    Depth32Float,
}

/// The most bytes that the color outputs of a pass may take together for a pixel:
/// `maxColorAttachmentBytesPerSample`, which every adapter supports (WebGPU, 3.6.2
/// Limits). A test in `pass_graph/textures.rs` compares it with wgpu's default.
pub(crate) const MAX_OUTPUT_BYTES_PER_PIXEL: u32 = 32;

/// A texture between passes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PassTexture {
    /// Its name, without the directory `<generated>`.
    pub name: String,
    /// Its format.
    pub format: TextureFormat,
}

impl TextureFormat {
    /// The formats that the variable `render_target_format` can name.
    pub(crate) const OUTPUTS: [Self; 10] = [
        Self::R8,
        Self::Rg8,
        Self::Rgba8,
        Self::R16Float,
        Self::Rg16Float,
        Self::Rgba16Float,
        Self::R32Float,
        Self::Rg32Float,
        Self::Rgba32Float,
        Self::R32Uint,
    ];

    /// The format of copies of the picture.
    pub(crate) const PICTURE: Self = Self::Rgba8;

    /// The format of depth textures.
    pub(crate) const DEPTH: Self = Self::Depth32Float;

    /// The word that files and messages use.
    #[must_use]
    pub(crate) const fn word(self) -> &'static str {
        match self {
            Self::R8 => "r8",
            Self::Rg8 => "rg8",
            Self::Rgba8 => "rgba8",
            Self::R16Float => "r16f",
            Self::Rg16Float => "rg16f",
            Self::Rgba16Float => "rgba16f",
            Self::R32Float => "r32f",
            Self::Rg32Float => "rg32f",
            Self::Rgba32Float => "rgba32f",
            Self::R32Uint => "r32u",
            Self::Depth32Float => "depth32f",
        }
    }

    /// The output format of a word.
    #[must_use]
    pub(crate) fn of_word(word: &str) -> Option<Self> {
        Self::OUTPUTS.into_iter().find(|format| format.word() == word)
    }

    /// The type of the numbers that a fragment program must return for it.
    #[must_use]
    pub(crate) const fn number_kind(self) -> FieldKind {
        match self {
            Self::R32Uint => FieldKind::Uint,
            _ => FieldKind::Float,
        }
    }

    /// Numbers per texel, 1 to 4.
    #[must_use]
    pub(crate) const fn channel_count(self) -> u32 {
        match self {
            Self::R8 | Self::R16Float | Self::R32Float | Self::R32Uint | Self::Depth32Float => 1,
            Self::Rg8 | Self::Rg16Float | Self::Rg32Float => 2,
            Self::Rgba8 | Self::Rgba16Float | Self::Rgba32Float => 4,
        }
    }

    /// Bytes per texel in memory.
    #[must_use]
    pub(crate) const fn bytes_per_texel(self) -> u32 {
        let bytes_per_channel = match self {
            Self::R8 | Self::Rg8 | Self::Rgba8 => 1,
            Self::R16Float | Self::Rg16Float | Self::Rgba16Float => 2,
            Self::R32Float | Self::Rg32Float | Self::Rgba32Float => 4,
            Self::R32Uint | Self::Depth32Float => 4,
        };
        self.channel_count() * bytes_per_channel
    }

    /// Bytes per pixel that count toward [`MAX_OUTPUT_BYTES_PER_PIXEL`] ("render target
    /// pixel byte cost", WebGPU, 26.1.1): those in memory, but 8 for `rgba8`.
    #[must_use]
    pub(crate) const fn output_bytes_per_pixel(self) -> u32 {
        match self {
            Self::Rgba8 => 8,
            _ => self.bytes_per_texel(),
        }
    }

    /// Whether every adapter can sample the format between texels.
    #[must_use]
    pub(crate) const fn is_filterable(self) -> bool {
        match self {
            Self::R8 | Self::Rg8 | Self::Rgba8 => true,
            Self::R16Float | Self::Rg16Float | Self::Rgba16Float => true,
            Self::R32Float | Self::Rg32Float | Self::Rgba32Float => false,
            Self::R32Uint | Self::Depth32Float => false,
        }
    }

    /// Whether every adapter can blend in the format.
    #[must_use]
    pub(crate) const fn is_blendable(self) -> bool {
        self.is_filterable()
    }
}

/// The size of a generated texture, absolute or relative to the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TextureSize {
    /// Width and height: pixels, or 0 for the picture's, or -n for an n-th of it.
    pub(crate) sides: [i32; 2],
    /// Factor of both.
    pub(crate) scale: f32,
}

impl TextureSize {
    /// The size of the picture.
    pub(crate) const PICTURE: Self = Self { sides: [0; 2], scale: 1.0 };

    /// Width and height in pixels for a picture of `picture` pixels, each at least 1.
    #[must_use]
    pub(crate) fn pixels(&self, picture: [u32; 2]) -> [u32; 2] {
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

/// For listings of a technique, such as `picture/2 x 64`.
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
    fn sizes_are_absolute_or_relative_to_the_picture() {
        let size = |sides, scale| TextureSize { sides, scale }.pixels([640, 480]);
        assert_eq!(size([0, 0], 1.0), [640, 480]);
        assert_eq!(size([-2, -4], 1.0), [320, 120]);
        assert_eq!(size([64, 32], 1.0), [64, 32]);
        assert_eq!(size([0, 0], 2.0), [1280, 960]);
        assert_eq!(size([-2000, 0], 1.0), [1, 480], "at least one pixel");
    }

    #[test]
    fn every_output_format_has_a_word() {
        for format in TextureFormat::OUTPUTS {
            assert_eq!(TextureFormat::of_word(format.word()), Some(format));
        }
        assert_eq!(TextureFormat::of_word("rgb8"), None);
        assert_eq!(TextureFormat::of_word(TextureFormat::DEPTH.word()), None, "no output");
    }
}
