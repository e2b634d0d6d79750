//! The textures that a picture is drawn into.
//!
//! Colours are sRGB values in an 8-bit format without conversion, and blending
//! happens between those values, as in SVG and in drawing programs: half a pixel
//! of black ink on white paper is the middle grey that one expects.

use std::sync::{Mutex, PoisonError};

use glam::Vec2;

use crate::draw::silhouette::NO_OBJECT;
use crate::gpu::target_formats::{COVERAGE_FORMAT, TargetFormats};

/// Colour and depth of one size and sample count.
#[derive(Debug)]
pub struct Targets {
    /// Width and height in pixels.
    pub size: [u32; 2],
    formats: TargetFormats,
    picture: wgpu::Texture,
    picture_view: wgpu::TextureView,
    /// The texture with several samples, where there are several.
    sampled_view: Option<wgpu::TextureView>,
    depth_view: wgpu::TextureView,
    /// The depth alone, to be read.
    depth_texture: wgpu::TextureView,
    /// The stencil alone, to be read, where there is one.
    object_texture: Option<wgpu::TextureView>,
    /// Coverage of linked strokes, as many as a frame has needed so far.
    coverage: Mutex<Vec<wgpu::TextureView>>,
}

impl Targets {
    /// Makes the textures; `size` must not be zero nor beyond the device's limit.
    #[must_use]
    pub fn new(device: &wgpu::Device, size: [u32; 2], formats: TargetFormats) -> Self {
        let samples = formats.samples;
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
        let read = wgpu::TextureUsages::TEXTURE_BINDING;
        let picture =
            texture("picture", formats.color, 1, attachment | read | wgpu::TextureUsages::COPY_SRC);
        let sampled = (samples > 1).then(|| texture("samples", formats.color, samples, attachment));
        let depth = texture("depth", formats.depth, samples, attachment | read);
        let alone = |aspect| {
            let descriptor = wgpu::TextureViewDescriptor { aspect, ..Default::default() };
            depth.create_view(&descriptor)
        };
        Self {
            size,
            formats,
            picture_view: view(&picture),
            sampled_view: sampled.as_ref().map(view),
            depth_view: view(&depth),
            depth_texture: alone(wgpu::TextureAspect::DepthOnly),
            object_texture: formats.has_stencil().then(|| alone(wgpu::TextureAspect::StencilOnly)),
            picture,
            coverage: Mutex::default(),
        }
    }

    /// The first `count` textures for the coverage of linked strokes.
    pub(crate) fn coverage(&self, device: &wgpu::Device, count: usize) -> Vec<wgpu::TextureView> {
        let [width, height] = self.size;
        // Views are pushed whole; a thread that panicked left none half made.
        let mut views = self.coverage.lock().unwrap_or_else(PoisonError::into_inner);
        while views.len() < count {
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some("coverage"),
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: COVERAGE_FORMAT,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                    | wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            });
            views.push(texture.create_view(&wgpu::TextureViewDescriptor::default()));
        }
        views[..count].to_vec()
    }

    /// The formats.
    #[must_use]
    pub const fn formats(&self) -> &TargetFormats {
        &self.formats
    }

    /// The depth, to be read.
    #[must_use]
    pub const fn depth_texture(&self) -> &wgpu::TextureView {
        &self.depth_texture
    }

    /// The values of the objects in the stencil, to be read.
    #[must_use]
    pub const fn object_texture(&self) -> Option<&wgpu::TextureView> {
        self.object_texture.as_ref()
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

    /// The size as pipelines want it.
    #[must_use]
    #[expect(clippy::cast_precision_loss, reason = "texture sizes are small")]
    pub const fn viewport_px(&self) -> Vec2 {
        Vec2::new(self.size[0] as f32, self.size[1] as f32)
    }

    /// The finished picture.
    #[must_use]
    pub const fn picture(&self) -> &wgpu::Texture {
        &self.picture
    }

    /// The colour attachment; resolved into the picture where `is_last`.
    #[must_use]
    pub fn color_attachment(
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

    /// Copies the picture as it is, its samples averaged, to a texture of its size and
    /// format.
    pub fn copy_picture(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        to: &wgpu::TextureView,
        texture: &wgpu::Texture,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites>,
    ) {
        let view = self.sampled_view.as_ref().unwrap_or(&self.picture_view);
        let store = wgpu::StoreOp::Store;
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("copy picture"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: self.sampled_view.is_some().then_some(to),
                ops: wgpu::Operations { load: wgpu::LoadOp::Load, store },
            })],
            timestamp_writes,
            ..Default::default()
        });
        if self.sampled_view.is_none() {
            encoder.copy_texture_to_texture(
                self.picture.as_image_copy(),
                texture.as_image_copy(),
                self.picture.size(),
            );
        }
    }

    /// Depth and stencil, cleared to nothing drawn.
    #[must_use]
    pub fn cleared_depth(&self) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        // Reversed depth: 0 is the far plane.
        self.depth(wgpu::LoadOp::Clear(0.0), wgpu::LoadOp::Clear(NO_OBJECT))
    }

    /// Depth and stencil as they are.
    #[must_use]
    pub fn kept_depth(&self) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        self.depth(wgpu::LoadOp::Load, wgpu::LoadOp::Load)
    }

    /// Depth as it is, and the stencil cleared.
    #[must_use]
    pub fn cleared_stencil(&self) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        self.depth(wgpu::LoadOp::Load, wgpu::LoadOp::Clear(NO_OBJECT))
    }

    /// Depth and stencil as they are, to be tested against, and read meanwhile.
    #[must_use]
    pub const fn read_depth(&self) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        wgpu::RenderPassDepthStencilAttachment {
            view: &self.depth_view,
            depth_ops: None,
            stencil_ops: None,
        }
    }

    fn depth(
        &self,
        load: wgpu::LoadOp<f32>,
        load_stencil: wgpu::LoadOp<u32>,
    ) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        let store = wgpu::StoreOp::Store;
        let stencil_ops = wgpu::Operations { load: load_stencil, store };
        wgpu::RenderPassDepthStencilAttachment {
            view: &self.depth_view,
            depth_ops: Some(wgpu::Operations { load, store }),
            stencil_ops: self.formats.has_stencil().then_some(stencil_ops),
        }
    }
}
