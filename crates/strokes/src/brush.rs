//! Brush textures: how ink lies along and across a stroke.
//!
//! A brush tiles along the stroke and is clamped across it: its top row is the
//! outer rim, its bottom row the inner one. Only its alpha is used, the colour
//! is the stroke's. Mip levels are averages of the level above, so that a brush
//! drawn small keeps its amount of ink.

use image::GrayImage;

/// The pen brush that the project makes itself (`brushes/pen.png`).
const PEN_PNG: &[u8] = include_bytes!("../../../brushes/pen.png");

/// A brush as coverage, one byte a texel.
#[derive(Debug, Clone)]
pub struct Brush {
    coverage: GrayImage,
}

impl Brush {
    /// A brush that covers everything.
    #[must_use]
    pub fn solid() -> Self {
        Self { coverage: GrayImage::from_pixel(1, 1, image::Luma([255])) }
    }

    /// The pen.
    ///
    /// # Errors
    /// Where the embedded picture cannot be read; a test reads it.
    pub fn pen() -> image::ImageResult<Self> {
        Self::from_png(PEN_PNG)
    }

    /// A brush from a PNG; its alpha is the coverage.
    ///
    /// # Errors
    /// Where the picture cannot be read.
    pub fn from_png(png: &[u8]) -> image::ImageResult<Self> {
        let picture = image::load_from_memory_with_format(png, image::ImageFormat::Png)?;
        let picture = picture.to_luma_alpha8();
        let coverage = GrayImage::from_fn(picture.width(), picture.height(), |x, y| {
            image::Luma([picture.get_pixel(x, y).0[1]])
        });
        Ok(Self { coverage })
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

/// The sampler of all brushes: tiled along, clamped across, mip-mapped.
#[must_use]
pub fn brush_sampler(device: &wgpu::Device) -> wgpu::Sampler {
    device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("brush"),
        address_mode_u: wgpu::AddressMode::Repeat,
        address_mode_v: wgpu::AddressMode::ClampToEdge,
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        mipmap_filter: wgpu::MipmapFilterMode::Linear,
        ..wgpu::SamplerDescriptor::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mip_levels_keep_the_ink_and_end_at_one_texel() {
        let pen = Brush::pen().unwrap();
        let levels = pen.mip_levels();
        assert_eq!(levels.last().map(GrayImage::dimensions), Some((1, 1)));
        let ink = |level: &GrayImage| {
            level.iter().map(|&alpha| f64::from(alpha)).sum::<f64>() / level.len() as f64
        };
        for level in &levels {
            assert!((ink(level) - ink(&levels[0])).abs() < 3.0, "{:?}", level.dimensions());
        }
        assert!(ink(&levels[0]) > 40.0, "a pen has ink");
    }
}
