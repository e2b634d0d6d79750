//! `process_texture`, `generate_texture`, `composite`: a program over a whole target.

use strokes::{Gpu, TimedPasses};

use super::Encoding;
use super::bindings::Sources;
use super::builder::Builder;
use super::params::Iteration;
use super::pipeline::{Geometry, GraphLayouts, GroupBuffers, PassPipeline, Programs};
use crate::error::Error;
use crate::technique::mistake::{Place, SourceText};
use crate::technique::pass::Pass;
use crate::technique::plan::{PassPlan, ReadSource, Target, TextureRead};
use crate::technique::program::{Program, ProgramKind, ShaderFiles};

/// A program over a whole target.
#[derive(Debug)]
pub(crate) struct ScreenPass {
    pub(crate) pipeline: PassPipeline,
    buffers: GroupBuffers,
    /// Whether it only draws a background, in a picture with a transparent one.
    is_unwanted_paper: bool,
}

/// The vertex program of a triangle over the whole target.
pub(crate) fn screen_vertex() -> Result<Program, Error> {
    own_program("screen:screen", ProgramKind::Vertex)
}

/// A built-in program, even if the user has one with the same name.
pub(crate) fn own_program(name: &str, kind: ProgramKind) -> Result<Program, Error> {
    let place = Place { source: SourceText::new("", ""), span: 0..0 };
    ShaderFiles::default()
        .program(name, kind, &place)
        .map_err(|mistakes| Error::Internal(mistakes.text()))
}

impl ScreenPass {
    pub(crate) fn new(builder: &Builder, pass: &Pass, plan: &PassPlan) -> Result<Self, Error> {
        let fragment = plan.programs.fragment.as_ref();
        let pipeline = screen_pipeline(builder, pass, plan, fragment, &builder.target(plan))?;
        let buffers = pipeline.buffers(&builder.gpu.device, pass, Iteration::default());
        let is_generated = |read: &TextureRead| matches!(read.source, ReadSource::Generated(_));
        let is_unwanted_paper = builder.input.options.is_transparent
            && plan.target == Target::Framebuffer
            && !plan.reads.iter().any(is_generated);
        Ok(Self { pipeline, buffers, is_unwanted_paper })
    }

    pub(crate) fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        encoding: &mut Encoding,
        plan: &PassPlan,
        sources: &mut Sources,
        timer: Option<TimedPasses>,
    ) -> Result<(), Error> {
        // A first pass that reads no generated texture draws a background.
        if self.is_unwanted_paper && encoding.is_fresh {
            skip(encoder, timer);
            return Ok(());
        }
        let groups = self.pipeline.bind(encoding.gpu, &self.buffers, sources, None)?;
        let timestamps = timer.map(|timer| timer.render(0));
        draw(encoder, encoding, plan, sources, &self.pipeline, &groups, timestamps);
        Ok(())
    }
}

/// Writes the timestamps of a pass that does not run.
pub(crate) fn skip(encoder: &mut wgpu::CommandEncoder, timer: Option<TimedPasses>) {
    if let Some(timer) = timer {
        encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("not due"),
            timestamp_writes: Some(timer.compute(0)),
        });
    }
}

/// The pipeline of a pass that draws over a whole target with the program `fragment`.
pub(crate) fn screen_pipeline(
    builder: &Builder,
    pass: &Pass,
    plan: &PassPlan,
    fragment: Option<&Program>,
    target: &super::pipeline::PipelineTarget,
) -> Result<PassPipeline, Error> {
    let vertex = screen_vertex()?;
    let Some(fragment) = fragment else {
        return Err(Error::Internal(format!("the pass '{}' has no program", pass.name)));
    };
    let programs = Programs { label: &pass.name, vertex: &vertex, fragment, reads: &plan.reads };
    // The geometry of the screen does not use the group of a surface.
    let layouts = GraphLayouts { frame: builder.frame, surface: &empty_layout(builder.gpu) };
    builder.pipeline(layouts, programs, Geometry::Screen, target)
}

fn empty_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("nothing"),
        entries: &[],
    })
}

/// Draws a triangle over the target of `plan`.
pub(crate) fn draw(
    encoder: &mut wgpu::CommandEncoder,
    encoding: &mut Encoding,
    plan: &PassPlan,
    sources: &Sources,
    pipeline: &PassPipeline,
    groups: &[(u32, wgpu::BindGroup)],
    timestamps: Option<wgpu::RenderPassTimestampWrites>,
) {
    let mut attachments = Vec::new();
    let mut depth = None;
    match &plan.target {
        Target::Framebuffer => {
            let targets = encoding.framebuffer;
            attachments.push(Some(targets.color_attachment(encoding.load(), false)));
            depth = Some(match encoding.is_fresh {
                true => targets.cleared_depth(),
                false => targets.kept_depth(),
            });
            encoding.is_fresh = false;
        }
        Target::Textures { colors, .. } => {
            for &color in colors {
                let view = sources.generated[color].write(plan.is_in_place);
                attachments.push(Some(color_attachment(view, wgpu::LoadOp::Load)));
            }
        }
    }
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("screen"),
        color_attachments: &attachments,
        depth_stencil_attachment: depth,
        timestamp_writes: timestamps,
        ..Default::default()
    });
    pass.set_pipeline(&pipeline.pipeline);
    pass.set_bind_group(0, encoding.view.frame_group(), &[]);
    for (index, group) in groups {
        pass.set_bind_group(*index, group, &[]);
    }
    pass.draw(0..3, 0..1);
}

/// An attachment of one sample per pixel.
pub(crate) fn color_attachment(
    view: &wgpu::TextureView,
    load: wgpu::LoadOp<wgpu::Color>,
) -> wgpu::RenderPassColorAttachment<'_> {
    wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
    }
}
