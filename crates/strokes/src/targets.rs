//! The textures that a picture is drawn into.
//!
//! Colours are sRGB values in an 8-bit format without conversion, and blending
//! happens between those values, as in SVG and in drawing programs: half a pixel
//! of black ink on white paper is the middle grey that one expects.

/// The format of the picture.
pub const COLOR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// The format of depth: reversed, 1 near, 0 far.
pub const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Colour and depth of one size and sample count.
#[derive(Debug)]
pub struct Targets {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples a pixel, 1 or 4.
    pub samples: u32,
    picture: wgpu::Texture,
    picture_view: wgpu::TextureView,
    /// The texture with several samples, where there are several.
    sampled_view: Option<wgpu::TextureView>,
    depth_view: wgpu::TextureView,
}

impl Targets {
    /// Makes the textures; `size` must not be zero nor beyond the device's limit.
    #[must_use]
    pub fn new(device: &wgpu::Device, size: [u32; 2], samples: u32) -> Self {
        let texture = |label, format, sample_count, usage| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats: &[],
            })
        };
        let view =
            |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let attachment = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let picture =
            texture("picture", COLOR_FORMAT, 1, attachment | wgpu::TextureUsages::COPY_SRC);
        let sampled = (samples > 1).then(|| texture("samples", COLOR_FORMAT, samples, attachment));
        let depth = texture("depth", DEPTH_FORMAT, samples, attachment);
        Self {
            size,
            samples,
            picture_view: view(&picture),
            sampled_view: sampled.as_ref().map(view),
            depth_view: view(&depth),
            picture,
        }
    }

    /// Bytes that textures of this size take, for messages.
    #[must_use]
    pub const fn byte_count(size: [u32; 2], samples: u32) -> u64 {
        let pixels = size[0] as u64 * size[1] as u64;
        // The picture, and colour and depth for each sample; one sample is
        // drawn into the picture itself.
        let color_samples = if samples > 1 { samples as u64 } else { 0 };
        pixels * 4 * (1 + color_samples + samples as u64)
    }

    /// The finished picture.
    #[must_use]
    pub const fn picture(&self) -> &wgpu::Texture {
        &self.picture
    }

    /// The colour attachment; resolved into the picture where `is_last`.
    pub(crate) fn color_attachment(
        &self,
        load: wgpu::LoadOp<wgpu::Color>,
        is_last: bool,
    ) -> wgpu::RenderPassColorAttachment<'_> {
        let resolves = is_last && self.sampled_view.is_some();
        wgpu::RenderPassColorAttachment {
            view: self.sampled_view.as_ref().unwrap_or(&self.picture_view),
            depth_slice: None,
            resolve_target: resolves.then_some(&self.picture_view),
            ops: wgpu::Operations {
                load,
                // What was resolved is not needed sample by sample any more.
                store: if resolves { wgpu::StoreOp::Discard } else { wgpu::StoreOp::Store },
            },
        }
    }

    /// The depth attachment.
    pub(crate) fn depth_attachment(
        &self,
        load: wgpu::LoadOp<f32>,
        store: wgpu::StoreOp,
    ) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        wgpu::RenderPassDepthStencilAttachment {
            view: &self.depth_view,
            depth_ops: Some(wgpu::Operations { load, store }),
            stencil_ops: None,
        }
    }
}
