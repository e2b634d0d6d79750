//! The pipeline of a pass: its programs, parameters and target.

use std::borrow::Cow;

use strokes::{Gpu, TargetFormats, push_away, shader_module};

use super::bindings::{GroupPlan, PASS_GROUP, Replacement, Sources, VERTEX_GROUP};
use super::params::Iteration;
use super::surface::VERTEX_BUFFERS;
use crate::error::Error;
use crate::technique::error::TechniqueError;
use crate::technique::loop_bound::bound_loops;
use crate::technique::pass::Pass;
use crate::technique::plan::TextureRead;
use crate::technique::program::Program;

/// A pipeline with the groups of its parameters and textures.
#[derive(Debug, Clone)]
pub(crate) struct PassPipeline {
    pub(crate) pipeline: wgpu::RenderPipeline,
    pub(crate) groups: Vec<PassGroup>,
}

/// A group of parameters and textures.
#[derive(Debug, Clone)]
pub(crate) struct PassGroup {
    pub(crate) index: u32,
    pub(crate) plan: GroupPlan,
    pub(crate) layout: wgpu::BindGroupLayout,
}

/// The uniform buffers of each group of a pipeline.
pub(crate) type GroupBuffers = Vec<Vec<wgpu::Buffer>>;

/// Bind groups with their indices.
pub(crate) type BoundGroups = Vec<(u32, wgpu::BindGroup)>;

/// What a pipeline draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Geometry {
    /// The surfaces of the scene.
    Surfaces,
    /// One triangle over the whole target, behind all surfaces.
    Screen,
}

/// The target of a pipeline.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PipelineTarget {
    pub(crate) colors: Vec<wgpu::TextureFormat>,
    pub(crate) depth: Option<wgpu::TextureFormat>,
    pub(crate) samples: u32,
    pub(crate) blend: Option<wgpu::BlendState>,
    /// Whether surfaces are pushed back, so that strokes lie in front of them.
    pub(crate) is_pushed: bool,
    /// Whether the program writes the depth itself.
    pub(crate) writes_depth: bool,
    /// Whether there are clip planes.
    pub(crate) clips: bool,
    pub(crate) depth_use: DepthUse,
}

/// The target of a pipeline that draws the depth alone.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DepthTarget {
    pub(crate) format: wgpu::TextureFormat,
    pub(crate) samples: u32,
    pub(crate) bias: wgpu::DepthBiasState,
    /// Whether there are clip planes.
    pub(crate) clips: bool,
}

/// How surfaces use the depth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum DepthUse {
    /// The nearest surface is kept.
    Nearest,
    /// Only where the depth is that of the surface; nothing is written.
    Same,
}

impl PipelineTarget {
    /// The picture.
    pub(crate) fn framebuffer(
        formats: &TargetFormats,
        blend: Option<wgpu::BlendState>,
        clips: bool,
    ) -> Self {
        Self {
            colors: vec![formats.color],
            depth: Some(formats.depth),
            samples: formats.samples,
            blend,
            is_pushed: true,
            writes_depth: false,
            clips,
            depth_use: DepthUse::Nearest,
        }
    }
}

/// The layouts of the groups that passes of a graph share.
#[derive(Debug, Clone, Copy)]
pub(crate) struct GraphLayouts<'a> {
    /// Of the view, `@group(0)`.
    pub(crate) frame: &'a wgpu::BindGroupLayout,
    /// Of a surface, `@group(2)`.
    pub(crate) surface: &'a wgpu::BindGroupLayout,
}

/// The programs of a pipeline and what they read.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Programs<'a> {
    pub(crate) label: &'a str,
    pub(crate) vertex: &'a Program,
    pub(crate) fragment: &'a Program,
    pub(crate) reads: &'a [TextureRead],
}

impl PassPipeline {
    /// Builds the pipeline.
    pub(crate) fn new(
        gpu: &Gpu,
        shared: GraphLayouts,
        programs: Programs,
        geometry: Geometry,
        target: &PipelineTarget,
    ) -> Result<Self, Error> {
        let device = &gpu.device;
        let own = |group| {
            let both = [programs.vertex, programs.fragment];
            let plan = GroupPlan::new(group, &both, programs.reads);
            (!plan.is_empty()).then(|| PassGroup {
                index: group,
                layout: plan.layout(device),
                plan,
            })
        };
        let [pass, vertex] = [own(PASS_GROUP), own(VERTEX_GROUP)];
        let layouts = [
            Some(shared.frame),
            pass.as_ref().map(|group| &group.layout),
            (geometry == Geometry::Surfaces).then_some(shared.surface),
            vertex.as_ref().map(|group| &group.layout),
        ];
        let used = layouts.iter().rposition(Option::is_some).map_or(0, |last| last + 1);
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(programs.label),
            bind_group_layouts: &layouts[..used],
            immediate_size: 0,
        });
        let pipeline = render_pipeline(gpu, &layout, programs, geometry, target)?;
        Ok(Self { pipeline, groups: [pass, vertex].into_iter().flatten().collect() })
    }

    /// Builds a pipeline that draws the depth of surfaces alone, with the vertex program of a pass.
    pub(crate) fn of_depth(
        gpu: &Gpu,
        shared: GraphLayouts,
        (label, vertex, reads): (&str, &Program, &[TextureRead]),
        (module, entry_point): (&wgpu::ShaderModule, &str),
        target: DepthTarget,
    ) -> Result<Self, Error> {
        let DepthTarget { format, samples, bias, clips } = target;
        let device = &gpu.device;
        let groups: Vec<PassGroup> = [PASS_GROUP, VERTEX_GROUP]
            .into_iter()
            .map(|index| (index, GroupPlan::new(index, &[vertex], reads)))
            .filter(|(_, plan)| !plan.is_empty())
            .map(|(index, plan)| PassGroup { index, layout: plan.layout(device), plan })
            .collect();
        let own = |index| groups.iter().find(|group| group.index == index);
        let layouts = [
            Some(shared.frame),
            own(PASS_GROUP).map(|group| &group.layout),
            Some(shared.surface),
            own(VERTEX_GROUP).map(|group| &group.layout),
        ];
        let used = layouts.iter().rposition(Option::is_some).map_or(0, |last| last + 1);
        let constants = [("CLIPS", f64::from(u8::from(clips)))];
        let options =
            |constants| wgpu::PipelineCompilationOptions { constants, ..Default::default() };
        let faults = device.push_error_scope(wgpu::ErrorFilter::Validation);
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(label),
            bind_group_layouts: &layouts[..used],
            immediate_size: 0,
        });
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(label),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &program_module(vertex, device, label),
                entry_point: Some(&vertex.function),
                compilation_options: options(if vertex.asks_for_clips {
                    &constants[..]
                } else {
                    &[]
                }),
                buffers: &VERTEX_BUFFERS,
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Greater),
                stencil: wgpu::StencilState::default(),
                bias,
            }),
            multisample: wgpu::MultisampleState { count: samples, ..Default::default() },
            fragment: Some(wgpu::FragmentState {
                module,
                entry_point: Some(entry_point),
                compilation_options: options(&constants),
                targets: &[],
            }),
            multiview_mask: None,
            cache: None,
        });
        found(faults, label)?;
        Ok(Self { pipeline, groups })
    }

    /// Uniform buffers with the values of `pass` for each group.
    pub(crate) fn buffers(
        &self,
        device: &wgpu::Device,
        pass: &Pass,
        iteration: Iteration,
    ) -> GroupBuffers {
        self.groups.iter().map(|group| group.plan.buffers(device, pass, iteration)).collect()
    }

    /// Binds `buffers` and the current textures.
    pub(crate) fn bind(
        &self,
        gpu: &Gpu,
        buffers: &GroupBuffers,
        sources: &mut Sources,
        replacement: Option<Replacement>,
    ) -> Result<BoundGroups, Error> {
        let bind = |(group, buffers): (&PassGroup, &Vec<wgpu::Buffer>)| {
            let bound = group.plan.group(gpu, &group.layout, buffers, sources, replacement)?;
            Ok((group.index, bound))
        };
        self.groups.iter().zip(buffers).map(bind).collect()
    }
}

fn render_pipeline(
    gpu: &Gpu,
    layout: &wgpu::PipelineLayout,
    Programs { label, vertex, fragment, .. }: Programs,
    geometry: Geometry,
    target: &PipelineTarget,
) -> Result<wgpu::RenderPipeline, Error> {
    let device = &gpu.device;
    // Only the device finds out whether two programs fit together.
    let faults = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let modules = [vertex, fragment].map(|program| program_module(program, device, label));
    let targets: Vec<Option<wgpu::ColorTargetState>> = target
        .colors
        .iter()
        .map(|&format| {
            Some(wgpu::ColorTargetState {
                format,
                blend: target.blend,
                write_mask: wgpu::ColorWrites::ALL,
            })
        })
        .collect();
    let constants = |program: &Program| {
        let blends = target.depth_use == DepthUse::Same;
        let known = [
            (program.asks_for_clips, "CLIPS", target.clips),
            (program.asks_for_blends, "BLENDS", blends),
        ];
        let asked = known.into_iter().filter(|(is_asked_for, ..)| *is_asked_for);
        let asked = asked.map(|(_, name, value)| (name, f64::from(u8::from(value))));
        asked.collect::<Vec<(&str, f64)>>()
    };
    let [of_vertex, of_fragment] = [vertex, fragment].map(constants);
    let options = |constants| wgpu::PipelineCompilationOptions { constants, ..Default::default() };
    let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(label),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module: &modules[0],
            entry_point: Some(&vertex.function),
            compilation_options: options(&of_vertex),
            buffers: if geometry == Geometry::Surfaces { &VERTEX_BUFFERS } else { &[] },
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: target.depth.map(|format| depth_state(format, geometry, target)),
        multisample: wgpu::MultisampleState { count: target.samples, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module: &modules[1],
            entry_point: Some(&fragment.function),
            compilation_options: options(&of_fragment),
            targets: &targets,
        }),
        multiview_mask: None,
        cache: None,
    });
    found(faults, label).map(|()| pipeline)
}

/// The first fault since `faults` was opened, as one of the programs of a pass.
fn found(faults: wgpu::ErrorScopeGuard, label: &str) -> Result<(), Error> {
    match pollster::block_on(faults.pop()) {
        None => Ok(()),
        Some(error) => {
            let causes = std::iter::successors(Some(&error as &dyn std::error::Error), |error| {
                error.source()
            });
            let causes: Vec<String> =
                causes.map(|cause| cause.to_string().trim().to_owned()).collect();
            let reason = causes.last().cloned().unwrap_or_default();
            Err(TechniqueError::Programs { pass: label.to_owned(), reason }.into())
        }
    }
}

fn depth_state(
    format: wgpu::TextureFormat,
    geometry: Geometry,
    target: &PipelineTarget,
) -> wgpu::DepthStencilState {
    let is_surface = geometry == Geometry::Surfaces;
    let compare = match (is_surface, target.depth_use) {
        // A second pass over the same scene is not hidden by the first.
        (true, DepthUse::Nearest) => wgpu::CompareFunction::GreaterEqual,
        (true, DepthUse::Same) => wgpu::CompareFunction::Equal,
        (false, _) => wgpu::CompareFunction::Always,
    };
    let writes = is_surface && target.depth_use == DepthUse::Nearest;
    wgpu::DepthStencilState {
        format,
        depth_write_enabled: Some(writes || target.writes_depth),
        depth_compare: Some(compare),
        stencil: wgpu::StencilState::default(),
        bias: if is_surface && target.is_pushed {
            push_away()
        } else {
            wgpu::DepthBiasState::default()
        },
    }
}

/// The shader module of a program; loops are limited unless the program is built in.
fn program_module(program: &Program, device: &wgpu::Device, label: &str) -> wgpu::ShaderModule {
    let parsed = if program.is_bounded { program.source.reflect().ok() } else { None };
    let Some((mut module, _)) = parsed else {
        return shader_module(device, &program.source, label);
    };
    bound_loops(&mut module);
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Naga(Cow::Owned(module)),
    })
}
