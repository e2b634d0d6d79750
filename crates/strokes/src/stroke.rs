//! Strokes: thick quads with caps along the live edges (paper, section 3.3).
//!
//! One instance an edge, 12 vertices each, all pulled from storage buffers by
//! index; the vertex shader places them in pixels after its own clip and divide.
//! The draw is indirect: how many edges are live is known to the GPU alone.
//!
//! Rejected: the paper's three passes over one index array (quads, start caps,
//! finish caps), which repeat the projection three times; instancing of
//! four-vertex quads from replicated records, which ran slowest of all.
//!
//! ```text
//!        8                         11
//!      . |  5 ----------------- 4  | .
//!    7---6  .                   .  9--10
//!           0 ----------------- 1
//! ```

use bytemuck::{Pod, Zeroable};
use wgpu::ShaderStages;

use crate::brush::{Brush, brush_sampler};
use crate::detect::bind_buffers;
use crate::frame::{storage_entry, uniform_buffer, uniform_entry};
use crate::gpu::Gpu;
use crate::mesh_buffers::MeshBuffers;
use crate::shader::{ShaderError, ShaderSource};
use crate::targets::{COLOR_FORMAT, DEPTH_FORMAT};

/// What all strokes of a draw share. WGSL twin: `shaders/stroke.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct StrokeUniform {
    /// Premultiplied colour.
    pub color: [f32; 4],
    /// Width in pixels.
    pub width_px: f32,
    /// Length of the brush over its height.
    pub brush_aspect: f32,
    /// Unused.
    pub padding: [f32; 2],
}

/// How strokes look.
#[derive(Debug, Clone)]
pub struct StrokeStyle {
    /// Premultiplied colour.
    pub color: [f32; 4],
    /// Width in pixels.
    pub width_px: f32,
    /// The brush, or `None` for solid ink.
    pub brush: Option<Brush>,
}

/// The pipeline with its style.
#[derive(Debug)]
pub struct StrokePipeline {
    pipeline: wgpu::RenderPipeline,
    draw_layout: wgpu::BindGroupLayout,
    pass_group: wgpu::BindGroup,
}

/// What strokes need of one mesh.
#[derive(Debug)]
pub struct StrokeDraw {
    draw_group: wgpu::BindGroup,
}

impl StrokePipeline {
    /// Builds the pipeline for `style`.
    ///
    /// # Errors
    /// Where the shader cannot be put together.
    pub fn new(
        gpu: &Gpu,
        frame_layout: &wgpu::BindGroupLayout,
        samples: u32,
        style: &StrokeStyle,
    ) -> Result<Self, ShaderError> {
        let device = &gpu.device;
        let pass_layout = pass_layout(device);
        let vertex = ShaderStages::VERTEX;
        let draw_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("stroke draw"),
            entries: &[0, 1, 2, 3, 4, 5].map(|binding| storage_entry(binding, vertex, true)),
        });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("stroke"),
            bind_group_layouts: &[Some(frame_layout), Some(&pass_layout), Some(&draw_layout)],
            immediate_size: 0,
        });
        let module = ShaderSource::embedded("stroke.wgsl")?.module(device, "stroke");
        let pipeline = stroke_pipeline(device, &layout, &module, samples, style.brush.is_some());
        Ok(Self { pipeline, draw_layout, pass_group: pass_group(gpu, &pass_layout, style) })
    }

    /// Prepares one mesh.
    #[must_use]
    pub fn draw(&self, device: &wgpu::Device, mesh: &MeshBuffers) -> StrokeDraw {
        let buffers = [
            &mesh.positions,
            &mesh.normals,
            &mesh.records,
            &mesh.live,
            &mesh.triangles,
            &mesh.planes,
        ];
        StrokeDraw { draw_group: bind_buffers(device, "stroke", &self.draw_layout, &buffers) }
    }

    /// Sets the pipeline and its style.
    pub fn bind(&self, pass: &mut wgpu::RenderPass) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(1, &self.pass_group, &[]);
    }

    /// Draws the live edges of one mesh; after [`Self::bind`], `@group(0)` must
    /// be the frame.
    pub fn record(&self, pass: &mut wgpu::RenderPass, mesh: &MeshBuffers, draw: &StrokeDraw) {
        pass.set_bind_group(2, &draw.draw_group, &[]);
        pass.draw_indirect(&mesh.tally, 0);
    }
}

fn pass_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: ShaderStages::FRAGMENT,
        ty,
        count: None,
    };
    let texture = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: true },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("stroke pass"),
        entries: &[
            uniform_entry(0, ShaderStages::VERTEX_FRAGMENT),
            entry(1, texture),
            entry(2, sampler),
        ],
    })
}

fn pass_group(gpu: &Gpu, layout: &wgpu::BindGroupLayout, style: &StrokeStyle) -> wgpu::BindGroup {
    let solid = Brush::solid();
    let brush = style.brush.as_ref().unwrap_or(&solid);
    let uniform = StrokeUniform {
        color: style.color,
        width_px: style.width_px,
        brush_aspect: brush.aspect(),
        padding: [0.0; 2],
    };
    let uniform = uniform_buffer(&gpu.device, "stroke", &uniform);
    let texture = brush.upload(&gpu.device, &gpu.queue);
    let sampler = brush_sampler(&gpu.device);
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("stroke pass"),
        layout,
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() },
            wgpu::BindGroupEntry {
                binding: 1,
                resource: wgpu::BindingResource::TextureView(&texture),
            },
            wgpu::BindGroupEntry { binding: 2, resource: wgpu::BindingResource::Sampler(&sampler) },
        ],
    })
}

fn stroke_pipeline(
    device: &wgpu::Device,
    layout: &wgpu::PipelineLayout,
    module: &wgpu::ShaderModule,
    samples: u32,
    is_textured: bool,
) -> wgpu::RenderPipeline {
    let constants = [("IS_TEXTURED", f64::from(u8::from(is_textured)))];
    let compilation_options =
        wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("stroke"),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("stroke_vertices"),
            compilation_options: compilation_options.clone(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH_FORMAT,
            // Strokes hide nothing; they lie over each other in the order of
            // the records.
            depth_write_enabled: Some(false),
            depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState { count: samples, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("stroke_fragment"),
            compilation_options,
            targets: &[Some(wgpu::ColorTargetState {
                format: COLOR_FORMAT,
                blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}
