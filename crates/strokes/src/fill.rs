//! The fill: the surface in one flat colour, and the depth that hides strokes.
//!
//! The surface is pushed away from the eye a little (the paper's section 3.5
//! uses the same offset), in proportion to its slope on the screen, so that a
//! stroke along an edge is not swallowed by the faces beside it. The push is that
//! of about one pixel of slope, whatever the width of the strokes; wide strokes
//! follow their faces by themselves (`stroke_vertex.wgsl`).
//!
//! Rejected: pulling the strokes forward by a constant, as no constant is right
//! for a face seen head on and for one seen edge on; a push that grows with the
//! strokes, as hidden lines then show through along every silhouette.

use bytemuck::{Pod, Zeroable};
use wgpu::ShaderStages;

use crate::detect::bind_buffers;
use crate::frame::{uniform_buffer, uniform_entry};
use crate::mesh_buffers::MeshBuffers;
use crate::shader::{ShaderError, ShaderSource};
use crate::targets::{COLOR_FORMAT, DEPTH_FORMAT};

/// The constant part of the push, in steps of the depth buffer.
const PUSH_STEPS: i32 = 8;

/// What every pass of one fill shares. WGSL twin: `shaders/fill.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct FillUniform {
    /// Premultiplied colour.
    pub color: [f32; 4],
}

/// The pipeline with its colour.
#[derive(Debug)]
pub struct FillPipeline {
    pipeline: wgpu::RenderPipeline,
    pass_group: wgpu::BindGroup,
}

impl FillPipeline {
    /// Builds the pipeline.
    ///
    /// # Errors
    /// Where the shader cannot be put together.
    pub fn new(
        device: &wgpu::Device,
        frame_layout: &wgpu::BindGroupLayout,
        samples: u32,
        color: [f32; 4],
    ) -> Result<Self, ShaderError> {
        let pass_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("fill"),
            entries: &[uniform_entry(0, ShaderStages::FRAGMENT)],
        });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("fill"),
            bind_group_layouts: &[Some(frame_layout), Some(&pass_layout)],
            immediate_size: 0,
        });
        let module = ShaderSource::embedded("fill.wgsl")?.module(device, "fill");
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("fill"),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("fill_vertex"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[Some(wgpu::VertexBufferLayout {
                    array_stride: 12,
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes: &wgpu::vertex_attr_array![0 => Float32x3],
                })],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Greater),
                stencil: wgpu::StencilState::default(),
                bias: push_away(),
            }),
            multisample: wgpu::MultisampleState { count: samples, ..Default::default() },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fill_fragment"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[Some(COLOR_FORMAT.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let uniform = uniform_buffer(device, "fill", &FillUniform { color });
        let pass_group = bind_buffers(device, "fill", &pass_layout, &[&uniform]);
        Ok(Self { pipeline, pass_group })
    }

    /// Sets the pipeline and its colour.
    pub fn bind(&self, pass: &mut wgpu::RenderPass) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(1, &self.pass_group, &[]);
    }

    /// Draws one mesh; after [`Self::bind`], `@group(0)` must be the frame.
    pub fn record(&self, pass: &mut wgpu::RenderPass, mesh: &MeshBuffers) {
        if mesh.size.face_count == 0 {
            return;
        }
        pass.set_vertex_buffer(0, mesh.positions.slice(..));
        pass.set_index_buffer(mesh.triangles.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..mesh.size.face_count * 3, 0, 0..1);
    }
}

/// Away from the eye is toward 0 in reversed depth. A sample lies up to a pixel
/// from where the edge's depth was taken; the driver's slope is the larger of
/// the two screen directions, so a slope across the diagonal counts as the root
/// of two of it.
const fn push_away() -> wgpu::DepthBiasState {
    wgpu::DepthBiasState {
        constant: -PUSH_STEPS,
        slope_scale: -std::f32::consts::SQRT_2,
        clamp: 0.0,
    }
}
