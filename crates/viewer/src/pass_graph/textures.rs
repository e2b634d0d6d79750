//! The textures of a pass graph: those that passes write, and images.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::time::SystemTime;

use image::RgbaImage;
use strokes::{Gpu, upload_levels};

use crate::error::{Error, ImageError};
use crate::technique::image_file::ImageFile;
use crate::technique::plan::TexturePlan;
use crate::technique::texture_format::TextureFormat;

/// The format in wgpu: the only place that converts it.
pub(crate) const fn wgpu_format(format: TextureFormat) -> wgpu::TextureFormat {
    match format {
        TextureFormat::R8 => wgpu::TextureFormat::R8Unorm,
        TextureFormat::Rg8 => wgpu::TextureFormat::Rg8Unorm,
        TextureFormat::Rgba8 => wgpu::TextureFormat::Rgba8Unorm,
        TextureFormat::R16Float => wgpu::TextureFormat::R16Float,
        TextureFormat::Rg16Float => wgpu::TextureFormat::Rg16Float,
        TextureFormat::Rgba16Float => wgpu::TextureFormat::Rgba16Float,
        TextureFormat::R32Float => wgpu::TextureFormat::R32Float,
        TextureFormat::Rg32Float => wgpu::TextureFormat::Rg32Float,
        TextureFormat::Rgba32Float => wgpu::TextureFormat::Rgba32Float,
        TextureFormat::R32Uint => wgpu::TextureFormat::R32Uint,
        TextureFormat::Depth32Float => wgpu::TextureFormat::Depth32Float,
    }
}

/// A texture that passes write.
#[derive(Debug)]
pub(crate) struct GeneratedTexture {
    /// Two if a pass both reads and writes it, else one.
    textures: Vec<wgpu::Texture>,
    views: Vec<wgpu::TextureView>,
    /// The index of the one that is read.
    current: usize,
    name: String,
    /// Whether it has the content of an earlier graph.
    pub(crate) is_kept: bool,
}

impl GeneratedTexture {
    pub(crate) fn new(
        device: &wgpu::Device,
        plan: &TexturePlan,
        picture: [u32; 2],
        is_double: bool,
    ) -> Self {
        let size = plan.size.pixels(picture);
        let count = if is_double { 2 } else { 1 };
        let format = wgpu_format(plan.format);
        let textures: Vec<wgpu::Texture> =
            (0..count).map(|_| target_texture(device, &plan.name, size, format)).collect();
        let views = textures.iter().map(|texture| texture.create_view(&Default::default()));
        let name = plan.name.clone();
        Self { views: views.collect(), textures, current: 0, name, is_kept: false }
    }

    /// Clears it, for a picture of the size `picture`; `plan` is that of [`Self::new`].
    pub(crate) fn renew(&mut self, device: &wgpu::Device, plan: &TexturePlan, picture: [u32; 2]) {
        let size = plan.size.pixels(picture);
        for (texture, view) in self.textures.iter_mut().zip(&mut self.views) {
            // A new texture is cleared to 0.
            *texture = target_texture(device, &plan.name, size, wgpu_format(plan.format));
            *view = texture.create_view(&Default::default());
        }
        (self.current, self.is_kept) = (0, false);
    }

    /// Whether it has the name, size and format of `plan`, and is double or not.
    pub(crate) fn is_for(&self, plan: &TexturePlan, picture: [u32; 2], is_double: bool) -> bool {
        let texture = &self.textures[0];
        self.name == plan.name
            && texture.format() == wgpu_format(plan.format)
            && [texture.width(), texture.height()] == plan.size.pixels(picture)
            && self.textures.len() == if is_double { 2 } else { 1 }
    }

    /// Whether a pass both reads and writes it.
    pub(crate) const fn is_double(&self) -> bool {
        self.textures.len() > 1
    }

    /// The texture that passes read.
    pub(crate) fn read(&self) -> &wgpu::TextureView {
        &self.views[self.current]
    }

    pub(crate) fn read_texture(&self) -> &wgpu::Texture {
        &self.textures[self.current]
    }

    /// The texture that a pass writes: the other one if it works in place.
    pub(crate) fn write(&self, is_in_place: bool) -> &wgpu::TextureView {
        &self.views[self.written(is_in_place)]
    }

    pub(crate) fn write_texture(&self, is_in_place: bool) -> &wgpu::Texture {
        &self.textures[self.written(is_in_place)]
    }

    fn written(&self, is_in_place: bool) -> usize {
        if is_in_place { (self.current + 1) % self.textures.len() } else { self.current }
    }

    /// Lets passes read what was written in place.
    pub(crate) fn swap(&mut self) {
        self.current = (self.current + 1) % self.textures.len();
    }
}

/// A texture to draw to and to read.
pub(crate) fn target_texture(
    device: &wgpu::Device,
    label: &str,
    size: [u32; 2],
    format: wgpu::TextureFormat,
) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_SRC
            | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    })
}

/// Images on the GPU.
#[derive(Debug, Default)]
pub(crate) struct Images {
    /// Each with the time of the last change of its file.
    views: HashMap<ImageFile, (Option<SystemTime>, wgpu::TextureView)>,
    white: Option<wgpu::TextureView>,
}

impl Images {
    /// The texture of an image.
    pub(crate) fn view(&mut self, gpu: &Gpu, file: &ImageFile) -> Result<wgpu::TextureView, Error> {
        Ok(match self.views.entry(file.clone()) {
            Entry::Occupied(known) => known.get().1.clone(),
            Entry::Vacant(new) => {
                let changed = file.changed();
                let failed = |reason| Error::Image { file: file.name(), reason };
                let bytes = file.bytes().map_err(ImageError::Io).map_err(failed)?;
                let picture = decode_image(&bytes).map_err(failed)?;
                let is_atlas = file.directory().is_some_and(|name| name == MIP_ATLASES);
                let levels =
                    if is_atlas { atlas_levels(&picture) } else { averaged_levels(picture) };
                new.insert((changed, upload_levels(gpu, &file.name(), &levels))).1.clone()
            }
        })
    }

    /// Drops images whose files have changed.
    pub(crate) fn forget_changed(&mut self) {
        self.views.retain(|file, (changed, _)| *changed == file.changed());
    }

    /// One white texel, for a variable without a texture.
    pub(crate) fn white(&mut self, gpu: &Gpu) -> wgpu::TextureView {
        let one = RgbaImage::from_pixel(1, 1, image::Rgba([255; 4]));
        self.white.get_or_insert_with(|| upload_levels(gpu, "white", &[one])).clone()
    }
}

/// The directory of images that contain their mip levels, the smaller ones in a column beside
/// the largest. So strokes in them keep their width, which averaging would change.
const MIP_ATLASES: &str = "tonal_art_maps";

/// The longest side of an image in pixels.
pub(crate) const MAX_SIDE: u32 = 8192;

/// Decodes a PNG or JPEG with sides of at most [`MAX_SIDE`] pixels.
pub(crate) fn decode_image(bytes: &[u8]) -> Result<RgbaImage, ImageError> {
    let mut reader = image::ImageReader::new(std::io::Cursor::new(bytes)).with_guessed_format()?;
    let mut limits = image::Limits::default();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    limits.max_alloc = Some(u64::from(MAX_SIDE) * u64::from(MAX_SIDE) * 8);
    reader.limits(limits);
    Ok(reader.decode()?.to_rgba8())
}

/// The levels of a mip atlas: the largest on the left, the others below each other to its
/// right.
fn atlas_levels(atlas: &RgbaImage) -> Vec<RgbaImage> {
    let side = atlas.height();
    if atlas.width() < side + side / 2 {
        return averaged_levels(atlas.clone());
    }
    let part = |x, y, side| image::imageops::crop_imm(atlas, x, y, side, side).to_image();
    let mut levels = vec![part(0, 0, side)];
    let (mut top, mut smaller) = (0, side / 2);
    while smaller > 0 {
        levels.push(part(side, top, smaller));
        top += smaller;
        smaller /= 2;
    }
    levels
}

/// A picture and its mip levels, each averaged from the one before.
pub(crate) fn averaged_levels(picture: RgbaImage) -> Vec<RgbaImage> {
    let mut levels = vec![picture];
    while let Some(last) = levels.last()
        && (last.width() > 1 || last.height() > 1)
    {
        let (width, height) = (last.width(), last.height());
        let smaller = RgbaImage::from_fn((width / 2).max(1), (height / 2).max(1), |x, y| {
            let mut sums = [0_u32; 4];
            for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                let texel =
                    last.get_pixel((2 * x + dx).min(width - 1), (2 * y + dy).min(height - 1));
                sums.iter_mut().zip(texel.0).for_each(|(sum, value)| *sum += u32::from(value));
            }
            // The mean of four bytes is a byte.
            image::Rgba(sums.map(|sum| u8::try_from((sum + 2) / 4).unwrap_or(u8::MAX)))
        });
        levels.push(smaller);
    }
    levels
}

#[cfg(test)]
mod tests {
    use image::Rgba;
    use wgpu::{Features, TextureFormatFeatureFlags as Flags};

    use super::*;
    use crate::technique::program::FieldKind;
    use crate::technique::texture_format::MAX_OUTPUT_BYTES_PER_PIXEL;

    #[test]
    fn formats_are_what_wgpu_says_of_them() {
        for format in TextureFormat::OUTPUTS.into_iter().chain([TextureFormat::DEPTH]) {
            let theirs = wgpu_format(format);
            let word = format.word();
            let flags = theirs.guaranteed_format_features(Features::empty()).flags;
            assert_eq!(format.is_filterable(), flags.contains(Flags::FILTERABLE), "{word}");
            assert_eq!(format.is_blendable(), flags.contains(Flags::BLENDABLE), "{word}");
            assert_eq!(format.channel_count(), u32::from(theirs.components()), "{word}");
            let bytes = Some(format.bytes_per_texel());
            assert_eq!(bytes, theirs.block_copy_size(Some(wgpu::TextureAspect::All)), "{word}");
            if format != TextureFormat::DEPTH {
                let cost = Some(format.output_bytes_per_pixel());
                assert_eq!(cost, theirs.target_pixel_byte_cost(), "{word}");
            }
            let is_uint = theirs.sample_type(None, None) == Some(wgpu::TextureSampleType::Uint);
            assert_eq!(format.number_kind() == FieldKind::Uint, is_uint, "{word}");
        }
    }

    #[test]
    fn limits_and_formats_of_pictures_are_those_of_the_renderer() {
        let limit = wgpu::Limits::default().max_color_attachment_bytes_per_sample;
        assert_eq!(MAX_OUTPUT_BYTES_PER_PIXEL, limit);
        let picture = strokes::TargetFormats::new(1);
        assert_eq!(wgpu_format(TextureFormat::PICTURE), picture.color);
        assert_eq!(wgpu_format(TextureFormat::DEPTH), picture.depth);
    }

    #[test]
    fn levels_are_averages_down_to_one_texel() {
        let picture = RgbaImage::from_fn(4, 2, |x, _| Rgba([if x < 2 { 0 } else { 200 }; 4]));
        let levels = averaged_levels(picture);
        let sizes: Vec<(u32, u32)> = levels.iter().map(RgbaImage::dimensions).collect();
        assert_eq!(sizes, [(4, 2), (2, 1), (1, 1)]);
        assert_eq!(levels[2].get_pixel(0, 0), &Rgba([100; 4]));
    }

    #[test]
    fn levels_of_an_atlas_lie_beside_it() {
        let atlas = RgbaImage::from_fn(6, 4, |x, y| match (x, y) {
            (0..4, _) => Rgba([10; 4]),
            (_, 0..2) => Rgba([20; 4]),
            (4, 2) => Rgba([30; 4]),
            _ => Rgba([255; 4]),
        });
        let levels = atlas_levels(&atlas);
        let found: Vec<(u32, u8)> =
            levels.iter().map(|level| (level.width(), level.get_pixel(0, 0).0[0])).collect();
        assert_eq!(found, [(4, 10), (2, 20), (1, 30)]);
    }
}
