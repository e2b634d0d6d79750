//! Brush textures: how ink lies along and across a stroke.
//!
//! A brush tiles along the stroke and is clamped across it: its top row is the
//! outer rim, its bottom row the inner one. Only its alpha is used, the colour
//! is the stroke's. Mip levels are averages of the level above, so that a brush
//! drawn small keeps its amount of ink.

use std::convert::Infallible;
use std::path::{Path, PathBuf};

use image::GrayImage;
use thiserror::Error;

use crate::gpu::Gpu;
use crate::recent::Recent;

/// The brushes that the project makes itself (`brushes/`).
const OWN: [(&str, &[u8]); 5] = [
    ("pen", include_bytes!("../../../brushes/pen.png")),
    ("charcoal", include_bytes!("../../../brushes/charcoal.png")),
    ("watercolor", include_bytes!("../../../brushes/watercolor.png")),
    ("fur", include_bytes!("../../../brushes/fur.png")),
    ("dash", include_bytes!("../../../brushes/dash.png")),
];

/// The longest side of a brush: what every adapter can hold.
pub const MAX_SIDE: u32 = 8192;

/// A brush cannot be used.
#[derive(Debug, Error)]
pub enum BrushError {
    /// The file cannot be read.
    #[error("{}: cannot be read: {reason}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: std::io::Error,
    },
    /// It is no PNG.
    #[error("{name}: is no PNG that can be read: {reason}")]
    Picture {
        /// The file, or the brush.
        name: String,
        /// Why.
        reason: image::ImageError,
    },
    /// It is too large.
    #[error("{name}: is {width}x{height} pixels; a brush has at most {MAX_SIDE} a side")]
    TooLarge {
        /// The file, or the brush.
        name: String,
        /// Its width.
        width: u32,
        /// Its height.
        height: u32,
    },
}

/// A brush as coverage, one byte a texel.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Brush {
    coverage: GrayImage,
}

impl Brush {
    /// The names of the project's own brushes.
    pub const NAMES: [&'static str; OWN.len()] = {
        let mut names = [""; OWN.len()];
        let mut at = 0;
        while at < OWN.len() {
            names[at] = OWN[at].0;
            at += 1;
        }
        names
    };

    /// A brush that covers everything.
    #[must_use]
    pub fn solid() -> Self {
        Self { coverage: GrayImage::from_pixel(1, 1, image::Luma([255])) }
    }

    /// One of the project's own brushes.
    ///
    /// # Errors
    /// Where the embedded picture cannot be read; a test reads all of them.
    #[must_use]
    pub fn named(name: &str) -> Option<Result<Self, BrushError>> {
        let (name, png) = OWN.iter().find(|(known, _)| *known == name)?;
        Some(Self::from_png(name, png))
    }

    /// A brush from a PNG file.
    ///
    /// # Errors
    /// As [`Self::from_png`], and where the file cannot be read.
    pub fn from_file(path: &Path) -> Result<Self, BrushError> {
        let png = std::fs::read(path)
            .map_err(|reason| BrushError::File { path: path.to_owned(), reason })?;
        Self::from_png(&path.display().to_string(), &png)
    }

    /// A brush from a PNG called `name`: its alpha is the coverage, or in an
    /// opaque picture how dark it is.
    ///
    /// # Errors
    /// Where the picture cannot be read or is too large.
    pub fn from_png(name: &str, png: &[u8]) -> Result<Self, BrushError> {
        let wrong = |reason| BrushError::Picture { name: name.to_owned(), reason };
        let mut reader =
            image::ImageReader::with_format(std::io::Cursor::new(png), image::ImageFormat::Png);
        // Room for the largest brush at 16 bits a channel, and no more.
        let mut limits = image::Limits::default();
        limits.max_alloc = Some(u64::from(MAX_SIDE) * u64::from(MAX_SIDE) * 8);
        reader.limits(limits);
        let picture = reader.decode().map_err(wrong)?.to_luma_alpha8();
        let (width, height) = picture.dimensions();
        if width.max(height) > MAX_SIDE {
            return Err(BrushError::TooLarge { name: name.to_owned(), width, height });
        }
        let is_opaque = picture.pixels().all(|pixel| pixel.0[1] == u8::MAX);
        let coverage = GrayImage::from_fn(width, height, |x, y| {
            let [gray, alpha] = picture.get_pixel(x, y).0;
            image::Luma([if is_opaque { u8::MAX - gray } else { alpha }])
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

    fn own() -> impl Iterator<Item = Brush> {
        Brush::NAMES.into_iter().map(|name| Brush::named(name).unwrap().unwrap())
    }

    #[test]
    fn mip_levels_keep_the_ink_and_end_at_one_texel() {
        for brush in own() {
            let levels = brush.mip_levels();
            assert_eq!(levels.last().map(GrayImage::dimensions), Some((1, 1)));
            let ink = |level: &GrayImage| {
                level.iter().map(|&alpha| f64::from(alpha)).sum::<f64>() / level.len() as f64
            };
            for level in &levels {
                assert!((ink(level) - ink(&levels[0])).abs() < 3.0, "{:?}", level.dimensions());
            }
            assert!(ink(&levels[0]) > 40.0, "a brush has ink");
        }
    }

    fn png(picture: &image::DynamicImage) -> Vec<u8> {
        let mut bytes = std::io::Cursor::new(Vec::new());
        picture.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
        bytes.into_inner()
    }

    #[test]
    fn a_brush_is_its_alpha_or_else_its_darkness() {
        let opaque = GrayImage::from_raw(2, 1, vec![0, 200]).unwrap();
        let opaque = Brush::from_png("opaque", &png(&opaque.into())).unwrap();
        assert_eq!(opaque.coverage.as_raw(), &[255, 55]);
        let alpha = image::GrayAlphaImage::from_raw(2, 1, vec![9, 255, 200, 30]).unwrap();
        let alpha = Brush::from_png("alpha", &png(&alpha.into())).unwrap();
        assert_eq!(alpha.coverage.as_raw(), &[255, 30]);
        assert!((alpha.aspect() - 2.0).abs() < f32::EPSILON);
    }

    #[test]
    fn what_is_no_brush_says_why() {
        let error = Brush::from_png("a.png", b"not a picture").unwrap_err().to_string();
        assert!(error.starts_with("a.png: is no PNG"), "{error}");
        let long = GrayImage::new(MAX_SIDE + 1, 1);
        let error = Brush::from_png("long.png", &png(&long.into())).unwrap_err().to_string();
        assert!(error.contains("8193x1"), "{error}");
        assert!(Brush::from_file(Path::new("no/such.png")).is_err());
        assert!(Brush::named("oil").is_none());
    }
}
