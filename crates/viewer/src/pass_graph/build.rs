//! From a plan to steps with their pipelines and textures.
//!
//! A change is built beside the graph and then applied at once, so that a graph goes on
//! drawing as before if building fails. What the graph has is reused.

use std::cell::RefCell;

use strokes::{Gpu, MeshInstance, MeshOptions, TargetFormats, Targets, ViewState, frame_layout};

use super::bindings::{Samplers, Sources};
use super::builder::Builder;
use super::copy_pass::CopyPass;
use super::glass::GlassTargets;
use super::ping_pong::PingPong;
use super::pipeline_cache::PipelineCache;
use super::scene_buffers::SceneBuffers;
use super::scene_pass::ScenePass;
use super::screen_pass::ScreenPass;
use super::stroke_pass::{self, StrokeGroup, StrokeRenderers};
use super::surface::{SurfaceInput, Surfaces};
use super::textures::{GeneratedTexture, Images};
use super::{GraphInput, PassGraph, Schedule, Step, StepKind};
use crate::error::Error;
use crate::technique::Technique;
use crate::technique::core::CoreComponent;
use crate::technique::core_view::CoreView;
use crate::technique::pass::Pass;
use crate::technique::plan::{PassPlan, Plan, TexturePlan};

/// The difference between a graph and the one for another input.
#[derive(Debug)]
pub(crate) struct GraphChange {
    /// None to keep the framebuffer.
    framebuffer: Option<Targets>,
    /// None to keep those of the framebuffer.
    glass: Option<GlassTargets>,
    textures: Vec<TextureChange>,
    instances: Vec<MeshInstance>,
    surfaces: SurfacesChange,
    steps: Vec<Step>,
}

/// A texture of the changed graph.
#[derive(Debug)]
enum TextureChange {
    /// That of an index, with its content.
    Kept(usize),
    New(GeneratedTexture),
}

/// The surfaces of the changed graph.
#[derive(Debug)]
enum SurfacesChange {
    Kept,
    New(Surfaces),
    /// No pass draws surfaces.
    Dropped,
}

impl PassGraph {
    /// A graph without passes, whose picture is one transparent pixel.
    #[must_use]
    pub(crate) fn empty(gpu: &Gpu) -> Self {
        let device = &gpu.device;
        Self {
            framebuffer: Targets::new(device, [1; 2], TargetFormats::new(1)),
            view: ViewState::new(device),
            instances: Vec::new(),
            scene: SceneBuffers::default(),
            sources: Sources {
                generated: Vec::new(),
                images: Images::default(),
                samplers: Samplers::new(device),
            },
            surfaces: None,
            glass: None,
            strokes: StrokeRenderers::default(),
            steps: Vec::new(),
            pipelines: PipelineCache::default(),
        }
    }

    /// Builds the graph for an input.
    ///
    /// # Errors
    /// As [`Self::change`].
    pub(crate) fn new(gpu: &Gpu, input: &GraphInput) -> Result<Self, Error> {
        let mut graph = Self::empty(gpu);
        let change = graph.change(gpu, input)?;
        graph.apply(change);
        Ok(graph)
    }

    /// Builds what differs for another input with the same scene, layout, detection stage
    /// and overrides. The graph still draws as before; only its caches grow.
    ///
    /// # Errors
    /// If a mesh or texture is too large for the adapter, an image cannot be read, or the
    /// programs of a pass do not fit together.
    pub(crate) fn change(&mut self, gpu: &Gpu, input: &GraphInput) -> Result<GraphChange, Error> {
        let GraphInput { technique, plan, overrides, options, .. } = *input;
        let device = &gpu.device;
        let formats = match stroke_pass::needs_stencil(technique, overrides) {
            true => TargetFormats::with_stencil(device, options.samples),
            false => TargetFormats::new(options.samples),
        };
        self.sources.images.forget_changed();
        let groups = groups_of(technique, overrides);
        let strokes = self.stroke_groups_of(gpu, input, &groups, formats)?;
        let needs = MeshOptions {
            layout: options.layout,
            links: strokes.iter().flatten().any(StrokeGroup::is_linked),
            surface: has(&groups, technique, CoreComponent::SimpleRender),
            objects: 1,
        };
        let instances = self.scene.instances(gpu, input.scene, needs)?;
        self.view.resize(device, instances.len());
        let surfaces = self.surfaces_change(gpu, input, &instances, needs.surface);
        let is_same =
            self.framebuffer.size == options.size && *self.framebuffer.formats() == formats;
        let framebuffer = (!is_same).then(|| Targets::new(device, options.size, formats));
        let built = match &surfaces {
            SurfacesChange::New(surfaces) => Some(surfaces),
            SurfacesChange::Kept => self.surfaces.as_ref(),
            SurfacesChange::Dropped => None,
        };
        let glass = built
            .filter(|surfaces| surfaces.has_glass() && (!is_same || self.glass.is_none()))
            .map(|_| {
                let framebuffer = framebuffer.as_ref().unwrap_or(&self.framebuffer);
                GlassTargets::new(gpu, framebuffer, &self.view)
            })
            .transpose()?;
        let textures = self.texture_changes(device, plan, options.size);
        let pipelines = RefCell::new(std::mem::take(&mut self.pipelines));
        let frame = &frame_layout(device);
        let builder = Builder { gpu, input, formats, frame, pipelines };
        let steps = groups.iter().zip(strokes);
        let steps = steps.map(|(group, strokes)| builder.step(group, built, strokes));
        let steps: Result<Vec<Step>, Error> = steps.collect();
        self.pipelines = builder.pipelines.into_inner();
        Ok(GraphChange { framebuffer, glass, textures, instances, surfaces, steps: steps? })
    }

    /// Applies a change that was built from this graph.
    pub(crate) fn apply(&mut self, change: GraphChange) {
        let GraphChange { framebuffer, glass, textures, instances, surfaces, steps } = change;
        if let Some(framebuffer) = framebuffer {
            self.framebuffer = framebuffer;
        }
        if glass.is_some() {
            self.glass = glass;
        }
        self.instances = instances;
        match surfaces {
            SurfacesChange::Kept => {}
            SurfacesChange::New(surfaces) => self.surfaces = Some(surfaces),
            SurfacesChange::Dropped => self.surfaces = None,
        }
        let mut known: Vec<Option<GeneratedTexture>> =
            self.sources.generated.drain(..).map(Some).collect();
        let texture = |change| match change {
            TextureChange::New(texture) => Some(texture),
            TextureChange::Kept(at) => {
                let mut texture: GeneratedTexture = known[at].take()?;
                texture.is_kept = true;
                Some(texture)
            }
        };
        self.sources.generated = textures.into_iter().filter_map(texture).collect();
        let before = std::mem::replace(&mut self.steps, steps);
        self.continue_from(before);
        self.strokes.trim();
    }

    /// Takes over the results of the steps before, as far as they are up to date.
    fn continue_from(&mut self, before: Vec<Step>) {
        for step in &mut self.steps {
            // A step whose textures are kept need not run again.
            let mut written = step.plan.target.textures().into_iter();
            if written.all(|at| self.sources.generated[at].is_kept)
                && let Some(same) = before.iter().find(|known| known.name == step.name)
            {
                step.schedule.continue_from(&same.schedule);
            }
        }
        let groups = self.steps.iter_mut().filter_map(|step| match &mut step.kind {
            StepKind::Strokes(group) => Some(group),
            _ => None,
        });
        let before = before.into_iter().filter_map(|step| match step.kind {
            StepKind::Strokes(group) => Some(group),
            _ => None,
        });
        groups.zip(before).for_each(|(group, before)| group.continue_from(before));
    }

    /// The strokes of each group of passes; none for groups of other components.
    fn stroke_groups_of(
        &mut self,
        gpu: &Gpu,
        input: &GraphInput,
        groups: &[Vec<usize>],
        formats: TargetFormats,
    ) -> Result<Vec<Option<StrokeGroup>>, Error> {
        let strokes = |group: &Vec<usize>| {
            let passes = group.iter().map(|&at| &input.technique.passes[at]);
            let passes: Vec<&Pass> = passes.filter(|pass| pass.is_rendered()).collect();
            let core = input.technique.passes[group[0]].component.core;
            (core == CoreComponent::Strokes)
                .then(|| self.strokes.group(gpu, input, &passes, formats))
                .transpose()
        };
        groups.iter().map(strokes).collect()
    }

    /// The surfaces of a technique that draws them, or not.
    fn surfaces_change(
        &mut self,
        gpu: &Gpu,
        input: &GraphInput,
        instances: &[MeshInstance],
        are_drawn: bool,
    ) -> SurfacesChange {
        match (are_drawn, &self.surfaces) {
            (false, _) => SurfacesChange::Dropped,
            (true, Some(_)) => SurfacesChange::Kept,
            (true, None) => {
                let Sources { images, samplers, .. } = &mut self.sources;
                let (scene, view, sampler) = (input.scene, &self.view, &samplers.linear_image);
                let input = SurfaceInput { gpu, scene, instances, view, sampler };
                SurfacesChange::New(Surfaces::new(&input, images))
            }
        }
    }

    /// The textures that passes of `plan` write: those of the graph with the same name, size
    /// and format, and new ones.
    fn texture_changes(
        &self,
        device: &wgpu::Device,
        plan: &Plan,
        picture: [u32; 2],
    ) -> Vec<TextureChange> {
        let is_in_place = |texture: usize| {
            let writes = |pass: &PassPlan| pass.target.textures().contains(&texture);
            plan.passes.iter().any(|pass| pass.is_in_place && writes(pass))
        };
        let change = |(at, texture): (usize, &TexturePlan)| {
            let is_double = is_in_place(at);
            let is_same = |known: &GeneratedTexture| known.is_for(texture, picture, is_double);
            match self.sources.generated.iter().position(is_same) {
                Some(known) => TextureChange::Kept(known),
                None => {
                    TextureChange::New(GeneratedTexture::new(device, texture, picture, is_double))
                }
            }
        };
        plan.textures.iter().enumerate().map(change).collect()
    }
}

/// Whether any group is of a core component.
fn has(groups: &[Vec<usize>], technique: &Technique, core: CoreComponent) -> bool {
    groups.iter().any(|group| technique.passes[group[0]].component.core == core)
}

/// The indices of the passes that are drawn for the scene or for an object with an
/// override; consecutive passes of strokes are one group.
fn groups_of(technique: &Technique, overrides: &[Technique]) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    let is_stroke = |at: usize| technique.passes[at].component.core == CoreComponent::Strokes;
    let own_strokes = overrides
        .iter()
        .flat_map(|technique| &technique.passes)
        .any(|pass| pass.is_rendered() && pass.component.core == CoreComponent::Strokes);
    for (at, pass) in technique.passes.iter().enumerate() {
        let is_rendered =
            |technique: &Technique| technique.pass(&pass.name).is_some_and(Pass::is_rendered);
        let is_drawn = pass.is_rendered()
            || match pass.component.core {
                CoreComponent::Strokes => own_strokes,
                CoreComponent::SimpleRender => overrides.iter().any(is_rendered),
                _ => false,
            };
        match groups.last_mut() {
            _ if !is_drawn => {}
            Some(last) if is_stroke(at) && is_stroke(last[0]) => last.push(at),
            _ => groups.push(vec![at]),
        }
    }
    groups
}

impl Builder<'_> {
    fn step(
        &self,
        group: &[usize],
        surfaces: Option<&Surfaces>,
        strokes: Option<StrokeGroup>,
    ) -> Result<Step, Error> {
        let pass = &self.input.technique.passes[group[0]];
        let plan = &self.input.plan.passes[group[0]];
        let kind = match (&plan.core, surfaces, strokes) {
            (_, _, Some(strokes)) => StepKind::Strokes(strokes),
            (CoreView::SimpleRender(view), Some(surfaces), _) => {
                StepKind::Scene(ScenePass::new(self, pass, plan, view, surfaces)?)
            }
            (CoreView::CopyToTexture(view), ..) => {
                StepKind::Copy(CopyPass::new(self.gpu, view, &self.formats)?)
            }
            (CoreView::PingPong(view), ..) => {
                StepKind::PingPong(PingPong::new(self, pass, plan, view)?)
            }
            _ => StepKind::Screen(ScreenPass::new(self, pass, plan)?),
        };
        let schedule = Schedule::new(pass, plan);
        Ok(Step { name: pass.name.clone(), kind, plan: plan.clone(), schedule })
    }
}
