//! Techniques on the GPU: each pass of the plan as pipelines and textures, done in
//! order, one command buffer a frame.
//!
//! ```text
//!   Plan, Technique --build--> steps --encode--> framebuffer --> picture
//!                                ^   |
//!            surfaces, meshes ---+   +--> generated textures, kept from frame to frame
//! ```
//!
//! Only this module knows wgpu; what can be wrong with a technique was found before.
//!
//! - `scene_pass`, `screen_pass`, `ping_pong`, `copy_pass`, `stroke_pass`: the core
//!   components. Who adds one: a variant of `CoreComponent`, its descriptor in
//!   `techniques/components/core.toml`, a file here, a step below (thesis, section 2.3).
//! - `surface`, `material`, `textures`: what they draw and read.
//! - `bindings`, `params`, `pipeline`, `blend`: how programs are given what they want;
//!   `pipeline_cache`: what was built before.

mod bindings;
mod blend;
mod build;
mod copy_pass;
pub mod material;
mod params;
mod ping_pong;
mod pipeline;
mod pipeline_cache;
mod scene_buffers;
mod scene_pass;
mod screen_pass;
mod stroke_pass;
mod stroke_style;
pub mod surface;
pub(crate) mod textures;

use edgemesh::view::camera::View;
use strokes::draw::targets::Targets;
use strokes::gpu::device::Gpu;
use strokes::gpu::timer::TimedPasses;
use strokes::mesh::MeshInstance;
use strokes::mesh::layout::Layout;
use strokes::render::drawing::DrawnObject;
use strokes::render::frame_request::PASS_NAMES;
use strokes::render::pipelines::DetectionStage;
use strokes::style::drawing_style::DrawingStyle;
use strokes::view::frame::{FrameUniform, Surroundings};
use strokes::view::live_lists::Tally;
use strokes::view::tile::Tile;
use strokes::view::view_state::ViewState;

use self::bindings::Sources;
use self::copy_pass::CopyPass;
use self::ping_pong::PingPong;
use self::pipeline_cache::PipelineCache;
use self::scene_buffers::SceneBuffers;
use self::scene_pass::ScenePass;
use self::screen_pass::ScreenPass;
use self::stroke_pass::{StrokeGroup, StrokePasses, StrokeStore};
use self::surface::Surfaces;
use crate::error::Error;
use crate::technique::Technique;
use crate::technique::core::CoreComponent;
use crate::technique::pass::Pass;
use crate::technique::plan::{PassPlan, Plan};
use crate::technique::value::Value;

/// How a technique is drawn, whatever it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct GraphOptions {
    /// Width and height of the picture in pixels.
    pub size: [u32; 2],
    /// Samples a pixel, 1 or 4.
    pub samples: u32,
    /// How the edges lie in memory.
    pub layout: Layout,
    /// Where features are detected.
    pub stage: DetectionStage,
    /// Whether there is no paper behind the scene.
    pub is_transparent: bool,
    /// Whether there can be clip planes; without them surfaces are drawn faster.
    pub clips: bool,
}

/// A technique and a scene, ready to be drawn.
#[derive(Debug)]
pub struct PassGraph {
    framebuffer: Targets,
    /// The eye.
    view: ViewState,
    /// The objects of the scene.
    instances: Vec<MeshInstance>,
    scene: SceneBuffers,
    sources: Sources,
    surfaces: Option<Surfaces>,
    strokes: Option<StrokePasses>,
    stroke_store: StrokeStore,
    steps: Vec<Step>,
    pipelines: PipelineCache,
}

/// One or several passes, done at once.
#[derive(Debug)]
struct Step {
    /// Its name among the times.
    name: String,
    kind: StepKind,
    plan: PassPlan,
    run: Run,
}

#[derive(Debug)]
enum StepKind {
    Scene(ScenePass),
    Screen(ScreenPass),
    PingPong(PingPong),
    Copy(CopyPass),
    Strokes(StrokeGroup),
}

/// When a step is done.
#[derive(Debug)]
struct Run {
    when: When,
    /// The values of the pass and the text of its program.
    key: (Vec<Value>, String),
    /// Whether what it makes is there.
    is_done: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum When {
    Always,
    Once,
    /// Where a variable or the program has changed.
    Changed,
}

/// What a frame sees.
#[derive(Debug, Clone, Copy)]
pub struct Seen<'a> {
    /// Who sees the whole picture.
    pub view: &'a View,
    /// Light and what cuts the scene.
    pub around: &'a Surroundings,
    /// Which part of the picture is drawn, where it is not the whole.
    pub part: Option<PartOf<'a>>,
}

/// A part of a picture that is too large to be drawn at once.
#[derive(Debug, Clone, Copy)]
pub struct PartOf<'a> {
    /// The part.
    pub part: Tile,
    /// The whole picture, smaller, whose depth tells where linked strokes are seen.
    pub overview: Option<&'a Targets>,
}

/// What steps share while a frame is encoded.
struct Encoding<'a> {
    gpu: &'a Gpu,
    framebuffer: &'a Targets,
    /// The eye, set for `instances`.
    view: &'a ViewState,
    instances: &'a [MeshInstance],
    surfaces: Option<&'a Surfaces>,
    overview: Option<&'a Targets>,
    /// Whether nothing was drawn to the framebuffer yet.
    is_fresh: bool,
    /// Whether the framebuffer's depth is that of the scene.
    has_depth: bool,
}

impl PassGraph {
    /// The picture, once a frame was encoded and submitted.
    #[must_use]
    pub const fn picture(&self) -> &wgpu::Texture {
        self.framebuffer.picture()
    }

    /// The texture that passes call `<generated>:name`.
    #[must_use]
    pub fn generated(&self, plan: &Plan, name: &str) -> Option<&wgpu::Texture> {
        let at = plan.textures.iter().position(|texture| texture.name == name)?;
        Some(self.sources.generated.get(at)?.read_texture())
    }

    /// The names of everything that is timed, in order.
    #[must_use]
    pub fn time_names(&self) -> Vec<String> {
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

    /// The groups of strokes and their objects.
    pub(crate) fn stroke_groups(&self) -> impl Iterator<Item = &StrokeGroup> {
        self.steps.iter().filter_map(|step| match &step.kind {
            StepKind::Strokes(group) => Some(group),
            _ => None,
        })
    }

    /// The counts of the last frame; none where vertex shaders detect, or no strokes are
    /// drawn.
    ///
    /// # Errors
    /// Where the device is lost.
    pub fn tally(&self, gpu: &Gpu) -> Result<Option<Tally>, strokes::gpu::readback::ReadbackError> {
        let objects = self.counted_objects();
        if objects.is_empty() {
            return Ok(None);
        }
        let mut tallies = objects.iter().map(|object| object.read_tally(gpu));
        tallies.try_fold(Tally::default(), |sum, tally| Ok(sum.plus(&tally?))).map(Some)
    }

    /// The objects whose strokes are counted.
    pub(crate) fn counted_objects(&self) -> &[DrawnObject] {
        let counts_nothing = self.strokes.as_ref().is_some_and(StrokePasses::counts_nothing);
        let group = self.stroke_groups().next().filter(|_| !counts_nothing);
        group.map_or(&[], |group| group.drawing.objects())
    }

    /// What was drawn to last, with its depth.
    #[must_use]
    pub const fn framebuffer(&self) -> &Targets {
        &self.framebuffer
    }

    /// Forgets what earlier frames have left in the textures of `plan`, the plan of this
    /// graph: the next frame is the first one again.
    pub fn forget_frames(&mut self, device: &wgpu::Device, plan: &Plan) {
        for (texture, plan) in self.sources.generated.iter_mut().zip(&plan.textures) {
            texture.renew(device, plan, self.framebuffer.size);
        }
        for step in &mut self.steps {
            step.run.is_done = false;
        }
    }

    /// Goes on in a picture of another size. Pipelines and meshes stay, and so do textures
    /// of `plan`, the plan of this graph, whose size is not that of the picture.
    pub fn resize(&mut self, device: &wgpu::Device, plan: &Plan, size: [u32; 2]) {
        let formats = *self.framebuffer.formats();
        self.framebuffer = Targets::new(device, size, formats);
        let mut is_new = Vec::with_capacity(plan.textures.len());
        for (texture, plan) in self.sources.generated.iter_mut().zip(&plan.textures) {
            is_new.push(!texture.is_for(plan, size, texture.is_double()));
            if is_new.last() == Some(&true) {
                texture.renew(device, plan, size);
            }
        }
        for step in &mut self.steps {
            let mut written = step.plan.target.textures().into_iter();
            step.run.is_done &= !written.any(|at| is_new[at]);
            if let StepKind::PingPong(pass) = &mut step.kind {
                pass.resize(device, size);
            }
        }
    }

    /// Encodes a frame, to be submitted before the next one is encoded.
    ///
    /// # Errors
    /// Where an image cannot be read.
    pub fn encode(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        seen: &Seen,
        timer: Option<TimedPasses>,
    ) -> Result<(), Error> {
        let Seen { view, around, part } = *seen;
        let whole = || Tile::whole(self.framebuffer.viewport_px());
        let uniform = FrameUniform::new(view, &part.map_or_else(whole, |of| of.part), around);
        self.view.set(gpu, view, &uniform, &self.instances);
        let mut encoding = Encoding {
            gpu,
            framebuffer: &self.framebuffer,
            view: &self.view,
            instances: &self.instances,
            surfaces: self.surfaces.as_ref(),
            overview: part.and_then(|of| of.overview),
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
            if step.run.is_due() {
                let strokes = self.strokes.as_mut();
                step.encode(encoder, &mut encoding, &mut self.sources, strokes, timer)?;
            } else {
                screen_pass::skip(encoder, timer);
            }
        }
        resolve(encoder, &self.framebuffer, encoding.is_fresh);
        Ok(())
    }
}

/// The samples of the framebuffer, averaged to the picture.
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

/// The look of all passes of strokes of a technique, for a mesh in `frame` whose crease
/// thresholds are `built`, in radians.
///
/// # Errors
/// Where a brush cannot be read or a curve is wrong.
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

impl Run {
    fn of(pass: &Pass, plan: &PassPlan) -> Self {
        let when = match pass.string("run") {
            "once" => When::Once,
            "changed" => When::Changed,
            _ => When::Always,
        };
        let program = plan.fragment.as_ref().map(|program| program.source.text.clone());
        let key = (pass.values().to_vec(), program.unwrap_or_default());
        Self { when, key, is_done: false }
    }

    /// Whether the step is to be done now.
    fn is_due(&self) -> bool {
        self.when == When::Always || !self.is_done
    }

    /// Takes over that it was done before, as far as that still counts.
    fn go_on_from(&mut self, before: &Self) {
        let is_same = self.when == When::Once || self.key == before.key;
        self.is_done = before.is_done && is_same;
    }
}

impl Step {
    fn encode(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        encoding: &mut Encoding,
        sources: &mut Sources,
        strokes: Option<&mut StrokePasses>,
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
                if let Some(strokes) = strokes {
                    strokes.encode(encoder, encoding, group, timer)?;
                }
            }
        }
        if self.plan.is_in_place {
            for texture in self.plan.target.textures() {
                sources.generated[texture].swap();
            }
        }
        self.run.is_done = true;
        Ok(())
    }
}

impl Encoding<'_> {
    /// How the framebuffer's colour is loaded: cleared where nothing was drawn yet.
    const fn load(&self) -> wgpu::LoadOp<wgpu::Color> {
        match self.is_fresh {
            true => wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
            false => wgpu::LoadOp::Load,
        }
    }
}
