//! Transparent surfaces: over the opaque ones, in any order of faces and objects.
//!
//! Layers are peeled off from the eye on (Everitt 2001, "Interactive Order-Independent
//! Transparency"): the depth of each is drawn first, then its color with the program of the pass.
//! Colors are added up under those of the layers before, and laid over the picture at the end.
//! The depth of the nearest surface stays for strokes, which are fainter behind it.
//!
//! ```text
//!   opaque depth --+--> layer 1: depth, color --> layer 2: depth, color --> ...
//!                                     '--------------'---> sum --> picture
//! ```
//!
//! Rejected: sorting triangles, which fails where they cross or surround each other; weights by
//! depth (McGuire and Bavoil 2013), whose colors are wrong for surfaces that are nearly opaque.

use edgemesh_shaders::ShaderSource;
use strokes::{Gpu, TargetFormats, Targets, ViewState, push_away, shader_module};

use super::builder::Builder;
use super::pipeline::{
    DepthTarget, DepthUse, Geometry, GraphLayouts, PassPipeline, PipelineTarget, Programs,
};
use super::screen_pass::screen_vertex;
use crate::error::Error;

/// The most layers that are drawn; what lies behind them is left out.
const LAYER_COUNT: usize = 8;

const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// The textures of transparent surfaces, of the framebuffer's size and samples.
#[derive(Debug)]
pub(crate) struct GlassTargets {
    /// Of the layer and of the layer before, in turns.
    layers: [wgpu::TextureView; 2],
    /// The sum of the layers, premultiplied.
    sum: wgpu::TextureView,
    /// The nearest surfaces, pushed back as opaque ones are.
    nearest: wgpu::TextureView,
    /// `@group(0)` of a layer, by the layer before.
    groups: [wgpu::BindGroup; 2],
    /// `@group(0)` of the sum.
    sum_group: wgpu::BindGroup,
    sum_pipeline: wgpu::RenderPipeline,
}

/// What draws the transparent surfaces of one pass: a pipeline, perhaps with its parameters.
#[derive(Debug)]
pub(crate) struct Glass<T> {
    /// The depth of the nearest ones.
    pub(crate) nearest: T,
    /// The depth and the color of a layer; `None` for programs that paint no transparent surface.
    pub(crate) layers: Option<[T; 2]>,
}

impl<T> Glass<T> {
    pub(crate) fn map<U>(&self, mut to: impl FnMut(&T) -> U) -> Glass<U> {
        let layers = self.layers.as_ref();
        Glass { nearest: to(&self.nearest), layers: layers.map(|[a, b]| [to(a), to(b)]) }
    }
}

impl GlassTargets {
    /// Textures beside `framebuffer`; `view` is the state of the eye.
    pub(crate) fn new(gpu: &Gpu, framebuffer: &Targets, view: &ViewState) -> Result<Self, Error> {
        let device = &gpu.device;
        let formats = *framebuffer.formats();
        let [width, height] = framebuffer.size;
        let texture = |label, format| {
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: formats.samples,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                    | wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            });
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        };
        let layers = [texture("layer", DEPTH), texture("layer before", DEPTH)];
        let sum = texture("layers", formats.color);
        let nearest = texture("nearest transparent surfaces", DEPTH);
        let layout = layer_layout(device, &formats);
        let [opaque_at, before_at, sum_at] = bindings(&formats);
        let groups = [&layers[1], &layers[0]].map(|before| {
            let entry = |binding, view| wgpu::BindGroupEntry {
                binding,
                resource: wgpu::BindingResource::TextureView(view),
            };
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("layer"),
                layout: &layout,
                entries: &[
                    wgpu::BindGroupEntry {
                        binding: 0,
                        resource: view.frame_buffer().as_entire_binding(),
                    },
                    entry(opaque_at, framebuffer.depth_texture()),
                    entry(before_at, before),
                ],
            })
        });
        let sum_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("layers"),
            entries: &[texture_entry(
                sum_at,
                wgpu::TextureSampleType::Float { filterable: false },
                &formats,
            )],
        });
        let sum_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("layers"),
            layout: &sum_layout,
            entries: &[wgpu::BindGroupEntry {
                binding: sum_at,
                resource: wgpu::BindingResource::TextureView(&sum),
            }],
        });
        let sum_pipeline = sum_pipeline(gpu, &sum_layout, &formats)?;
        Ok(Self { layers, sum, nearest, groups, sum_group, sum_pipeline })
    }

    /// The depth of the nearest transparent surfaces.
    pub(crate) const fn nearest(&self) -> &wgpu::TextureView {
        &self.nearest
    }

    /// Draws the transparent surfaces over `framebuffer`: `record` draws them all with one of the
    /// two pipelines of [`Glass::layers`].
    pub(crate) fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        framebuffer: &Targets,
        view: &ViewState,
        mut record: impl FnMut(&mut wgpu::RenderPass, usize),
    ) {
        // Nothing is before the first layer.
        depth_pass(encoder, &self.layers[1], 1.0);
        for layer in 0..LAYER_COUNT {
            let mut pass = depth_pass(encoder, &self.layers[layer % 2], 0.0);
            pass.set_bind_group(0, &self.groups[layer % 2], &[]);
            record(&mut pass, 0);
            drop(pass);
            let load = match layer {
                0 => wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                _ => wgpu::LoadOp::Load,
            };
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("layer"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &self.sum,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
                })],
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: &self.layers[layer % 2],
                    depth_ops: None,
                    stencil_ops: None,
                }),
                ..Default::default()
            });
            pass.set_bind_group(0, view.frame_group(), &[]);
            record(&mut pass, 1);
        }
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("layers"),
            color_attachments: &[Some(framebuffer.color_attachment(wgpu::LoadOp::Load, false))],
            ..Default::default()
        });
        pass.set_pipeline(&self.sum_pipeline);
        pass.set_bind_group(0, &self.sum_group, &[]);
        pass.draw(0..3, 0..1);
    }

    /// Draws the depth of the nearest transparent surfaces, by `record`.
    pub(crate) fn encode_nearest(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        view: &ViewState,
        record: impl FnOnce(&mut wgpu::RenderPass),
    ) {
        let mut pass = depth_pass(encoder, &self.nearest, 0.0);
        pass.set_bind_group(0, view.frame_group(), &[]);
        record(&mut pass);
    }
}

impl Glass<PassPipeline> {
    pub(crate) fn new(
        builder: &Builder,
        layouts: GraphLayouts,
        programs: Programs,
        target: &PipelineTarget,
    ) -> Result<Self, Error> {
        let Programs { label, vertex, fragment, reads } = programs;
        let (gpu, samples) = (builder.gpu, target.samples);
        let module = module(gpu, "glass_layer.wgsl")?;
        let depth = |layouts, entry, bias| {
            let fragment = (&module, entry);
            let target = DepthTarget { format: DEPTH, samples, bias, clips: target.clips };
            PassPipeline::of_depth(gpu, layouts, (label, vertex, reads), fragment, target)
        };
        let layout = layer_layout(&gpu.device, &builder.formats);
        let layers = if fragment.asks_for_blends {
            let entry = if samples > 1 { "layer_of_samples" } else { "layer_of_pixels" };
            let of_layers = GraphLayouts { frame: &layout, ..layouts };
            let target = PipelineTarget {
                depth: Some(DEPTH),
                blend: Some(UNDER),
                is_pushed: false,
                depth_use: DepthUse::Same,
                ..target.clone()
            };
            Some([
                depth(of_layers, entry, wgpu::DepthBiasState::default())?,
                builder.pipeline(layouts, programs, Geometry::Surfaces, &target)?,
            ])
        } else {
            None
        };
        Ok(Self { nearest: depth(layouts, "nearest", push_away())?, layers })
    }
}

/// A premultiplied color under the sum of the layers before it.
const UNDER: wgpu::BlendState = {
    let under = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::OneMinusDstAlpha,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Add,
    };
    wgpu::BlendState { color: under, alpha: under }
};

/// The bindings of the opaque depth, of the layer before, and of the sum.
const fn bindings(formats: &TargetFormats) -> [u32; 3] {
    if formats.samples > 1 { [2, 4, 2] } else { [1, 3, 1] }
}

fn texture_entry(
    binding: u32,
    sample_type: wgpu::TextureSampleType,
    formats: &TargetFormats,
) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: wgpu::BindingType::Texture {
            sample_type,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: formats.samples > 1,
        },
        count: None,
    }
}

/// `@group(0)` of a layer: the frame, the opaque depth, and the layer before.
fn layer_layout(device: &wgpu::Device, formats: &TargetFormats) -> wgpu::BindGroupLayout {
    let [opaque, before, _] = bindings(formats);
    let depth = wgpu::TextureSampleType::Depth;
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("layer"),
        entries: &[
            wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            },
            texture_entry(opaque, depth, formats),
            texture_entry(before, depth, formats),
        ],
    })
}

fn depth_pass<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    view: &wgpu::TextureView,
    cleared_to: f32,
) -> wgpu::RenderPass<'e> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("transparent surfaces"),
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view,
            depth_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(cleared_to),
                store: wgpu::StoreOp::Store,
            }),
            stencil_ops: None,
        }),
        ..Default::default()
    })
}

fn module(gpu: &Gpu, file: &str) -> Result<wgpu::ShaderModule, Error> {
    let source = ShaderSource::embedded(file);
    let source = source.map_err(|error| Error::Internal(error.to_string()))?;
    Ok(shader_module(&gpu.device, &source, file))
}

fn sum_pipeline(
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    formats: &TargetFormats,
) -> Result<wgpu::RenderPipeline, Error> {
    let device = &gpu.device;
    let vertex = screen_vertex()?;
    let fragment = module(gpu, "glass_sum.wgsl")?;
    let entry = if formats.samples > 1 { "layers_of_each_sample" } else { "layers_of_pixels" };
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("layers"),
        bind_group_layouts: &[Some(layout)],
        immediate_size: 0,
    });
    Ok(device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("layers"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &shader_module(device, &vertex.source, "screen"),
            entry_point: Some(&vertex.function),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState { count: formats.samples, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module: &fragment,
            entry_point: Some(entry),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format: formats.color,
                blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    }))
}
