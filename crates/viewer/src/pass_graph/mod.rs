//! Techniques on the GPU: the pipelines and textures of the passes of a plan, encoded in
//! order to one command buffer per frame.
//!
//! ```text
//!   Plan, Technique --build--> steps --encode--> framebuffer --> picture
//!                                ^   |
//!            surfaces, meshes ---+   +--> generated textures, kept from frame to frame
//! ```
//!
//! Mistakes in a technique are found by its plan; only programs that do not fit together are
//! found here.
//!
//! - `scene_pass`, `screen_pass`, `ping_pong`, `copy_pass`, `stroke_pass`: the core
//!   components (thesis, section 2.3); `docs/techniques.md` lists the steps to add one.
//! - `surface`, `material`, `textures`: surfaces and textures of passes; `glass`: transparent
//!   surfaces.
//! - `bindings`, `params`, `pipeline`, `blend`: parameters, textures and targets of
//!   programs; `pipeline_cache`: pipelines built before.
//! - `build`: builds a graph from a plan, and reuses an earlier graph; `builder`: the shared
//!   input of all passes.

mod bindings;
mod blend;
mod build;
mod builder;
mod copy_pass;
mod glass;
pub(crate) mod material;
mod params;
mod ping_pong;
mod pipeline;
mod pipeline_cache;
mod scene_buffers;
mod scene_pass;
mod screen_pass;
mod stroke_pass;
mod stroke_style;
pub(crate) mod surface;
pub(crate) mod textures;

use edgemesh::view::View;
use strokes::{
    DetectionStage, Drawing, DrawingStyle, FrameUniform, Gpu, Layout, MeshInstance, PASS_NAMES,
    Surroundings, Tally, Targets, Tile, TimedPasses, ViewState,
};

use self::bindings::Sources;
use self::copy_pass::CopyPass;
use self::glass::GlassTargets;
pub use self::material::MaterialUniform;
use self::ping_pong::PingPong;
use self::pipeline_cache::PipelineCache;
use self::scene_buffers::SceneBuffers;
use self::scene_pass::ScenePass;
use self::screen_pass::ScreenPass;
use self::stroke_pass::{StrokeGroup, StrokeRenderers};
pub use self::surface::SurfaceRange;
use self::surface::Surfaces;
use crate::error::Error;
use crate::scene::models::Scene;
use crate::technique::Technique;
use crate::technique::core::CoreComponent;
use crate::technique::core_view::RunMode;
use crate::technique::pass::Pass;
use crate::technique::plan::{PassPlan, Plan};
use crate::technique::value::Value;

/// The scene and the technique of a graph.
#[derive(Debug, Clone, Copy)]
pub(crate) struct GraphInput<'a> {
    /// The objects.
    pub(crate) scene: &'a Scene,
    /// The technique of the scene.
    pub(crate) technique: &'a Technique,
    /// The plan of the technique.
    pub(crate) plan: &'a Plan,
    /// Techniques of objects, by `PlacedObject::override_index`: the values of their
    /// passes replace those of passes with the same name and component, and their passes
    /// of strokes replace all passes of strokes.
    pub(crate) overrides: &'a [Technique],
    /// Options that do not depend on the technique.
    pub(crate) options: &'a GraphOptions,
}

/// Options that do not depend on the technique.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct GraphOptions {
    /// Width and height of the picture in pixels.
    pub(crate) size: [u32; 2],
    /// Samples per pixel, 1 or 4.
    pub(crate) samples: u32,
    /// Memory layout of the edges.
    pub(crate) layout: Layout,
    /// The detection stage.
    pub(crate) stage: DetectionStage,
    /// Whether the background is transparent.
    pub(crate) is_transparent: bool,
    /// Whether there are clip planes; without them surfaces are drawn faster.
    pub(crate) clips: bool,
}

/// A technique and a scene on the GPU.
#[derive(Debug)]
pub(crate) struct PassGraph {
    framebuffer: Targets,
    /// The eye.
    view: ViewState,
    /// The objects of the scene.
    instances: Vec<MeshInstance>,
    scene: SceneBuffers,
    sources: Sources,
    surfaces: Option<Surfaces>,
    /// If any surface is transparent.
    glass: Option<GlassTargets>,
    strokes: StrokeRenderers,
    steps: Vec<Step>,
    pipelines: PipelineCache,
}

/// A pass, or consecutive passes of strokes.
#[derive(Debug)]
struct Step {
    /// The name of the first pass, for timings.
    name: String,
    kind: StepKind,
    plan: PassPlan,
    schedule: Schedule,
}

#[derive(Debug)]
enum StepKind {
    Scene(ScenePass),
    Screen(ScreenPass),
    PingPong(PingPong),
    Copy(CopyPass),
    Strokes(StrokeGroup),
}

/// In which frames a step runs.
#[derive(Debug)]
struct Schedule {
    mode: RunMode,
    key: ScheduleKey,
    /// Whether its textures are up to date.
    is_done: bool,
}

/// What the output of a step with [`RunMode::Changed`] depends on.
#[derive(Debug, PartialEq)]
struct ScheduleKey {
    values: Vec<Value>,
    /// The text of the fragment program; empty if there is none.
    program: String,
}

/// The input of a frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FrameInput<'a> {
    /// The view of the whole picture.
    pub(crate) view: &'a View,
    /// Light and clip planes.
    pub(crate) around: &'a Surroundings,
    /// The tile that is drawn; none for the whole picture.
    pub(crate) tile: Option<TileInput<'a>>,
}

/// A tile of a picture that is too large for a texture.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TileInput<'a> {
    /// The tile.
    pub(crate) tile: Tile,
    /// The whole picture in a smaller size, whose depth decides where linked strokes are
    /// hidden.
    pub(crate) overview: Option<&'a Targets>,
}

/// State that steps share while a frame is encoded.
struct Encoding<'a> {
    gpu: &'a Gpu,
    framebuffer: &'a Targets,
    /// The eye, set for `instances`.
    view: &'a ViewState,
    instances: &'a [MeshInstance],
    surfaces: Option<&'a Surfaces>,
    glass: Option<&'a GlassTargets>,
    /// Whether the depth of transparent surfaces is that of the frame.
    has_glass_depth: bool,
    overview: Option<&'a Targets>,
    /// Whether nothing was drawn to the framebuffer in this frame yet.
    is_fresh: bool,
    /// Whether the framebuffer's depth is that of the scene.
    has_depth: bool,
}

impl PassGraph {
    /// The picture of the last submitted frame.
    #[must_use]
    pub(crate) const fn picture(&self) -> &wgpu::Texture {
        self.framebuffer.picture()
    }

    /// The texture `<generated>:name`.
    #[must_use]
    pub(crate) fn generated(&self, plan: &Plan, name: &str) -> Option<&wgpu::Texture> {
        let at = plan.textures.iter().position(|texture| texture.name == name)?;
        Some(self.sources.generated.get(at)?.read_texture())
    }

    /// The names of all timings, in order.
    #[must_use]
    pub(crate) fn time_names(&self) -> Vec<String> {
        let mut names = Vec::new();
        for step in &self.steps {
            match step.kind {
                StepKind::Strokes(_) => {
                    names.extend(PASS_NAMES.map(|name| format!("{}.{name}", step.name)));
                }
                _ => names.push(step.name.clone()),
            }
        }
        names
    }

    /// The groups of strokes.
    pub(crate) fn stroke_groups(&self) -> impl Iterator<Item = &StrokeGroup> {
        self.steps.iter().filter_map(|step| match &step.kind {
            StepKind::Strokes(group) => Some(group),
            _ => None,
        })
    }

    /// The counts of the last frame; none if vertex shaders detect, or no strokes are drawn.
    ///
    /// # Errors
    /// If the device is lost.
    pub(crate) fn tally(&self, gpu: &Gpu) -> Result<Option<Tally>, strokes::ReadbackError> {
        self.counted().map(|drawing| drawing.read_tally(gpu)).transpose()
    }

    /// The drawing whose strokes are counted; `None` if none are, or if it has no objects.
    pub(crate) fn counted(&self) -> Option<&Drawing> {
        let group = self.stroke_groups().next().filter(|group| !group.counts_nothing());
        group.map(|group| &group.drawing).filter(|drawing| !drawing.objects().is_empty())
    }

    /// The picture with its depth.
    #[must_use]
    pub(crate) const fn framebuffer(&self) -> &Targets {
        &self.framebuffer
    }

    /// Clears the textures of `plan`, the plan of this graph, so that the next frame is
    /// drawn as the first one.
    pub(crate) fn forget_frames(&mut self, device: &wgpu::Device, plan: &Plan) {
        for (texture, plan) in self.sources.generated.iter_mut().zip(&plan.textures) {
            texture.renew(device, plan, self.framebuffer.size);
        }
        for step in &mut self.steps {
            step.schedule.is_done = false;
        }
    }

    /// Changes the size of the picture. Only textures whose size depends on it are made
    /// again; `plan` is the plan of this graph.
    ///
    /// # Errors
    /// If a built-in shader has a mistake.
    pub(crate) fn resize(&mut self, gpu: &Gpu, plan: &Plan, size: [u32; 2]) -> Result<(), Error> {
        let device = &gpu.device;
        let formats = *self.framebuffer.formats();
        self.framebuffer = Targets::new(device, size, formats);
        if self.glass.is_some() {
            self.glass = Some(GlassTargets::new(gpu, &self.framebuffer, &self.view)?);
        }
        let mut is_new = Vec::with_capacity(plan.textures.len());
        for (texture, plan) in self.sources.generated.iter_mut().zip(&plan.textures) {
            is_new.push(!texture.is_for(plan, size, texture.is_double()));
            if is_new.last() == Some(&true) {
                texture.renew(device, plan, size);
            }
        }
        for step in &mut self.steps {
            let mut written = step.plan.target.textures().into_iter();
            step.schedule.is_done &= !written.any(|at| is_new[at]);
            if let StepKind::PingPong(pass) = &mut step.kind {
                pass.resize(device, size);
            }
        }
        Ok(())
    }

    /// Encodes a frame, to be submitted before the next one is encoded.
    ///
    /// # Errors
    /// If an image cannot be read.
    pub(crate) fn encode(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        input: &FrameInput,
        timer: Option<TimedPasses>,
    ) -> Result<(), Error> {
        let FrameInput { view, around, tile } = *input;
        let whole = || Tile::whole(self.framebuffer.viewport_px());
        let uniform = FrameUniform::new(view, &tile.map_or_else(whole, |of| of.tile), around);
        self.view.set(gpu, view, &uniform, &self.instances);
        let mut encoding = Encoding {
            gpu,
            framebuffer: &self.framebuffer,
            view: &self.view,
            instances: &self.instances,
            surfaces: self.surfaces.as_ref(),
            glass: self.glass.as_ref(),
            has_glass_depth: false,
            overview: tile.and_then(|input| input.overview),
            is_fresh: true,
            has_depth: false,
        };
        let mut timed = 0;
        for step in &mut self.steps {
            let timer = timer.map(|timer| timer.from(timed));
            timed += match step.kind {
                StepKind::Strokes(_) => edgemesh::index::to_u32(PASS_NAMES.len()),
                _ => 1,
            };
            if step.schedule.is_due() {
                let strokes = &mut self.strokes;
                step.encode(encoder, &mut encoding, &mut self.sources, strokes, timer)?;
            } else {
                screen_pass::skip(encoder, timer);
            }
        }
        resolve(encoder, &self.framebuffer, encoding.is_fresh);
        Ok(())
    }
}

/// Averages the samples of the framebuffer to the picture.
fn resolve(encoder: &mut wgpu::CommandEncoder, framebuffer: &Targets, is_fresh: bool) {
    let load = match is_fresh {
        true => wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
        false => wgpu::LoadOp::Load,
    };
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("resolve"),
        color_attachments: &[Some(framebuffer.color_attachment(load, true))],
        ..Default::default()
    });
}

/// The drawing style of all passes of strokes of a technique, for a mesh in `frame` with
/// the crease thresholds `built`, in radians, for ridges and valleys.
///
/// # Errors
/// If a brush or a variable cannot be read.
pub fn strokes_of(
    technique: &Technique,
    frame: &edgemesh::edge_mesh::MeshFrame,
    built: [f64; 2],
) -> Result<DrawingStyle, Error> {
    let is_drawn =
        |pass: &&Pass| pass.is_rendered() && pass.component.core == CoreComponent::Strokes;
    let passes: Vec<&Pass> = technique.passes.iter().filter(is_drawn).collect();
    stroke_style::style_of_passes(&passes, &technique.folders, frame, built)
}

impl Schedule {
    fn new(pass: &Pass, plan: &PassPlan) -> Self {
        let program = plan.programs.fragment.as_ref().map(|program| program.source.text.clone());
        let key =
            ScheduleKey { values: pass.values().to_vec(), program: program.unwrap_or_default() };
        Self { mode: plan.run, key, is_done: false }
    }

    /// Whether the step runs in the next frame.
    fn is_due(&self) -> bool {
        self.mode == RunMode::Always || !self.is_done
    }

    /// Continues the schedule of the same step in the graph before.
    fn continue_from(&mut self, before: &Self) {
        let is_same = self.mode == RunMode::Once || self.key == before.key;
        self.is_done = before.is_done && is_same;
    }
}

impl Step {
    fn encode(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        encoding: &mut Encoding,
        sources: &mut Sources,
        strokes: &mut StrokeRenderers,
        timer: Option<TimedPasses>,
    ) -> Result<(), Error> {
        match &mut self.kind {
            StepKind::Scene(pass) => pass.encode(encoder, encoding, &self.plan, sources, timer)?,
            StepKind::Screen(pass) => pass.encode(encoder, encoding, &self.plan, sources, timer)?,
            StepKind::PingPong(pass) => {
                pass.encode(encoder, encoding, &self.plan, sources, timer)?;
            }
            StepKind::Copy(pass) => pass.encode(encoder, encoding, &self.plan, sources, timer),
            StepKind::Strokes(group) => {
                strokes.encode(encoder, encoding, group, timer)?;
            }
        }
        if self.plan.is_in_place {
            for texture in self.plan.target.textures() {
                sources.generated[texture].swap();
            }
        }
        self.schedule.is_done = true;
        Ok(())
    }
}

impl Encoding<'_> {
    /// How the framebuffer's color is loaded: cleared if nothing was drawn yet.
    const fn load(&self) -> wgpu::LoadOp<wgpu::Color> {
        match self.is_fresh {
            true => wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
            false => wgpu::LoadOp::Load,
        }
    }
}
