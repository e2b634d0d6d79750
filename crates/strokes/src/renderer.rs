//! One frame: detect, fill, strokes, in one command buffer and without reading
//! anything back.

use crate::detect::{DetectDraw, DetectPipeline};
use crate::fill::FillPipeline;
use crate::frame::{Frame, FrameUniform, frame_layout};
use crate::gpu::Gpu;
use crate::gpu_time::GpuTimer;
use crate::mesh_buffers::MeshBuffers;
use crate::shader::ShaderError;
use crate::stroke::{StrokeDraw, StrokePipeline, StrokeStyle};
use crate::targets::Targets;

/// The passes of a frame, in order, as [`GpuTimer`] numbers them.
pub const PASS_NAMES: [&str; 3] = ["detect", "fill", "strokes"];

/// How a picture looks.
#[derive(Debug, Clone)]
pub struct Look {
    /// Premultiplied colour behind everything.
    pub background: [f64; 4],
    /// Premultiplied colour of the surface.
    pub fill_color: [f32; 4],
    /// The strokes; `None` draws the fill alone.
    pub strokes: Option<StrokeStyle>,
}

/// The pipelines of a look for a number of samples.
#[derive(Debug)]
pub struct Renderer {
    background: wgpu::Color,
    frame: Frame,
    detect: DetectPipeline,
    fill: FillPipeline,
    stroke: Option<StrokePipeline>,
}

/// A mesh prepared for a [`Renderer`].
#[derive(Debug)]
pub struct MeshDraw {
    /// Its buffers.
    pub buffers: MeshBuffers,
    detect: DetectDraw,
    stroke: Option<StrokeDraw>,
}

impl Renderer {
    /// Builds the pipelines.
    ///
    /// # Errors
    /// Where a shader cannot be put together.
    pub fn new(gpu: &Gpu, look: &Look, samples: u32) -> Result<Self, ShaderError> {
        let device = &gpu.device;
        let layout = frame_layout(device);
        let [r, g, b, a] = look.background;
        let stroke = look.strokes.as_ref();
        Ok(Self {
            background: wgpu::Color { r, g, b, a },
            frame: Frame::new(device, &layout, &bytemuck::Zeroable::zeroed()),
            detect: DetectPipeline::new(device, &layout)?,
            fill: FillPipeline::new(device, &layout, samples, look.fill_color)?,
            stroke: stroke
                .map(|style| StrokePipeline::new(gpu, &layout, samples, style))
                .transpose()?,
        })
    }

    /// Prepares uploaded buffers for drawing.
    #[must_use]
    pub fn mesh_draw(&self, device: &wgpu::Device, buffers: MeshBuffers) -> MeshDraw {
        MeshDraw {
            detect: self.detect.draw(device, &buffers),
            stroke: self.stroke.as_ref().map(|stroke| stroke.draw(device, &buffers)),
            buffers,
        }
    }

    /// Submits one frame of `meshes` as `view` sees them.
    pub fn render(
        &self,
        gpu: &Gpu,
        targets: &Targets,
        view: &FrameUniform,
        meshes: &[MeshDraw],
        timer: Option<&GpuTimer>,
    ) {
        self.frame.write(&gpu.queue, view);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        self.encode_detect(&mut encoder, meshes, timer);
        self.encode_fill(&mut encoder, targets, meshes, timer);
        self.encode_strokes(&mut encoder, targets, meshes, timer);
        if let Some(timer) = timer {
            timer.resolve(&mut encoder);
        }
        gpu.queue.submit([encoder.finish()]);
    }

    fn encode_detect(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        meshes: &[MeshDraw],
        timer: Option<&GpuTimer>,
    ) {
        for mesh in meshes {
            DetectPipeline::clear(encoder, &mesh.buffers);
        }
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some(PASS_NAMES[0]),
            timestamp_writes: timer.map(|timer| timer.compute(0)),
        });
        if self.stroke.is_none() {
            return;
        }
        pass.set_bind_group(0, &self.frame.bind_group, &[]);
        for mesh in meshes {
            self.detect.record(&mut pass, &mesh.detect);
        }
    }

    fn encode_fill(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        targets: &Targets,
        meshes: &[MeshDraw],
        timer: Option<&GpuTimer>,
    ) {
        let color = targets.color_attachment(wgpu::LoadOp::Clear(self.background), false);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(PASS_NAMES[1]),
            color_attachments: &[Some(color)],
            // Reversed depth: 0 is the far plane.
            depth_stencil_attachment: Some(
                targets.depth_attachment(wgpu::LoadOp::Clear(0.0), wgpu::StoreOp::Store),
            ),
            timestamp_writes: timer.map(|timer| timer.render(1)),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.frame.bind_group, &[]);
        self.fill.bind(&mut pass);
        for mesh in meshes {
            self.fill.record(&mut pass, &mesh.buffers);
        }
    }

    fn encode_strokes(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        targets: &Targets,
        meshes: &[MeshDraw],
        timer: Option<&GpuTimer>,
    ) {
        let color = targets.color_attachment(wgpu::LoadOp::Load, true);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(PASS_NAMES[2]),
            color_attachments: &[Some(color)],
            depth_stencil_attachment: Some(
                targets.depth_attachment(wgpu::LoadOp::Load, wgpu::StoreOp::Discard),
            ),
            timestamp_writes: timer.map(|timer| timer.render(2)),
            ..Default::default()
        });
        let Some(stroke) = &self.stroke else { return };
        pass.set_bind_group(0, &self.frame.bind_group, &[]);
        stroke.bind(&mut pass);
        for mesh in meshes {
            if let Some(draw) = &mesh.stroke {
                stroke.record(&mut pass, &mesh.buffers, draw);
            }
        }
    }
}
