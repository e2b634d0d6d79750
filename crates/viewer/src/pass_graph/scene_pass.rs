//! `simple_render`: the surfaces of the scene with a vertex and a fragment program.

use strokes::{Targets, TimedPasses};

use super::Encoding;
use super::bindings::Sources;
use super::builder::Builder;
use super::params::Iteration;
use super::pipeline::{Geometry, GraphLayouts, GroupBuffers, PassPipeline, Programs};
use super::screen_pass::{color_attachment, screen_vertex};
use super::surface::Surfaces;
use crate::error::Error;
use crate::technique::core_view::SimpleRender;
use crate::technique::pass::Pass;
use crate::technique::plan::{PassPlan, Target};

/// Draws the surfaces of the scene.
#[derive(Debug)]
pub(crate) struct ScenePass {
    surfaces: PassPipeline,
    background: Option<Background>,
    /// Values of variables: first those of objects without an override, then those of overrides.
    values: Vec<Values>,
    /// For each object an index in `values`; none for objects that are not drawn.
    value_indices: Vec<Option<usize>>,
    clears: bool,
    clear_color: wgpu::Color,
}

/// The values of the variables of a pass.
#[derive(Debug)]
struct Values {
    /// Parameters of the programs.
    buffers: GroupBuffers,
    has_vertex_colors: bool,
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
        let values_of = |pass: &Pass, view: &SimpleRender| Values {
            buffers: buffers_of(&pipeline, pass),
            has_vertex_colors: view.has_vertex_colors,
        };
        let mut values = vec![values_of(pass, view)];
        let of_scene = pass.is_rendered().then_some(0);
        let mut of_override = vec![of_scene; input.overrides.len()];
        for (at, technique) in input.overrides.iter().enumerate() {
            let own = technique.pass(&pass.name).filter(|own| own.component == pass.component);
            if let Some(own) = own {
                of_override[at] = own.is_rendered().then_some(values.len());
                values.push(values_of(own, &SimpleRender::of(own)?));
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
        Ok(Self {
            surfaces: pipeline,
            background,
            values,
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
        let mut bind = |pipeline: &PassPipeline, buffers: &GroupBuffers| {
            pipeline.bind(gpu, buffers, sources, None)
        };
        let background = self.background.as_ref();
        let background = background
            .map(|Background { pipeline, buffers }| {
                bind(pipeline, buffers).map(|groups| (pipeline, groups))
            })
            .transpose()?;
        let groups = self.values.iter().map(|values| bind(&self.surfaces, &values.buffers));
        let groups = groups.collect::<Result<Vec<_>, Error>>()?;
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
        pass.set_pipeline(&self.surfaces.pipeline);
        let Some(surfaces) = encoding.surfaces else { return Ok(()) };
        let states = encoding.view.objects().iter().zip(&self.value_indices);
        for (at, (state, values)) in states.enumerate() {
            let Some(values) = values.filter(|_| state.is_placed()) else { continue };
            for (index, group) in &groups[values] {
                pass.set_bind_group(*index, group, &[]);
            }
            let has_colors = self.values[values].has_vertex_colors;
            surfaces.draw(&mut pass, encoding.instances, at, has_colors);
        }
        Ok(())
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
