//! The textures that a picture is drawn into.
//!
//! Colors are sRGB values in an 8-bit format without conversion, and are blended as such, as in
//! SVG and in drawing programs: half a pixel of black ink on white paper is middle gray.

use std::sync::{Mutex, PoisonError};

use glam::Vec2;
use thiserror::Error;

use crate::draw::silhouette::NO_OBJECT;
use crate::gpu::bind::uniform_entry;
use crate::gpu::target_formats::{COVERAGE_FORMAT, TargetFormats};
use crate::view::frame::FrameBinding;

/// The textures that a picture is drawn into: color and depth of one size and sample count.
#[derive(Debug)]
pub struct Targets {
    /// Width and height in pixels.
    pub size: [u32; 2],
    formats: TargetFormats,
    picture: wgpu::Texture,
    picture_view: wgpu::TextureView,
    /// If pixels have several samples.
    sampled_view: Option<wgpu::TextureView>,
    depth_view: wgpu::TextureView,
    /// The depth aspect alone.
    depth_texture: wgpu::TextureView,
    /// The stencil aspect alone, if there is one.
    object_texture: Option<wgpu::TextureView>,
    /// Coverage of linked strokes: as many textures as any frame needed.
    coverage: Mutex<Vec<wgpu::TextureView>>,
}

/// A program's own textures, to draw strokes into.
#[derive(Debug, Clone)]
pub struct TargetTextures {
    /// The picture, of one sample per pixel.
    pub color: wgpu::Texture,
    /// Four samples per pixel in the format of `color`, if the program draws with several; they
    /// are averaged to `color`.
    pub samples: Option<wgpu::Texture>,
    /// Depth, with or without a stencil, of as many samples. Shaders read it as a texture.
    pub depth: wgpu::Texture,
}

/// Why textures do not fit together.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum TargetError {
    /// A texture has another size than the color.
    #[error("the texture '{name}' has another size than the color")]
    Size {
        /// The field of [`TargetTextures`].
        name: &'static str,
    },
    /// A texture has the wrong number of samples.
    #[error("the texture '{name}' has another number of samples than the others")]
    Samples {
        /// The field of [`TargetTextures`].
        name: &'static str,
    },
    /// The samples have another format than the color.
    #[error("the texture '{name}' has another format than the color")]
    Format {
        /// The field of [`TargetTextures`].
        name: &'static str,
    },
    /// A texture lacks a usage.
    #[error("the texture '{name}' needs the usage {usage:?}")]
    Usage {
        /// The field of [`TargetTextures`].
        name: &'static str,
        /// The usages that it needs.
        usage: wgpu::TextureUsages,
    },
    /// The depth texture has no depth.
    #[error("the format {format:?} has no depth")]
    NoDepth {
        /// Its format.
        format: wgpu::TextureFormat,
    },
}

impl Targets {
    /// Makes textures of `size`, width and height in pixels.
    ///
    /// wgpu reports an error, which [`Gpu::make`](crate::Gpu::make) catches, if a side is 0 or
    /// beyond the device's limit, or there is no memory.
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
        let attachment = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let read = wgpu::TextureUsages::TEXTURE_BINDING;
        let picture =
            texture("picture", formats.color, 1, attachment | read | wgpu::TextureUsages::COPY_SRC);
        let sampled = (samples > 1).then(|| texture("samples", formats.color, samples, attachment));
        let depth = texture("depth", formats.depth, samples, attachment | read);
        Self::of(size, formats, picture, sampled.as_ref(), &depth)
    }

    /// Takes a program's own textures.
    ///
    /// With [`Fill::Done`](crate::Fill::Done) strokes are drawn over what the program drew.
    /// Its depth must be reversed, 1 near and 0 far, and its surfaces drawn with
    /// [`push_away`](crate::push_away).
    ///
    /// # Errors
    /// [`TargetError`], if the textures do not fit together or lack a usage.
    pub fn from_textures(textures: TargetTextures) -> Result<Self, TargetError> {
        let TargetTextures { color, samples, depth } = textures;
        let size = [color.width(), color.height()];
        let sample_count = samples.as_ref().map_or(1, wgpu::Texture::sample_count);
        let formats =
            TargetFormats { color: color.format(), depth: depth.format(), samples: sample_count };
        let attachment = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let needs = [
            ("color", Some(&color), 1, attachment),
            ("samples", samples.as_ref(), sample_count, attachment),
            (
                "depth",
                Some(&depth),
                sample_count,
                attachment | wgpu::TextureUsages::TEXTURE_BINDING,
            ),
        ];
        for (name, texture, samples, usage) in needs {
            let Some(texture) = texture else { continue };
            if [texture.width(), texture.height()] != size {
                return Err(TargetError::Size { name });
            }
            if texture.sample_count() != samples {
                return Err(TargetError::Samples { name });
            }
            if !texture.usage().contains(usage) {
                return Err(TargetError::Usage { name, usage });
            }
        }
        if samples.as_ref().is_some_and(|samples| samples.format() != color.format()) {
            return Err(TargetError::Format { name: "samples" });
        }
        if !depth.format().has_depth_aspect() {
            return Err(TargetError::NoDepth { format: depth.format() });
        }
        Ok(Self::of(size, formats, color, samples.as_ref(), &depth))
    }

    fn of(
        size: [u32; 2],
        formats: TargetFormats,
        picture: wgpu::Texture,
        samples: Option<&wgpu::Texture>,
        depth: &wgpu::Texture,
    ) -> Self {
        let view =
            |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let alone = |aspect| {
            let descriptor = wgpu::TextureViewDescriptor { aspect, ..Default::default() };
            depth.create_view(&descriptor)
        };
        Self {
            size,
            formats,
            picture_view: view(&picture),
            sampled_view: samples.map(view),
            depth_view: view(depth),
            depth_texture: alone(wgpu::TextureAspect::DepthOnly),
            object_texture: formats.has_stencil().then(|| alone(wgpu::TextureAspect::StencilOnly)),
            picture,
            coverage: Mutex::default(),
        }
    }

    /// Binds the frame with the depth and stencil of these targets, by [`frame_fill_layout`], and
    /// with the depth of transparent surfaces. Without these, the fill stands for them: no visible
    /// stroke is behind it.
    pub(crate) fn bind_with_frame(
        &self,
        device: &wgpu::Device,
        layout: &wgpu::BindGroupLayout,
        frame: &FrameBinding,
        glass_depth: Option<&wgpu::TextureView>,
    ) -> wgpu::BindGroup {
        let [depth, objects, glass] = fill_bindings(self.formats.samples);
        let glass_depth = glass_depth.unwrap_or(&self.depth_texture);
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        let mut entries = vec![
            entry(0, frame.buffer().as_entire_binding()),
            entry(depth, wgpu::BindingResource::TextureView(&self.depth_texture)),
            entry(glass, wgpu::BindingResource::TextureView(glass_depth)),
        ];
        let stencil = self.object_texture.as_ref();
        entries.extend(
            stencil.map(|texture| entry(objects, wgpu::BindingResource::TextureView(texture))),
        );
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("frame and fill"),
            layout,
            entries: &entries,
        })
    }

    /// The first `count` textures for the coverage of linked strokes.
    pub(crate) fn coverage(&self, device: &wgpu::Device, count: usize) -> Vec<wgpu::TextureView> {
        let [width, height] = self.size;
        // Views are pushed whole: a thread that panicked left the list valid.
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

    /// Formats and sample count.
    #[must_use]
    pub const fn formats(&self) -> &TargetFormats {
        &self.formats
    }

    /// The depth, for shaders to read.
    #[must_use]
    pub const fn depth_texture(&self) -> &wgpu::TextureView {
        &self.depth_texture
    }

    /// Bytes of textures of this size, for messages.
    #[must_use]
    pub const fn byte_count(size: [u32; 2], samples: u32) -> u64 {
        let pixels = size[0] as u64 * size[1] as u64;
        // The picture, and color and depth for each sample; a single sample is drawn into the
        // picture itself.
        let color_samples = if samples > 1 { samples as u64 } else { 0 };
        pixels * 4 * (1 + color_samples + samples as u64)
    }

    /// Width and height in pixels.
    #[must_use]
    #[expect(clippy::cast_precision_loss, reason = "texture sizes are small")]
    pub const fn viewport_px(&self) -> Vec2 {
        Vec2::new(self.size[0] as f32, self.size[1] as f32)
    }

    /// The picture, of one sample per pixel.
    #[must_use]
    pub const fn picture(&self) -> &wgpu::Texture {
        &self.picture
    }

    /// The color attachment; with `is_last` its samples are averaged to the picture and
    /// dropped.
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
                // Resolved samples are not needed any more.
                store: if resolves { wgpu::StoreOp::Discard } else { wgpu::StoreOp::Store },
            },
        }
    }

    /// Copies the picture, its samples averaged, to `texture` with the view `to`; the texture
    /// must have the picture's size and format.
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

    /// The depth attachment, cleared to the far plane and to no object.
    #[must_use]
    pub fn cleared_depth(&self) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        // Reversed depth: 0 is the far plane.
        self.depth(wgpu::LoadOp::Clear(0.0), wgpu::LoadOp::Clear(NO_OBJECT))
    }

    /// The depth attachment as it is.
    #[must_use]
    pub fn kept_depth(&self) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        self.depth(wgpu::LoadOp::Load, wgpu::LoadOp::Load)
    }

    /// The depth attachment with the depth as it is and the stencil cleared.
    pub(crate) fn cleared_stencil(&self) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        self.depth(wgpu::LoadOp::Load, wgpu::LoadOp::Clear(NO_OBJECT))
    }

    /// The depth attachment read only, so that shaders can read it meanwhile.
    pub(crate) const fn read_depth(&self) -> wgpu::RenderPassDepthStencilAttachment<'_> {
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

/// `@group(0)` of strokes that read the fill: the frame, the depth as a texture of one sample
/// per pixel (binding 1) or of several (2), the stencil of targets that have one in the same way
/// (3 or 4), and the depth of transparent surfaces (5 or 6).
pub(crate) fn frame_fill_layout(
    device: &wgpu::Device,
    formats: &TargetFormats,
) -> wgpu::BindGroupLayout {
    let visibility = wgpu::ShaderStages::VERTEX_FRAGMENT | wgpu::ShaderStages::COMPUTE;
    let texture = |binding, sample_type| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT | wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Texture {
            sample_type,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: formats.samples > 1,
        },
        count: None,
    };
    let [depth, objects, glass] = fill_bindings(formats.samples);
    let mut entries = vec![
        uniform_entry(0, visibility),
        texture(depth, wgpu::TextureSampleType::Depth),
        texture(glass, wgpu::TextureSampleType::Depth),
    ];
    if formats.has_stencil() {
        entries.push(texture(objects, wgpu::TextureSampleType::Uint));
    }
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("frame and fill"),
        entries: &entries,
    })
}

/// The bindings of depth, stencil, and depth of transparent surfaces.
const fn fill_bindings(samples: u32) -> [u32; 3] {
    if samples > 1 { [2, 4, 6] } else { [1, 3, 5] }
}
