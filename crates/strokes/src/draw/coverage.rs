//! Ribbons as coverage, and the coverage laid over the picture.
//!
//! Each stroke set has a channel of a texture, where overlaps count once, by the maximum. Up to
//! four consecutive sets share a texture, which is laid over the picture in one pass, each
//! channel in its color.
//!
//! ```text
//!   ribbons of set k --max--> channel k of the coverage --over--> picture
//! ```
//!
//! Rejected: blending segments into the picture one by one. A stroke that crosses itself would
//! be darker there, and joins of segments shorter than wide would overlap or leave gaps.

use bytemuck::{Pod, Zeroable};
use edgemesh_shaders::ShaderError;
use wgpu::{BlendComponent, BlendFactor, BlendOperation, BlendState, ShaderStages};

use crate::draw::stroke_layouts::StrokeLayouts;
use crate::gpu::bind::{bind_buffers, bind_layout, storage_entry, uniform_buffer, uniform_entry};
use crate::gpu::shader::embedded_module;
use crate::gpu::target_formats::{COVERAGE_FORMAT, TargetFormats};

/// Stroke sets that share a texture: one for each channel.
pub(crate) const CHANNELS: usize = 4;

/// The colors of the channels. WGSL twin: `shaders/graph/composite.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct CompositeUniform {
    /// Premultiplied RGBA, in the order in which they are laid.
    pub colors: [[f32; 4]; CHANNELS],
}

/// The render pipelines for one kind of target.
#[derive(Debug)]
pub(crate) struct CoveragePipeline {
    /// `@group(3)` of ribbons.
    ribbons_layout: wgpu::BindGroupLayout,
    /// By channel: solid and textured.
    ribbons: Vec<[wgpu::RenderPipeline; 2]>,
    composite_layout: wgpu::BindGroupLayout,
    /// By the number of channels in use, less one.
    composite: Vec<wgpu::RenderPipeline>,
}

impl CoveragePipeline {
    pub(crate) fn new(
        device: &wgpu::Device,
        layouts: &StrokeLayouts,
        formats: &TargetFormats,
        has_glass: bool,
    ) -> Result<Self, ShaderError> {
        let make = |label: &str, entries: &[wgpu::BindGroupLayoutEntry]| {
            bind_layout(device, label, entries)
        };
        let ribbons_layout = make("ribbons", &[storage_entry(0, ShaderStages::VERTEX, true)]);
        let texture = wgpu::BindGroupLayoutEntry {
            binding: 1,
            visibility: ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Texture {
                sample_type: wgpu::TextureSampleType::Float { filterable: false },
                view_dimension: wgpu::TextureViewDimension::D2,
                multisampled: false,
            },
            count: None,
        };
        let composite_layout =
            make("composite", &[uniform_entry(0, ShaderStages::FRAGMENT), texture]);
        let module = formats.shader_module(device, "graph/ribbon.wgsl")?;
        let mut groups = layouts.groups(None, Some(&ribbons_layout));
        groups[0] = Some(&layouts.frame_fill);
        let ribbons = (0..CHANNELS)
            .map(|channel| {
                [false, true].map(|is_textured| {
                    let overrides = [("IS_TEXTURED", is_textured), ("HAS_GLASS", has_glass)]
                        .map(|(name, value)| (name, f64::from(u8::from(value))));
                    ribbon_pipeline(device, &module, &groups, channel, &overrides)
                })
            })
            .collect();
        let module = embedded_module(device, "graph/composite.wgsl")?;
        let composite = (1..=CHANNELS)
            .map(|count| composite_pipeline(device, &module, &composite_layout, formats, count))
            .collect();
        Ok(Self { ribbons_layout, ribbons, composite_layout, composite })
    }

    /// `@group(3)` of an object's ribbons.
    pub(crate) fn bind(&self, device: &wgpu::Device, ribbons: &wgpu::Buffer) -> wgpu::BindGroup {
        bind_buffers(device, "ribbons", &self.ribbons_layout, &[(0, ribbons)])
    }

    pub(crate) fn set_ribbons(
        &self,
        pass: &mut wgpu::RenderPass,
        channel: usize,
        is_textured: bool,
    ) {
        pass.set_pipeline(&self.ribbons[channel][usize::from(is_textured)]);
    }

    /// Binds a coverage texture with the colors of its channels.
    pub(crate) fn composite_group(
        &self,
        device: &wgpu::Device,
        colors: [[f32; 4]; CHANNELS],
        coverage: &wgpu::TextureView,
    ) -> wgpu::BindGroup {
        let uniform = uniform_buffer(device, "composite", &CompositeUniform { colors });
        let resources = [uniform.as_entire_binding(), wgpu::BindingResource::TextureView(coverage)];
        let entries: Vec<wgpu::BindGroupEntry> = (0..)
            .zip(resources)
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("composite"),
            layout: &self.composite_layout,
            entries: &entries,
        })
    }

    /// Lays the first `count` channels over the picture.
    pub(crate) fn record_composite(
        &self,
        pass: &mut wgpu::RenderPass,
        group: &wgpu::BindGroup,
        count: usize,
    ) {
        pass.set_pipeline(&self.composite[count - 1]);
        pass.set_bind_group(0, group, &[]);
        pass.draw(0..3, 0..1);
    }
}

fn ribbon_pipeline(
    device: &wgpu::Device,
    module: &wgpu::ShaderModule,
    groups: &[Option<&wgpu::BindGroupLayout>],
    channel: usize,
    constants: &[(&str, f64)],
) -> wgpu::RenderPipeline {
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("ribbons"),
        bind_group_layouts: groups,
        immediate_size: 0,
    });
    let maximum = BlendComponent {
        src_factor: BlendFactor::One,
        dst_factor: BlendFactor::One,
        operation: BlendOperation::Max,
    };
    let write_masks = [
        wgpu::ColorWrites::RED,
        wgpu::ColorWrites::GREEN,
        wgpu::ColorWrites::BLUE,
        wgpu::ColorWrites::ALPHA,
    ];
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("ribbons"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("ribbon_vertex"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("ribbon_fragment"),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants,
                ..Default::default()
            },
            targets: &[Some(wgpu::ColorTargetState {
                format: COVERAGE_FORMAT,
                blend: Some(BlendState { color: maximum, alpha: maximum }),
                write_mask: write_masks[channel],
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn composite_pipeline(
    device: &wgpu::Device,
    module: &wgpu::ShaderModule,
    layout: &wgpu::BindGroupLayout,
    formats: &TargetFormats,
    count: usize,
) -> wgpu::RenderPipeline {
    #[expect(clippy::cast_precision_loss, reason = "at most four")]
    let constants = [("CHANNEL_COUNT", count as f64)];
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("composite"),
        bind_group_layouts: &[Some(layout)],
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("composite"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("composite_vertex"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: formats.depth,
            depth_write_enabled: Some(false),
            depth_compare: Some(wgpu::CompareFunction::Always),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState { count: formats.samples, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("composite_fragment"),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &constants,
                ..Default::default()
            },
            targets: &[Some(wgpu::ColorTargetState {
                format: formats.color,
                blend: Some(BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}
