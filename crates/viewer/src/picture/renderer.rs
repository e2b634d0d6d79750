//! Draws pictures of a scene, without a window.

use std::path::PathBuf;
use std::time::Instant;

use edgemesh::edge_mesh::{Bounds, MeshFrame};
use edgemesh::view::{Camera, GUARD_BAND, Sight, View};
use glam::Vec3;
use image::RgbaImage;
use strokes::{
    DetectionStage, Gpu, GpuTimer, GraphReadback, Layout, PendingRead, ResourceError, Surroundings,
    Tally, Targets, Tile, read_picture,
};

use crate::error::Error;
use crate::pass_graph::{FrameInput, GraphInput, GraphOptions, PassGraph, TileInput};
use crate::scene::lighting::Lighting;
use crate::scene::models::Scene;
use crate::scene::sight::SceneSight;
use crate::technique::Technique;
use crate::technique::plan::{Plan, TexturePlan};
use crate::technique::program::ShaderFiles;
use crate::technique::texture_format::PassTexture;

/// Options of a picture.
#[derive(Debug, Clone)]
pub struct PictureOptions {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples per pixel, 1 or 4.
    pub samples: u32,
    /// Memory layout of the edges.
    pub layout: Layout,
    /// The stage that detects features.
    pub stage: DetectionStage,
    /// Whether the background is transparent.
    pub is_transparent: bool,
    /// Light and clip planes.
    pub lighting: Lighting,
    /// A folder that replaces the built-in shaders.
    pub shaders: Option<PathBuf>,
}

impl Default for PictureOptions {
    /// 1024 x 1024 pixels with 4 samples.
    fn default() -> Self {
        Self {
            size: [1024; 2],
            samples: 4,
            layout: Layout::default(),
            stage: DetectionStage::default(),
            is_transparent: false,
            lighting: Lighting::default(),
            shaders: None,
        }
    }
}

impl PictureOptions {
    const fn of_graph(&self) -> GraphOptions {
        GraphOptions {
            size: self.size,
            samples: self.samples,
            layout: self.layout,
            stage: self.stage,
            is_transparent: self.is_transparent,
            clips: !self.lighting.clip_planes.is_empty(),
        }
    }
}

/// The scene and its techniques.
#[derive(Debug, Clone, Copy)]
pub struct PictureInput<'a> {
    /// Models in their places.
    pub scene: &'a Scene,
    /// The technique of the scene.
    pub technique: &'a Technique,
    /// Techniques of single objects, by [`PlacedObject::override_index`]. Only their fills
    /// and strokes are used.
    ///
    /// [`PlacedObject::override_index`]: crate::scene::models::PlacedObject::override_index
    pub overrides: &'a [Technique],
}

impl<'a> PictureInput<'a> {
    /// A scene with one technique for all objects.
    #[must_use]
    pub const fn new(scene: &'a Scene, technique: &'a Technique) -> Self {
        Self { scene, technique, overrides: &[] }
    }

    const fn of_graph(self, plan: &'a Plan, options: &'a GraphOptions) -> GraphInput<'a> {
        let Self { scene, technique, overrides } = self;
        GraphInput { scene, technique, plan, overrides, options }
    }
}

/// A scene on the GPU, ready to draw.
#[derive(Debug)]
pub struct PictureRenderer {
    gpu: Gpu,
    /// Empty after memory ran out, until a technique is built again.
    graph: PassGraph,
    options: PictureOptions,
    plan: Plan,
    sight: SceneSight,
    bounds: Bounds,
    frame: MeshFrame,
    timer: Option<GpuTimer>,
}

/// Counts and times of a frame.
#[derive(Debug, Clone)]
pub struct FrameStatistics {
    /// The counts of all meshes, summed; `None` if vertex shaders detect.
    pub tally: Option<Tally>,
    /// Each pass with its milliseconds on the GPU; `None` without timestamp queries.
    pub passes: Vec<(String, Option<f64>)>,
    /// Milliseconds from the submission until the GPU is done.
    pub frame_ms: f64,
}

impl FrameStatistics {
    /// Adds the times of another tile of the same picture. The counts are those of the
    /// whole scene in both.
    #[must_use]
    pub(crate) fn plus(mut self, other: Self) -> Self {
        for (sum, time) in self.passes.iter_mut().zip(other.passes) {
            sum.1 = sum.1.zip(time.1).map(|(one, other)| one + other);
        }
        Self { frame_ms: self.frame_ms + other.frame_ms, ..self }
    }
}

/// Why a picture is of one color.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub(crate) enum Emptiness {
    #[error("no part of the scene is in sight")]
    OutOfSight,
    #[error("the clip planes cut away all that is in sight")]
    CutAway,
    #[error("the technique draws nothing of what is in sight, or all of it in one color")]
    NothingDrawn,
}

/// Statistics that are not read yet.
#[derive(Debug)]
pub(crate) struct PendingStatistics {
    tallies: Option<PendingRead<Tally>>,
    ticks: Option<PendingRead<u64>>,
    started: Instant,
}

impl PictureRenderer {
    /// Checks the technique, uploads the scene, and builds the pipelines.
    ///
    /// # Errors
    /// If the technique or its shaders have mistakes, or the picture or a mesh is too large
    /// for the adapter.
    pub fn new(gpu: &Gpu, input: PictureInput, options: &PictureOptions) -> Result<Self, Error> {
        check_size(gpu, options.size)?;
        let scene = input.scene;
        let plan = plan_of(input.technique, options)?;
        let graph_options = options.of_graph();
        let input = input.of_graph(&plan, &graph_options);
        let made = gpu.make(|| PassGraph::new(gpu, &input));
        let graph =
            made.map_err(|error| resource_error(error, options.size, options.samples))??;
        Ok(Self {
            gpu: gpu.clone(),
            timer: timer_for(gpu, &graph),
            graph,
            options: options.clone(),
            plan,
            sight: SceneSight::of(scene),
            bounds: scene.bounds,
            frame: scene.frame,
        })
    }

    /// Takes a changed technique, overrides or options. Everything else stays on the GPU, and
    /// textures keep their content.
    ///
    /// # Errors
    /// As [`Self::new`]. The renderer then draws as before, or one transparent pixel if
    /// memory ran out.
    pub fn reload(&mut self, input: PictureInput, options: &PictureOptions) -> Result<(), Error> {
        if (options.layout, options.stage) != (self.options.layout, self.options.stage) {
            *self = Self::new(&self.gpu, input, options)?;
            return Ok(());
        }
        check_size(&self.gpu, options.size)?;
        let scene = input.scene;
        let plan = plan_of(input.technique, options)?;
        let graph_options = options.of_graph();
        let input = input.of_graph(&plan, &graph_options);
        let (gpu, graph) = (&self.gpu, &mut self.graph);
        let change = gpu
            .make(|| graph.change(gpu, &input))
            .map_err(|error| self.lose_graph(error, options.size, options.samples))??;
        self.graph.apply(change);
        self.timer = timer_for(&self.gpu, &self.graph);
        self.plan = plan;
        self.options = options.clone();
        (self.bounds, self.frame) = (scene.bounds, scene.frame);
        Ok(())
    }

    /// Changes the size; pipelines and meshes stay.
    ///
    /// # Errors
    /// If the size is too large for the adapter, or memory runs out; the renderer then draws
    /// one transparent pixel until a [`Self::reload`].
    pub(crate) fn resize(&mut self, size: [u32; 2]) -> Result<(), Error> {
        check_size(&self.gpu, size)?;
        let (gpu, plan, samples) = (&self.gpu, &self.plan, self.options.samples);
        gpu.make(|| self.graph.resize(gpu, plan, size))
            .map_err(|error| self.lose_graph(error, size, samples))??;
        self.options.size = size;
        Ok(())
    }

    /// Drops the whole graph, which cannot be used after memory ran out.
    fn lose_graph(&mut self, error: ResourceError, size: [u32; 2], samples: u32) -> Error {
        self.graph = PassGraph::empty(&self.gpu);
        self.plan = Plan::default();
        self.timer = None;
        resource_error(error, size, samples)
    }

    /// The options in effect.
    #[must_use]
    pub const fn options(&self) -> &PictureOptions {
        &self.options
    }

    /// Sets light and clip planes. Returns false, and changes nothing, if the first plane
    /// comes or the last one goes, which needs a [`Self::reload`].
    pub(crate) fn set_lighting(&mut self, lighting: &Lighting) -> bool {
        let is_cut = |lighting: &Lighting| !lighting.clip_planes.is_empty();
        let can = is_cut(lighting) == is_cut(&self.options.lighting);
        if can {
            self.options.lighting = lighting.clone();
        }
        can
    }

    /// Draws one picture, with premultiplied alpha.
    ///
    /// # Errors
    /// If the device is lost, or an image cannot be read.
    pub fn render(&mut self, camera: &Camera) -> Result<(RgbaImage, FrameStatistics), Error> {
        let started = Instant::now();
        self.draw(camera)?;
        self.read(started)
    }

    /// Draws one tile of a picture as if no picture had been drawn before. The tile must
    /// have this renderer's size. If strokes are linked, `overview` must have drawn the
    /// whole picture last.
    ///
    /// # Errors
    /// As [`Self::render`].
    pub(crate) fn render_tile(
        &mut self,
        view: &View,
        tile: Tile,
        overview: Option<&Self>,
    ) -> Result<(RgbaImage, FrameStatistics), Error> {
        let started = Instant::now();
        let overview = overview.map(|overview| overview.graph.framebuffer());
        self.draw_first(view, Some(TileInput { tile, overview }))?;
        self.read(started)
    }

    /// Draws the whole picture as if none had been drawn before.
    ///
    /// # Errors
    /// If an image cannot be read.
    pub(crate) fn draw_overview(&mut self, view: &View) -> Result<(), Error> {
        self.draw_first(view, None)
    }

    fn draw_first(&mut self, view: &View, tile: Option<TileInput>) -> Result<(), Error> {
        let (gpu, plan) = (&self.gpu, &self.plan);
        let PictureOptions { size, samples, .. } = self.options;
        gpu.make(|| self.graph.forget_frames(&gpu.device, plan))
            .map_err(|error| self.lose_graph(error, size, samples))?;
        self.submit(view, tile)
    }

    /// Waits for the submitted picture and reads it.
    fn read(&self, started: Instant) -> Result<(RgbaImage, FrameStatistics), Error> {
        self.gpu
            .device
            .poll(wgpu::PollType::wait_indefinitely())
            .map_err(|reason| Error::DeviceLost { reason })?;
        let frame_ms = started.elapsed().as_secs_f64() * 1e3;
        let picture = read_picture(&self.gpu, self.graph.picture())?;
        let tally = self.graph.tally(&self.gpu)?;
        let statistics = FrameStatistics { tally, passes: self.read_passes()?, frame_ms };
        Ok((picture, statistics))
    }

    /// The stroke graph of an object in the last picture; `None` if its strokes are not
    /// linked.
    ///
    /// # Errors
    /// If the device is lost.
    pub(crate) fn read_graph(&self, object: usize) -> Result<Option<GraphReadback>, Error> {
        let group = self.graph.stroke_groups().next();
        let Some(object) = group.and_then(|group| group.drawing.objects().get(object)) else {
            return Ok(None);
        };
        Ok(object.read_graph(&self.gpu)?)
    }

    /// The texture `<generated>:name` after the last picture.
    #[must_use]
    pub fn generated(&self, name: &str) -> Option<&wgpu::Texture> {
        self.graph.generated(&self.plan, name)
    }

    /// The textures between passes.
    #[must_use]
    pub fn generated_textures(&self) -> Vec<PassTexture> {
        let textures = self.plan.textures.iter();
        let of_plan = |texture: &TexturePlan| PassTexture {
            name: texture.name.clone(),
            format: texture.format,
        };
        textures.map(of_plan).collect()
    }

    /// The texture of the last submitted picture.
    #[must_use]
    pub(crate) const fn picture(&self) -> &wgpu::Texture {
        self.graph.picture()
    }

    /// Submits a picture without waiting for it.
    ///
    /// # Errors
    /// If an image cannot be read.
    pub(crate) fn draw(&mut self, camera: &Camera) -> Result<(), Error> {
        let view = self.view(camera, self.options.size);
        self.submit(&view, None)
    }

    /// The view of a camera in a picture of a size in pixels.
    #[must_use]
    pub(crate) fn view(&self, camera: &Camera, [width, height]: [u32; 2]) -> View {
        let view = camera.view(&self.bounds, f64::from(width) / f64::from(height));
        let around = self.surroundings(&view);
        if is_outside(&view, &around) {
            return view;
        }
        let sight = Sight::of(&view, GUARD_BAND, &around.clip_planes);
        let nearest = self.sight.nearest(&sight);
        nearest.map_or(view, |nearest| view.with_nearest(nearest))
    }

    /// Why a picture of a scene is of one color; `None` if there is nothing in the scene.
    #[must_use]
    pub(crate) fn why_empty(&self, camera: &Camera, size: [u32; 2]) -> Option<Emptiness> {
        let view = self.view(camera, size);
        let around = self.surroundings(&view);
        let sees = |clip_planes: &[[f32; 4]]| {
            self.sight.nearest(&Sight::of(&view, 1.0, clip_planes)).is_some()
        };
        if self.sight.is_empty() {
            None
        } else if sees(&around.clip_planes) {
            Some(Emptiness::NothingDrawn)
        } else if sees(&[]) {
            Some(Emptiness::CutAway)
        } else {
            Some(Emptiness::OutOfSight)
        }
    }

    fn surroundings(&self, view: &View) -> Surroundings {
        self.options.lighting.surroundings(view, &self.bounds, &self.frame)
    }

    fn submit(&mut self, view: &View, tile: Option<TileInput>) -> Result<(), Error> {
        let around = self.surroundings(view);
        let input = FrameInput { view, around: &around, tile };
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let timer = self.timer.as_ref().map(|timer| timer.passes_from(0));
        self.graph.encode(&self.gpu, &mut encoder, &input, timer)?;
        if let Some(timer) = &self.timer {
            timer.resolve(&mut encoder);
        }
        self.gpu.queue.submit([encoder.finish()]);
        Ok(())
    }

    /// Starts reading the statistics of the last picture.
    ///
    /// # Errors
    /// If the device is lost.
    pub(crate) fn begin_statistics(&self) -> Result<PendingStatistics, Error> {
        let counted = self.graph.counted();
        let tallies = counted.map(|drawing| drawing.begin_read_tallies(&self.gpu)).transpose()?;
        let ticks = self.timer.as_ref().map(|timer| timer.begin_read(&self.gpu));
        let ticks = ticks.transpose()?;
        Ok(PendingStatistics { tallies, ticks, started: Instant::now() })
    }

    /// The statistics, once they are known. `pending` must be of the last picture, without a
    /// reload since.
    ///
    /// # Errors
    /// If the device is lost.
    pub(crate) fn statistics(
        &self,
        pending: &PendingStatistics,
    ) -> Result<Option<FrameStatistics>, Error> {
        let mut sum = None;
        if let Some(pending) = &pending.tallies {
            let Some(tallies) = pending.poll(&self.gpu)? else { return Ok(None) };
            sum = Some(tallies.iter().fold(Tally::default(), |sum, tally| sum.plus(tally)));
        }
        let mut passes_ms = Vec::new();
        if let (Some(timer), Some(ticks)) = (&self.timer, &pending.ticks) {
            let Some(ticks) = ticks.poll(&self.gpu)? else { return Ok(None) };
            passes_ms = timer.times(&self.gpu, &ticks).passes_ms;
        }
        let frame_ms = pending.started.elapsed().as_secs_f64() * 1e3;
        Ok(Some(FrameStatistics { tally: sum, passes: self.named(passes_ms), frame_ms }))
    }

    fn read_passes(&self) -> Result<Vec<(String, Option<f64>)>, Error> {
        let times = self.timer.as_ref().map(|timer| timer.read(&self.gpu)).transpose();
        Ok(self.named(times?.map_or_else(Vec::new, |times| times.passes_ms)))
    }

    fn named(&self, passes_ms: Vec<f64>) -> Vec<(String, Option<f64>)> {
        let times = passes_ms.into_iter().map(Some).chain(std::iter::repeat(None));
        self.graph.time_names().into_iter().zip(times).collect()
    }
}

/// Whether the eye is so far outside of the scene that its bounding sphere tells where the near
/// plane may lie.
fn is_outside(view: &View, around: &Surroundings) -> bool {
    let middle = view.distance.dot(Vec3::from(around.scene_center).extend(1.0));
    view.eye.w == 0.0 || middle > 1.1 * around.scene_radius
}

fn timer_for(gpu: &Gpu, graph: &PassGraph) -> Option<GpuTimer> {
    let count = edgemesh::index::to_u32(graph.time_names().len());
    GpuTimer::new(gpu, count)
}

/// The plan of a technique; its warnings are logged.
fn plan_of(technique: &Technique, options: &PictureOptions) -> Result<Plan, Error> {
    let shaders = ShaderFiles::new(&technique.folders, options.shaders.clone());
    let plan = Plan::of(technique, &shaders)?;
    for warning in &plan.warnings.list {
        log::warn!("{}: {}", technique.name, warning.message);
    }
    Ok(plan)
}

fn resource_error(error: ResourceError, size: [u32; 2], samples: u32) -> Error {
    match error {
        ResourceError::OutOfMemory => {
            Error::OutOfMemory { size, samples, bytes: Targets::byte_count(size, samples) }
        }
        ResourceError::Fault(what) => Error::AdapterFault(what),
        error => Error::AdapterFault(error.to_string()),
    }
}

fn check_size(gpu: &Gpu, size: [u32; 2]) -> Result<(), Error> {
    let limit = gpu.device.limits().max_texture_dimension_2d;
    match size.iter().any(|&side| side > limit) {
        true => Err(Error::PictureTooLarge { size, limit }),
        false => Ok(()),
    }
}
