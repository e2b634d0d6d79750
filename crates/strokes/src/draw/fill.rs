//! The fill: the surface in one flat color, and the depth that hides strokes.
//!
//! The surface is pushed away from the eye in proportion to its slope on the screen (the paper's
//! section 3.5 uses the same offset), so that the faces beside an edge do not swallow its
//! stroke. The push is about one pixel of slope, whatever the width of the strokes; wide strokes
//! follow their faces (`stroke_vertex.wgsl`).
//!
//! Rejected: pulling the strokes forward by a constant, since no constant is right both for a
//! face seen head on and for one seen edge on; a push that grows with the strokes, since hidden
//! lines would show through along every silhouette.

use bytemuck::{Pod, Zeroable};
use edgemesh_shaders::ShaderError;
use wgpu::{CompareFunction, ShaderStages, StencilFaceState, StencilOperation};

use crate::gpu::bind::{bind_buffers, uniform_buffer, uniform_entry};
use crate::gpu::shader::embedded_module;
use crate::gpu::target_formats::TargetFormats;
use crate::mesh::instance::MeshInstance;

/// The constant part of the push, in steps of the depth buffer.
const PUSH_STEPS: i32 = 8;

/// The style of a fill. WGSL twin: `shaders/fill.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct FillUniform {
    /// Premultiplied RGBA.
    pub color: [f32; 4],
}

/// The attachments that a fill writes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FillKind {
    /// Color, depth and stencil.
    Whole,
    /// Depth and stencil: the background shows through.
    Clear,
    /// The stencil alone, where the surface is the nearest one.
    Stencil,
}

/// The pipelines of the fill.
#[derive(Debug)]
pub(crate) struct FillPipeline {
    /// Without and with clip planes.
    whole: [wgpu::RenderPipeline; 2],
    clear: [wgpu::RenderPipeline; 2],
    stencil: [wgpu::RenderPipeline; 2],
    pass_layout: wgpu::BindGroupLayout,
    object_layout: wgpu::BindGroupLayout,
}

impl FillPipeline {
    pub(crate) fn new(
        device: &wgpu::Device,
        frame_layout: &wgpu::BindGroupLayout,
        formats: &TargetFormats,
    ) -> Result<Self, ShaderError> {
        let layout = |label: &str, visibility| {
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some(label),
                entries: &[uniform_entry(0, visibility)],
            })
        };
        let pass_layout = layout("fill", ShaderStages::FRAGMENT);
        let object_layout = layout("fill object", ShaderStages::VERTEX_FRAGMENT);
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("fill"),
            bind_group_layouts: &[Some(frame_layout), Some(&pass_layout), Some(&object_layout)],
            immediate_size: 0,
        });
        let module = embedded_module(device, "fill.wgsl")?;
        let pipeline = |kind| {
            [false, true]
                .map(|clips| pipeline(device, &pipeline_layout, &module, formats, (kind, clips)))
        };
        Ok(Self {
            whole: pipeline(FillKind::Whole),
            clear: pipeline(FillKind::Clear),
            stencil: pipeline(FillKind::Stencil),
            pass_layout,
            object_layout,
        })
    }

    /// `@group(1)` of a premultiplied color.
    pub(crate) fn pass(&self, device: &wgpu::Device, color: [f32; 4]) -> wgpu::BindGroup {
        let uniform = uniform_buffer(device, "fill", &FillUniform { color });
        bind_buffers(device, "fill", &self.pass_layout, &[(0, &uniform)])
    }

    /// `@group(2)` of an object.
    pub(crate) fn bind(&self, device: &wgpu::Device, object: &wgpu::Buffer) -> wgpu::BindGroup {
        bind_buffers(device, "fill object", &self.object_layout, &[(0, object)])
    }

    pub(crate) fn set(&self, pass: &mut wgpu::RenderPass, kind: FillKind, clips: bool) {
        let pipelines = match kind {
            FillKind::Whole => &self.whole,
            FillKind::Clear => &self.clear,
            FillKind::Stencil => &self.stencil,
        };
        pass.set_pipeline(&pipelines[usize::from(clips)]);
    }

    /// Draws one instance after [`Self::set`]; `@group(0)` must be the frame, `@group(1)` the
    /// color, `@group(2)` the object.
    pub(crate) fn record(pass: &mut wgpu::RenderPass, instance: &MeshInstance) {
        let parts = instance.mesh().fill.iter().zip(&instance.geometry().fill);
        for (part, positions) in parts.filter(|(part, _)| part.index_count > 0) {
            pass.set_vertex_buffer(0, positions.slice(..));
            pass.set_index_buffer(part.triangles.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(0..part.index_count, 0, 0..1);
        }
    }
}

fn pipeline(
    device: &wgpu::Device,
    layout: &wgpu::PipelineLayout,
    module: &wgpu::ShaderModule,
    formats: &TargetFormats,
    (kind, clips): (FillKind, bool),
) -> wgpu::RenderPipeline {
    let constants = [("CLIPS", f64::from(u8::from(clips)))];
    let write_mask = match kind {
        FillKind::Whole => wgpu::ColorWrites::ALL,
        FillKind::Clear | FillKind::Stencil => wgpu::ColorWrites::empty(),
    };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("fill"),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("fill_vertex"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: 12,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &wgpu::vertex_attr_array![0 => Float32x3],
            })],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(depth_stencil(formats, kind)),
        multisample: wgpu::MultisampleState { count: formats.samples, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("fill_fragment"),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &constants,
                ..Default::default()
            },
            targets: &[Some(wgpu::ColorTargetState {
                format: formats.color,
                blend: None,
                write_mask,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn depth_stencil(formats: &TargetFormats, kind: FillKind) -> wgpu::DepthStencilState {
    // The stencil alone is written after all fills, where the depth is that of the object.
    let depth_compare = match kind {
        FillKind::Whole | FillKind::Clear => CompareFunction::Greater,
        FillKind::Stencil => CompareFunction::Equal,
    };
    let face = StencilFaceState {
        compare: CompareFunction::Always,
        fail_op: StencilOperation::Keep,
        depth_fail_op: StencilOperation::Keep,
        pass_op: StencilOperation::Replace,
    };
    let stencil = if formats.has_stencil() {
        wgpu::StencilState { front: face, back: face, read_mask: 0xff, write_mask: 0xff }
    } else {
        wgpu::StencilState::default()
    };
    wgpu::DepthStencilState {
        format: formats.depth,
        depth_write_enabled: Some(kind != FillKind::Stencil),
        depth_compare: Some(depth_compare),
        stencil,
        bias: push_away(),
    }
}

/// The depth bias for surfaces under strokes: pushes them away from the eye by about one pixel of
/// slope, so that they do not swallow the strokes along their edges.
///
/// Reversed depth is smaller farther away. A sample lies up to a pixel from where the edge's
/// depth was taken; the driver takes the larger slope of the two screen axes, and a diagonal one
/// can be larger by the root of 2.
#[must_use]
pub const fn push_away() -> wgpu::DepthBiasState {
    wgpu::DepthBiasState {
        constant: -PUSH_STEPS,
        slope_scale: -std::f32::consts::SQRT_2,
        clamp: 0.0,
    }
}
