//! Brush textures: how ink lies along and across a stroke.
//!
//! A brush tiles along the stroke and is clamped across it: its top row is the
//! outer rim, its bottom row the inner one. Only its alpha is used, the colour
//! is the stroke's. Mip levels are averages of the level above, so that a brush
//! drawn small keeps its amount of ink.

use std::convert::Infallible;

use image::GrayImage;
use thiserror::Error;

use crate::gpu::device::Gpu;
use crate::gpu::recent::Recent;

/// The longest side of a brush: what every adapter can hold.
pub const MAX_SIDE: u32 = 8192;

/// A brush cannot be made.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum BrushError {
    /// It is too large, or has no texels.
    #[error("is {width}x{height} pixels; a brush has 1 to {MAX_SIDE} a side")]
    Size {
        /// Its width.
        width: u32,
        /// Its height.
        height: u32,
    },
    /// The coverage is not one byte per texel.
    #[error("has {found} bytes of coverage for {width}x{height} texels")]
    Length {
        /// Its width.
        width: u32,
        /// Its height.
        height: u32,
        /// Bytes of coverage.
        found: usize,
    },
}

/// A brush as coverage, one byte a texel.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Brush {
    coverage: GrayImage,
}

impl Brush {
    /// A brush of `width` times `height` texels; `coverage` is their alpha, row by row from
    /// the outer rim.
    ///
    /// # Errors
    /// [`BrushError`], if a side is 0 or larger than [`MAX_SIDE`], or `coverage` has another
    /// length.
    pub fn new(width: u32, height: u32, coverage: Vec<u8>) -> Result<Self, BrushError> {
        if width.min(height) == 0 || width.max(height) > MAX_SIDE {
            return Err(BrushError::Size { width, height });
        }
        let found = coverage.len();
        let coverage = GrayImage::from_raw(width, height, coverage)
            .filter(|coverage| coverage.as_raw().len() == (width * height) as usize)
            .ok_or(BrushError::Length { width, height, found })?;
        Ok(Self { coverage })
    }

    /// A brush that covers everything.
    #[must_use]
    pub fn solid() -> Self {
        Self { coverage: GrayImage::from_pixel(1, 1, image::Luma([255])) }
    }

    /// Length of the brush over its height.
    #[must_use]
    #[expect(clippy::cast_precision_loss, reason = "texture sizes are small")]
    pub fn aspect(&self) -> f32 {
        self.coverage.width() as f32 / self.coverage.height() as f32
    }

    /// The brush and its mip levels, largest first.
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
    #[must_use]
    pub fn upload(&self, device: &wgpu::Device, queue: &wgpu::Queue) -> wgpu::TextureView {
        let levels = self.mip_levels();
        let extent = |level: &GrayImage| wgpu::Extent3d {
            width: level.width(),
            height: level.height(),
            depth_or_array_layers: 1,
        };
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("brush"),
            size: extent(&levels[0]),
            mip_level_count: edgemesh::index::to_u32(levels.len()),
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba8Unorm,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        for (mip_level, level) in (0..).zip(&levels) {
            let texels: Vec<u8> = level.iter().flat_map(|&alpha| [alpha; 4]).collect();
            queue.write_texture(
                wgpu::TexelCopyTextureInfo { mip_level, ..texture.as_image_copy() },
                &texels,
                wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(4 * level.width()),
                    rows_per_image: None,
                },
                extent(level),
            );
        }
        texture.create_view(&wgpu::TextureViewDescriptor::default())
    }
}

/// Averages two by two texels; an odd last row or column is averaged with
/// itself.
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

/// So many brushes are kept.
const MOST_KEPT: usize = 16;

/// Brushes on the GPU, each once, and how they are sampled: tiled along, clamped across,
/// mip-mapped.
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

    /// The texture of a brush.
    pub(crate) fn texture(&mut self, gpu: &Gpu, brush: &Brush) -> wgpu::TextureView {
        let upload = || Ok((brush.clone(), brush.upload(&gpu.device, &gpu.queue)));
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
        for (width, height) in [(0, 4), (MAX_SIDE + 1, 1)] {
            let error = Brush::new(width, height, Vec::new()).unwrap_err();
            assert_eq!(error, BrushError::Size { width, height });
        }
    }
}
