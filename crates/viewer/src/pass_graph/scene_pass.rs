//! `simple_render`: the surfaces of the scene with a vertex and a fragment program.

use strokes::{Gpu, Targets, TimedPasses};

use super::Encoding;
use super::bindings::Sources;
use super::builder::Builder;
use super::glass::Glass;
use super::params::Iteration;
use super::pipeline::{BoundGroups, Geometry, GraphLayouts, GroupBuffers, PassPipeline, Programs};
use super::screen_pass::{color_attachment, screen_vertex};
use super::surface::{Ranges, Surfaces};
use crate::error::Error;
use crate::technique::core_view::SimpleRender;
use crate::technique::pass::Pass;
use crate::technique::plan::{PassPlan, Target};

/// Draws the surfaces of the scene.
#[derive(Debug)]
pub(crate) struct ScenePass {
    surfaces: ValuedPipeline,
    /// If the pass draws to the picture, and a surface is transparent.
    glass: Option<Glass<ValuedPipeline>>,
    background: Option<Background>,
    /// Whether the colors of vertices are drawn: first for objects without an override, then for
    /// overrides.
    vertex_colors: Vec<bool>,
    /// For each object an index of values; none for objects that are not drawn.
    value_indices: Vec<Option<usize>>,
    clears: bool,
    clear_color: wgpu::Color,
}

/// A pipeline with parameters for all values of the variables of a pass.
#[derive(Debug)]
struct ValuedPipeline {
    pipeline: PassPipeline,
    buffers: Vec<GroupBuffers>,
}

impl ValuedPipeline {
    fn bind(&self, gpu: &Gpu, sources: &mut Sources) -> Result<Vec<BoundGroups>, Error> {
        let bind = |buffers| self.pipeline.bind(gpu, buffers, sources, None);
        self.buffers.iter().map(bind).collect()
    }
}

/// A program that draws the background.
#[derive(Debug)]
struct Background {
    pipeline: PassPipeline,
    buffers: GroupBuffers,
}

impl ScenePass {
    pub(crate) fn new(
        builder: &Builder,
        pass: &Pass,
        plan: &PassPlan,
        view: &SimpleRender,
        surfaces: &Surfaces,
    ) -> Result<Self, Error> {
        let (input, options) = (builder.input, builder.input.options);
        let buffers_of = |pipeline: &PassPipeline, pass: &Pass| {
            pipeline.buffers(&builder.gpu.device, pass, Iteration::default())
        };
        let missing = || Error::Internal(format!("the pass '{}' has no program", pass.name));
        let target = builder.target(plan);
        let vertex = plan.programs.vertex.as_ref().ok_or_else(missing)?;
        let fragment = plan.programs.fragment.as_ref().ok_or_else(missing)?;
        let programs = Programs { label: &pass.name, vertex, fragment, reads: &plan.reads };
        let layouts = GraphLayouts { frame: builder.frame, surface: &surfaces.layout };
        let pipeline = builder.pipeline(layouts, programs, Geometry::Surfaces, &target)?;
        let is_paper = plan.target == Target::Framebuffer;
        let background = match &plan.programs.background {
            Some(fragment) if !(is_paper && options.is_transparent) => {
                let vertex = screen_vertex()?;
                let programs = Programs { vertex: &vertex, fragment, ..programs };
                let pipeline = builder.pipeline(layouts, programs, Geometry::Screen, &target)?;
                let buffers = buffers_of(&pipeline, pass);
                Some(Background { pipeline, buffers })
            }
            _ => None,
        };
        let glass = if is_paper && surfaces.has_glass() && target.blend.is_none() {
            Some(Glass::new(builder, layouts, programs, &target)?)
        } else {
            None
        };
        let mut passes = vec![pass];
        let mut vertex_colors = vec![view.has_vertex_colors];
        let of_scene = pass.is_rendered().then_some(0);
        let mut of_override = vec![of_scene; input.overrides.len()];
        for (at, technique) in input.overrides.iter().enumerate() {
            let own = technique.pass(&pass.name).filter(|own| own.component == pass.component);
            if let Some(own) = own {
                of_override[at] = own.is_rendered().then_some(passes.len());
                passes.push(own);
                vertex_colors.push(SimpleRender::of(own)?.has_vertex_colors);
            }
        }
        let objects = input.scene.objects.iter();
        let value_indices = objects
            .map(|object| of_override.get(object.override_index).copied().unwrap_or(of_scene));
        let [r, g, b, a] = match is_paper && options.is_transparent {
            true => [0.0; 4],
            false => view.clear_color.map(f64::from),
        };
        let clear_color = wgpu::Color { r: r * a, g: g * a, b: b * a, a };
        let valued = |pipeline: &PassPipeline| ValuedPipeline {
            pipeline: pipeline.clone(),
            buffers: passes.iter().map(|pass| buffers_of(pipeline, pass)).collect(),
        };
        Ok(Self {
            surfaces: valued(&pipeline),
            glass: glass.map(|glass| glass.map(valued)),
            background,
            vertex_colors,
            value_indices: value_indices.collect(),
            clears: view.is_cleared,
            clear_color,
        })
    }

    pub(crate) fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        encoding: &mut Encoding,
        plan: &PassPlan,
        sources: &mut Sources,
        timer: Option<TimedPasses>,
    ) -> Result<(), Error> {
        let gpu = encoding.gpu;
        let background = self.background.as_ref();
        let background = background
            .map(|Background { pipeline, buffers }| {
                pipeline.bind(gpu, buffers, sources, None).map(|groups| (pipeline, groups))
            })
            .transpose()?;
        let groups = self.surfaces.bind(gpu, sources)?;
        let (colors, depth) =
            self.attachments(encoding.framebuffer, encoding.is_fresh, plan, sources);
        if plan.target == Target::Framebuffer {
            (encoding.is_fresh, encoding.has_depth) = (false, true);
        }
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("scene"),
            color_attachments: &colors,
            depth_stencil_attachment: depth,
            timestamp_writes: timer.map(|timer| timer.render(0)),
            ..Default::default()
        });
        pass.set_bind_group(0, encoding.view.frame_group(), &[]);
        if let Some((pipeline, groups)) = background {
            pass.set_pipeline(&pipeline.pipeline);
            for (index, group) in &groups {
                pass.set_bind_group(*index, group, &[]);
            }
            pass.draw(0..3, 0..1);
        }
        let ranges = if self.glass.is_some() { Ranges::Opaque } else { Ranges::All };
        self.record(&mut pass, encoding, &self.surfaces, &groups, ranges);
        drop(pass);
        self.encode_glass(encoder, encoding, sources)
    }

    /// Draws the transparent surfaces over the picture.
    fn encode_glass(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        encoding: &mut Encoding,
        sources: &mut Sources,
    ) -> Result<(), Error> {
        let Some((glass, targets)) = self.glass.as_ref().zip(encoding.glass) else {
            return Ok(());
        };
        let gpu = encoding.gpu;
        if let Some(layers) = &glass.layers {
            let groups = [layers[0].bind(gpu, sources)?, layers[1].bind(gpu, sources)?];
            targets.encode(encoder, encoding.framebuffer, encoding.view, |pass, at| {
                self.record(pass, encoding, &layers[at], &groups[at], Ranges::Transparent);
            });
        }
        let groups = glass.nearest.bind(gpu, sources)?;
        targets.encode_nearest(encoder, encoding.view, |pass| {
            self.record(pass, encoding, &glass.nearest, &groups, Ranges::Transparent);
        });
        encoding.has_glass_depth = true;
        Ok(())
    }

    /// Draws ranges of the surfaces of all objects with a pipeline and its bound groups.
    fn record(
        &self,
        pass: &mut wgpu::RenderPass,
        encoding: &Encoding,
        valued: &ValuedPipeline,
        groups: &[BoundGroups],
        ranges: Ranges,
    ) {
        let Some(surfaces) = encoding.surfaces else { return };
        pass.set_pipeline(&valued.pipeline.pipeline);
        let states = encoding.view.objects().iter().zip(&self.value_indices);
        for (at, (state, values)) in states.enumerate() {
            let Some(values) = values.filter(|_| state.is_placed()) else { continue };
            for (index, group) in &groups[values] {
                pass.set_bind_group(*index, group, &[]);
            }
            let has_colors = self.vertex_colors[values];
            surfaces.draw(pass, encoding.instances, at, has_colors, ranges);
        }
    }

    /// The attachments; `is_fresh` if nothing was drawn to the framebuffer yet.
    fn attachments<'a>(
        &self,
        targets: &'a Targets,
        is_fresh: bool,
        plan: &PassPlan,
        sources: &'a Sources,
    ) -> Attachments<'a> {
        let clear = wgpu::LoadOp::Clear(self.clear_color);
        match &plan.target {
            Target::Framebuffer => {
                let load = match (self.clears, is_fresh) {
                    (true, _) => clear,
                    (false, true) => wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    (false, false) => wgpu::LoadOp::Load,
                };
                let depth = match self.clears || is_fresh {
                    true => targets.cleared_depth(),
                    false => targets.kept_depth(),
                };
                (vec![Some(targets.color_attachment(load, false))], Some(depth))
            }
            Target::Textures { colors, depth } => {
                let load = if self.clears { clear } else { wgpu::LoadOp::Load };
                let view = |at: usize| sources.generated[at].write(plan.is_in_place);
                let colors = colors.iter().enumerate().map(|(location, &color)| {
                    // Only the first output is a color; the others are cleared to 0.
                    let load = match (self.clears, location) {
                        (true, 1..) => wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                        _ => load,
                    };
                    Some(color_attachment(view(color), load))
                });
                let depth = depth.map(|depth| wgpu::RenderPassDepthStencilAttachment {
                    view: view(depth),
                    depth_ops: Some(wgpu::Operations {
                        // Reversed depth: 0 is the far plane.
                        load: match self.clears {
                            true => wgpu::LoadOp::Clear(0.0),
                            false => wgpu::LoadOp::Load,
                        },
                        store: wgpu::StoreOp::Store,
                    }),
                    stencil_ops: None,
                });
                (colors.collect(), depth)
            }
        }
    }
}

type Attachments<'a> = (
    Vec<Option<wgpu::RenderPassColorAttachment<'a>>>,
    Option<wgpu::RenderPassDepthStencilAttachment<'a>>,
);
