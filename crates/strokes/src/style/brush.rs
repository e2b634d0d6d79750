//! Brush textures: how ink lies along and across a stroke.
//!
//! A brush tiles along the stroke and is clamped across it: its top row is the outer rim, its
//! bottom row the inner one. The brush gives the alpha and the stroke the color. Mip levels are
//! averages of the level above, so that a brush drawn small keeps its amount of ink.

use std::convert::Infallible;

use image::{GrayImage, RgbaImage};
use thiserror::Error;

use crate::gpu::device::Gpu;
use crate::gpu::recent::Recent;
use crate::gpu::texture::upload_levels;

/// Why pixels are no brush.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum BrushError {
    /// A side is 0 or longer than [`Brush::MAX_SIDE`].
    #[error("is {width}x{height} pixels; a brush has 1 to {} a side", Brush::MAX_SIDE)]
    Size {
        /// Width in texels.
        width: u32,
        /// Height in texels.
        height: u32,
    },
    /// The coverage is not one byte per texel.
    #[error("has {found} bytes of coverage for {width}x{height} texels")]
    Length {
        /// Width in texels.
        width: u32,
        /// Height in texels.
        height: u32,
        /// Bytes of coverage.
        found: usize,
    },
}

/// A stroke texture: coverage, one byte per texel.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Brush {
    coverage: GrayImage,
}

impl Brush {
    /// The longest side in texels: what every adapter can hold.
    pub const MAX_SIDE: u32 = 8192;

    /// A brush of `width` times `height` texels; `coverage` is their alpha, row by row from
    /// the outer rim.
    ///
    /// # Errors
    /// [`BrushError`], if a side is 0 or longer than [`Self::MAX_SIDE`], or `coverage` has
    /// another length.
    pub fn new(width: u32, height: u32, coverage: Vec<u8>) -> Result<Self, BrushError> {
        if width.min(height) == 0 || width.max(height) > Self::MAX_SIDE {
            return Err(BrushError::Size { width, height });
        }
        let found = coverage.len();
        let coverage = GrayImage::from_raw(width, height, coverage)
            .filter(|coverage| coverage.as_raw().len() == (width * height) as usize)
            .ok_or(BrushError::Length { width, height, found })?;
        Ok(Self { coverage })
    }

    /// A brush that covers everything.
    pub(crate) fn solid() -> Self {
        Self { coverage: GrayImage::from_pixel(1, 1, image::Luma([255])) }
    }

    /// Width over height.
    #[must_use]
    #[expect(clippy::cast_precision_loss, reason = "texture sizes are small")]
    pub fn aspect(&self) -> f32 {
        self.coverage.width() as f32 / self.coverage.height() as f32
    }

    /// The mip levels, the brush itself first, a single texel last.
    #[must_use]
    pub fn mip_levels(&self) -> Vec<GrayImage> {
        let mut levels = vec![self.coverage.clone()];
        while let Some(last) = levels.last()
            && (last.width() > 1 || last.height() > 1)
        {
            let smaller = halve(last);
            levels.push(smaller);
        }
        levels
    }

    /// Uploads all levels; the texture's alpha is the coverage.
    fn upload(&self, gpu: &Gpu) -> wgpu::TextureView {
        let levels: Vec<RgbaImage> = self.mip_levels().iter().map(four_channels).collect();
        upload_levels(gpu, "brush", &levels)
    }
}

/// The coverage in all four channels.
fn four_channels(level: &GrayImage) -> RgbaImage {
    let (width, height) = level.dimensions();
    RgbaImage::from_fn(width, height, |x, y| image::Rgba([level.get_pixel(x, y).0[0]; 4]))
}

/// Averages two by two texels. A side that is not even loses its last texels, one of a single
/// texel is averaged with itself.
fn halve(level: &GrayImage) -> GrayImage {
    let (width, height) = level.dimensions();
    GrayImage::from_fn((width / 2).max(1), (height / 2).max(1), |x, y| {
        let texel = |dx: u32, dy: u32| {
            let at = ((2 * x + dx).min(width - 1), (2 * y + dy).min(height - 1));
            u32::from(level.get_pixel(at.0, at.1).0[0])
        };
        let sum = texel(0, 0) + texel(1, 0) + texel(0, 1) + texel(1, 1);
        image::Luma([u8::try_from((sum + 2) / 4).unwrap_or(u8::MAX)])
    })
}

/// How many brushes stay on the GPU.
const MOST_KEPT: usize = 16;

/// Brushes on the GPU, each once, with their sampler: tiled along, clamped across, mip-mapped.
#[derive(Debug)]
pub(crate) struct BrushTextures {
    pub(crate) sampler: wgpu::Sampler,
    known: Recent<Brush, wgpu::TextureView>,
}

impl BrushTextures {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("brush"),
            address_mode_u: wgpu::AddressMode::Repeat,
            address_mode_v: wgpu::AddressMode::ClampToEdge,
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            mipmap_filter: wgpu::MipmapFilterMode::Linear,
            ..wgpu::SamplerDescriptor::default()
        });
        Self { sampler, known: Recent::new(MOST_KEPT) }
    }

    /// The texture of a brush, uploaded if it is new.
    pub(crate) fn texture(&mut self, gpu: &Gpu, brush: &Brush) -> wgpu::TextureView {
        let upload = || Ok((brush.clone(), brush.upload(gpu)));
        let texture: Result<_, Infallible> = self.known.get(|known| known == brush, upload);
        let Ok(texture) = texture;
        texture
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mip_levels_keep_the_ink_and_end_at_one_texel() {
        for (width, height) in [(64, 16), (7, 5), (1, 9)] {
            let texel = |at: u32| u8::try_from(at * 37 % 256).unwrap();
            let brush = Brush::new(width, height, (0..width * height).map(texel).collect());
            let levels = brush.unwrap().mip_levels();
            assert_eq!(levels.last().map(GrayImage::dimensions), Some((1, 1)));
            let ink = |level: &GrayImage| {
                level.iter().map(|&alpha| f64::from(alpha)).sum::<f64>() / level.len() as f64
            };
            if width.is_power_of_two() && height.is_power_of_two() {
                for level in &levels {
                    assert!((ink(level) - ink(&levels[0])).abs() < 3.0, "{:?}", level.dimensions());
                }
            }
        }
    }

    #[test]
    fn the_coverage_must_fit_the_size() {
        let brush = Brush::new(2, 1, vec![9, 30]).unwrap();
        assert!((brush.aspect() - 2.0).abs() < f32::EPSILON);
        for found in [1, 3] {
            let error = Brush::new(2, 1, vec![0; found]).unwrap_err();
            assert_eq!(error, BrushError::Length { width: 2, height: 1, found });
        }
        for (width, height) in [(0, 4), (Brush::MAX_SIDE + 1, 1)] {
            let error = Brush::new(width, height, Vec::new()).unwrap_err();
            assert_eq!(error, BrushError::Size { width, height });
        }
    }
}
