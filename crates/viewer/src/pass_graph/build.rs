//! From a plan to steps with their pipelines and textures; what a graph before has that
//! is still good is taken over.

use std::cell::RefCell;

use strokes::draw::targets::Targets;
use strokes::gpu::device::Gpu;
use strokes::gpu::target_formats::TargetFormats;
use strokes::mesh::MeshOptions;
use strokes::view::frame::frame_layout;
use strokes::view::view_state::ViewState;

use super::bindings::{Samplers, Sources};
use super::copy_pass::CopyPass;
use super::ping_pong::PingPong;
use super::pipeline::{Geometry, PassPipeline, PipelineTarget, Programs};
use super::pipeline_cache::PipelineCache;
use super::scene_buffers::SceneBuffers;
use super::scene_pass::ScenePass;
use super::screen_pass::ScreenPass;
use super::stroke_pass::{self, StrokeGroup, StrokePasses, StrokeStore};
use super::surface::{SurfaceInput, Surfaces};
use super::textures::{GeneratedTexture, Images};
use super::{GraphOptions, PassGraph, Run, Step, StepKind, blend};
use crate::error::Error;
use crate::scene::models::Scene;
use crate::technique::Technique;
use crate::technique::core::CoreComponent;
use crate::technique::pass::Pass;
use crate::technique::plan::{PassPlan, Plan, Target, TexturePlan};

impl PassGraph {
    /// Builds the graph of `technique`, whose plan is `plan`. Objects of the scene whose
    /// look has a number in `looks` take the values of their passes from there.
    ///
    /// # Errors
    /// Where a mesh or texture is too large for the adapter, an image cannot be read, or
    /// programs do not fit together.
    pub fn new(
        gpu: &Gpu,
        scene: &Scene,
        technique: &Technique,
        plan: &Plan,
        looks: &[Technique],
        options: &GraphOptions,
    ) -> Result<Self, Error> {
        Self::build(gpu, (scene, options), (technique, plan, looks), None)
    }

    /// As [`Self::new`], taking from `before`, a graph of the same scene, options and
    /// looks, what is still good: surfaces, meshes, pipelines, images, and textures with what
    /// is in them.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn rebuilt(
        self,
        gpu: &Gpu,
        scene: &Scene,
        technique: &Technique,
        plan: &Plan,
        looks: &[Technique],
        options: &GraphOptions,
    ) -> Result<Self, Error> {
        Self::build(gpu, (scene, options), (technique, plan, looks), Some(self))
    }

    fn build(
        gpu: &Gpu,
        (scene, options): (&Scene, &GraphOptions),
        (technique, plan, looks): (&Technique, &Plan, &[Technique]),
        before: Option<Self>,
    ) -> Result<Self, Error> {
        let device = &gpu.device;
        let groups = groups_of(technique, looks);
        let formats = match stroke_pass::needs_stencil(technique, looks) {
            true => TargetFormats::with_stencil(device, options.samples),
            false => TargetFormats::new(options.samples),
        };
        let mut before = before.map_or_else(Before::default, Before::of);
        let framebuffer = before.framebuffer(device, options.size, formats);
        let mut sources = Sources {
            generated: before.generated(device, plan, options.size),
            images: std::mem::take(&mut before.images),
            samplers: before.samplers.take().unwrap_or_else(|| Samplers::new(device)),
        };
        let has =
            |core| groups.iter().any(|group| technique.passes[group[0]].component.core == core);
        let mut strokes = None;
        if has(CoreComponent::Strokes) {
            let (folders, store) = (&technique.folders, &mut before.stroke_store);
            strokes = Some(StrokePasses::new(gpu, options, formats, folders, store)?);
        } else {
            before.stroke_store.forget_drawings();
        }
        let pipelines = RefCell::new(std::mem::take(&mut before.pipelines));
        let builder = Builder { gpu, scene, technique, plan, looks, options, formats, pipelines };
        let mut stroke_groups = Vec::new();
        for group in &groups {
            stroke_groups.push(builder.stroke_group(group, strokes.as_mut())?);
        }
        let needs = MeshOptions {
            layout: options.layout,
            links: stroke_groups.iter().flatten().any(StrokeGroup::is_linked),
            surface: has(CoreComponent::SimpleRender),
        };
        let instances = before.scene.instances(gpu, scene, needs)?;
        let mut view = before.view.take().unwrap_or_else(|| ViewState::new(device));
        view.resize(device, instances.len());
        let surfaces = match (needs.surface, before.surfaces.take()) {
            (false, _) => None,
            (true, Some(surfaces)) => Some(surfaces),
            (true, None) => {
                let sampler = &sources.samplers.linear_image.clone();
                let input =
                    SurfaceInput { gpu, scene, instances: &instances, view: &view, sampler };
                Some(Surfaces::new(&input, &mut sources.images))
            }
        };
        let layout = frame_layout(device);
        let mut steps = Vec::new();
        for (group, stroke_group) in groups.iter().zip(stroke_groups) {
            let mut step = builder.step(group, &layout, surfaces.as_ref(), stroke_group)?;
            before.go_on(&mut step, &sources.generated);
            steps.push(step);
        }
        Ok(Self {
            framebuffer,
            view,
            instances,
            scene: before.scene,
            sources,
            surfaces,
            strokes,
            stroke_store: before.stroke_store,
            steps,
            pipelines: builder.pipelines.into_inner(),
        })
    }
}

/// What a graph leaves to the one that comes after it.
#[derive(Default)]
struct Before {
    framebuffer: Option<Targets>,
    view: Option<ViewState>,
    scene: SceneBuffers,
    surfaces: Option<Surfaces>,
    stroke_store: StrokeStore,
    images: Images,
    samplers: Option<Samplers>,
    pipelines: PipelineCache,
    textures: Vec<GeneratedTexture>,
    runs: Vec<(String, Run)>,
}

impl Before {
    fn of(graph: PassGraph) -> Self {
        let mut images = graph.sources.images;
        images.forget_changed();
        let mut stroke_store = graph.stroke_store;
        let (mut drawings, mut runs) = (Vec::new(), Vec::new());
        for step in graph.steps {
            runs.push((step.name, step.run));
            if let StepKind::Strokes(group) = step.kind {
                drawings.push(group.drawing);
            }
        }
        if let Some(strokes) = graph.strokes {
            strokes.put_back(drawings, &mut stroke_store);
        }
        Self {
            framebuffer: Some(graph.framebuffer),
            view: Some(graph.view),
            scene: graph.scene,
            surfaces: graph.surfaces,
            stroke_store,
            images,
            samplers: Some(graph.sources.samplers),
            pipelines: graph.pipelines,
            textures: graph.sources.generated,
            runs,
        }
    }

    /// The framebuffer, where it is of that size and format.
    fn framebuffer(
        &mut self,
        device: &wgpu::Device,
        size: [u32; 2],
        formats: TargetFormats,
    ) -> Targets {
        let known = self.framebuffer.take();
        known
            .filter(|known| known.size == size && *known.formats() == formats)
            .unwrap_or_else(|| Targets::new(device, size, formats))
    }

    /// The textures that passes write, each that of before where it is the same.
    fn generated(
        &mut self,
        device: &wgpu::Device,
        plan: &Plan,
        picture: [u32; 2],
    ) -> Vec<GeneratedTexture> {
        let is_in_place = |texture: usize| {
            let writes = |pass: &PassPlan| pass.target.textures().contains(&texture);
            plan.passes.iter().any(|pass| pass.is_in_place && writes(pass))
        };
        let texture = |(at, texture): (usize, &TexturePlan)| {
            let is_double = is_in_place(at);
            self.texture(texture, picture, is_double)
                .unwrap_or_else(|| GeneratedTexture::new(device, texture, picture, is_double))
        };
        plan.textures.iter().enumerate().map(texture).collect()
    }

    /// A step whose textures are those of before need not be done again.
    fn go_on(&self, step: &mut Step, textures: &[GeneratedTexture]) {
        let mut written = step.plan.target.textures().into_iter();
        let same = self.runs.iter().find(|(name, _)| *name == step.name);
        if let Some((_, run)) = same.filter(|_| written.all(|at| textures[at].is_kept)) {
            step.run.go_on_from(run);
        }
    }

    /// A texture of the same name, size and format, with what is in it.
    fn texture(
        &mut self,
        plan: &TexturePlan,
        picture: [u32; 2],
        is_double: bool,
    ) -> Option<GeneratedTexture> {
        let is_same = |known: &GeneratedTexture| known.is_for(plan, picture, is_double);
        let at = self.textures.iter().position(is_same)?;
        let mut texture = self.textures.swap_remove(at);
        texture.is_kept = true;
        Some(texture)
    }
}

/// The passes that are done, for the scene or for an object with a look of its own;
/// those of strokes that follow each other together.
fn groups_of(technique: &Technique, looks: &[Technique]) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    let is_stroke = |at: usize| technique.passes[at].component.core == CoreComponent::Strokes;
    let own_strokes = looks
        .iter()
        .flat_map(|look| &look.passes)
        .any(|pass| pass.is_rendered() && pass.component.core == CoreComponent::Strokes);
    for (at, pass) in technique.passes.iter().enumerate() {
        let of_look = |look: &Technique| look.pass(&pass.name).is_some_and(Pass::is_rendered);
        let is_done = pass.is_rendered()
            || match pass.component.core {
                CoreComponent::Strokes => own_strokes,
                CoreComponent::SimpleRender => looks.iter().any(of_look),
                _ => false,
            };
        match groups.last_mut() {
            _ if !is_done => {}
            Some(last) if is_stroke(at) && is_stroke(last[0]) => last.push(at),
            _ => groups.push(vec![at]),
        }
    }
    groups
}

/// Builds steps.
pub(super) struct Builder<'a> {
    pub(super) gpu: &'a Gpu,
    pub(super) scene: &'a Scene,
    technique: &'a Technique,
    plan: &'a Plan,
    pub(super) looks: &'a [Technique],
    pub(super) options: &'a GraphOptions,
    pub(super) formats: TargetFormats,
    pipelines: RefCell<PipelineCache>,
}

impl Builder<'_> {
    /// A pipeline, built where it was not built before.
    pub(super) fn pipeline(
        &self,
        layouts: (&wgpu::BindGroupLayout, &wgpu::BindGroupLayout),
        programs: Programs,
        geometry: Geometry,
        target: &PipelineTarget,
    ) -> Result<PassPipeline, Error> {
        let mut pipelines = self.pipelines.borrow_mut();
        pipelines.pipeline(self.gpu, layouts, programs, geometry, target)
    }

    /// The stroke group of some passes; `None` for passes of another component.
    fn stroke_group(
        &self,
        group: &[usize],
        strokes: Option<&mut StrokePasses>,
    ) -> Result<Option<StrokeGroup>, Error> {
        let core = self.technique.passes[group[0]].component.core;
        let strokes = strokes.filter(|_| core == CoreComponent::Strokes);
        let passes = group.iter().map(|&at| &self.technique.passes[at]);
        let passes: Vec<&Pass> = passes.filter(|pass| pass.is_rendered()).collect();
        strokes.map(|strokes| strokes.group(self.gpu, self.scene, &passes, self.looks)).transpose()
    }

    fn step(
        &self,
        group: &[usize],
        frame: &wgpu::BindGroupLayout,
        surfaces: Option<&Surfaces>,
        strokes: Option<StrokeGroup>,
    ) -> Result<Step, Error> {
        let pass = &self.technique.passes[group[0]];
        let plan = &self.plan.passes[group[0]];
        let kind = match (pass.component.core, surfaces, strokes) {
            (_, _, Some(strokes)) => StepKind::Strokes(strokes),
            (CoreComponent::SimpleRender, Some(surfaces), _) => {
                StepKind::Scene(ScenePass::new(self, pass, plan, frame, surfaces)?)
            }
            (CoreComponent::CopyToTexture, ..) => {
                StepKind::Copy(CopyPass::new(self.gpu, pass, &self.formats)?)
            }
            (CoreComponent::PingPong, ..) => {
                StepKind::PingPong(PingPong::new(self, pass, plan, frame)?)
            }
            _ => StepKind::Screen(ScreenPass::new(self, pass, plan, frame)?),
        };
        let run = Run::of(pass, plan);
        Ok(Step { name: pass.name.clone(), kind, plan: plan.clone(), run })
    }

    /// Formats and blending of what a pass draws into.
    pub(super) fn target(&self, pass: &Pass, plan: &PassPlan) -> PipelineTarget {
        let blend = blend::blend_state(pass.string("blend"));
        match &plan.target {
            Target::Framebuffer => {
                PipelineTarget::framebuffer(&self.formats, blend, self.options.clips)
            }
            Target::Textures { colors, depth } => PipelineTarget {
                colors: colors.iter().map(|&at| self.plan.textures[at].format).collect(),
                depth: depth.map(|at| self.plan.textures[at].format),
                samples: 1,
                blend,
                is_pushed: false,
                writes_depth: false,
                clips: self.options.clips,
            },
        }
    }
}
