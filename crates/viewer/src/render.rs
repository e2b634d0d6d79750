//! A scene of edge meshes to pictures, without a window.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use crate::scene_file::SceneObject;
use edgemesh::build::Frame;
use edgemesh::camera::Camera;
use edgemesh::command::input::{InputOptions, Loaded};
use edgemesh::command::{ExitStatus, Failure};
use edgemesh::edge_mesh::Bounds;
use glam::DMat4;
use image::RgbaImage;
use strokes::gpu::{Gpu, GpuError, ResourceError};
use strokes::gpu_time::GpuTimer;
use strokes::look::Look;
use strokes::mesh_buffers::{Layout, MeshBuffers};
use strokes::object::{GraphReadback, Object};
use strokes::readback::{ReadbackError, read_picture};
use strokes::renderer::{DetectionPath, PASS_NAMES, PreparedLook, Renderer, RendererOptions};
use strokes::shader::ShaderError;
use strokes::targets::{TargetFormats, Targets};
use strokes::view_buffers::Tally;

/// Models in memory.
#[derive(Debug)]
pub struct Scene {
    /// Each model with its name and what was repaired in it.
    pub models: Vec<Loaded>,
    /// Where they stand, and how they look.
    pub objects: Vec<PlacedObject>,
    /// The box around all of them.
    pub bounds: Bounds,
    /// Where the scene lies in the files, the same for all models.
    pub frame: Frame,
}

/// A model in its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlacedObject {
    /// Index into [`Scene::models`].
    pub model: usize,
    /// Index into the looks that a scene is drawn with.
    pub look: usize,
    /// Takes the model to the scene.
    pub world_from_object: DMat4,
}

impl Scene {
    /// Reads and builds the models of `objects`, each file once. Object number n
    /// has look number n.
    ///
    /// # Errors
    /// The first model that cannot be read.
    pub fn load(
        objects: &[SceneObject],
        input: &InputOptions,
        is_quiet: bool,
    ) -> Result<Self, Failure> {
        let mut paths: Vec<PathBuf> = Vec::new();
        let mut placed = Vec::new();
        for (look, object) in objects.iter().enumerate() {
            let known = paths.iter().position(|path| *path == object.model);
            let model = known.unwrap_or(paths.len());
            if known.is_none() {
                paths.push(object.model.clone());
            }
            let world_from_object = object.scene_from_model;
            placed.push(PlacedObject { model, look, world_from_object });
        }
        // Transforms are in the numbers of the files.
        let is_moved = placed.iter().any(|object| object.world_from_object != DMat4::IDENTITY);
        Ok(Self::placed(input.load_scene(&paths, is_moved, is_quiet)?, placed))
    }

    /// A scene of models that are in one frame, each once where it is.
    #[must_use]
    pub fn of(models: Vec<Loaded>) -> Self {
        let in_place = |model| PlacedObject { model, look: 0, world_from_object: DMat4::IDENTITY };
        let objects = (0..models.len()).map(in_place).collect();
        Self::placed(models, objects)
    }

    /// A scene of models that are in one frame, in their places.
    #[must_use]
    pub fn placed(models: Vec<Loaded>, objects: Vec<PlacedObject>) -> Self {
        let boxes = objects.iter().filter_map(|object| {
            let mesh = &models[object.model].mesh;
            let has_vertices = !mesh.positions.is_empty();
            has_vertices.then(|| mesh.bounds.transformed(&object.world_from_object))
        });
        let bounds = boxes.reduce(|bounds, other| bounds.union(&other)).unwrap_or_default();
        let frame = models.first().map(|model| model.mesh.frame).unwrap_or_default();
        Self { models, objects, bounds, frame }
    }
}

/// How a scene is drawn.
#[derive(Debug, Clone)]
pub struct PictureOptions {
    /// Premultiplied colour behind everything.
    pub background: [f64; 4],
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples a pixel, 1 or 4.
    pub samples: u32,
    /// How the edges lie in memory.
    pub layout: Layout,
    /// Where features are detected.
    pub path: DetectionPath,
}

/// A scene on the GPU with everything that its pictures need.
#[derive(Debug)]
pub struct PictureRenderer<'a> {
    gpu: &'a Gpu,
    renderer: Renderer,
    targets: Targets,
    objects: Vec<Object>,
    bounds: Bounds,
    background: [f64; 4],
    timer: Option<GpuTimer>,
}

/// What a frame cost and drew.
#[derive(Debug, Clone)]
pub struct FrameStatistics {
    /// The counts of all meshes, summed; none where vertex shaders detect.
    pub tally: Option<Tally>,
    /// Each pass with its milliseconds on the GPU, where the adapter has
    /// timestamps.
    pub passes: Vec<(&'static str, Option<f64>)>,
    /// From the submission until the GPU was done.
    pub frame_ms: f64,
}

impl<'a> PictureRenderer<'a> {
    /// Uploads the scene, each object with its look, and builds the pipelines.
    ///
    /// # Errors
    /// Where the picture or a mesh is too large for the adapter, or a shader is
    /// wrong.
    pub fn new(
        gpu: &'a Gpu,
        scene: &Scene,
        looks: &[Look],
        options: &PictureOptions,
    ) -> Result<Self, Failure> {
        check_size(gpu, options.size)?;
        let made = gpu.make(|| Self::make(gpu, scene, looks, options));
        made.map_err(|error| resource_failure(&error, options.size, options.samples))?
    }

    fn make(
        gpu: &'a Gpu,
        scene: &Scene,
        looks: &[Look],
        options: &PictureOptions,
    ) -> Result<Self, Failure> {
        let shader_failure =
            |error: ShaderError| Failure { message: error.to_string(), status: ExitStatus::Shader };
        let formats = if looks.iter().any(|look| look.silhouette.is_some()) {
            TargetFormats::with_stencil(&gpu.device, options.samples)
        } else {
            TargetFormats::new(options.samples)
        };
        let PictureOptions { layout, path, .. } = *options;
        let mut renderer = Renderer::new(gpu, RendererOptions { layout, path, formats })
            .map_err(shader_failure)?;
        // Objects that look alike share pipelines and textures.
        let mut prepared: Vec<Arc<PreparedLook>> = Vec::with_capacity(looks.len());
        for (at, look) in looks.iter().enumerate() {
            let same = looks[..at].iter().position(|known| known == look);
            prepared.push(match same {
                Some(same) => prepared[same].clone(),
                None => renderer.prepare(gpu, look).map_err(shader_failure)?,
            });
        }
        let looks = prepared;
        let is_linked = looks.iter().any(|look| look.is_linked());
        let meshes = scene.models.iter().map(|model| {
            let upload = if is_linked { MeshBuffers::with_links } else { MeshBuffers::new };
            let buffers = upload(&gpu.device, &model.mesh, layout)
                .map_err(|error| Failure::fault(format!("{}: {error}", model.name)))?;
            Ok(Arc::new(buffers))
        });
        let meshes = meshes.collect::<Result<Vec<_>, Failure>>()?;
        let objects = scene.objects.iter().map(|placed| {
            let mut object = renderer.object(
                gpu,
                &meshes[placed.model],
                &looks[placed.look.min(looks.len() - 1)],
            );
            object.world_from_object = placed.world_from_object;
            object
        });
        Ok(Self {
            objects: objects.collect(),
            gpu,
            renderer,
            targets: Targets::new(&gpu.device, options.size, formats),
            bounds: scene.bounds,
            background: options.background,
            timer: GpuTimer::new(gpu, edgemesh::index::to_u32(PASS_NAMES.len())),
        })
    }

    /// Draws one picture, with premultiplied alpha.
    ///
    /// # Errors
    /// Where the device is lost.
    pub fn render(&mut self, camera: &Camera) -> Result<(RgbaImage, FrameStatistics), Failure> {
        let started = Instant::now();
        self.submit(camera);
        self.gpu
            .device
            .poll(wgpu::PollType::wait_indefinitely())
            .map_err(|error| Failure::fault(format!("the graphics adapter was lost: {error}")))?;
        let frame_ms = started.elapsed().as_secs_f64() * 1e3;
        let picture = read_picture(self.gpu, self.targets.picture()).map_err(lost)?;
        let statistics =
            FrameStatistics { tally: self.read_tally()?, passes: self.read_passes()?, frame_ms };
        Ok((picture, statistics))
    }

    /// The stroke graph of an object in the last picture; nothing where its strokes are
    /// not linked.
    ///
    /// # Errors
    /// Where the device is lost.
    pub fn read_graph(&self, object: usize) -> Result<Option<GraphReadback>, Failure> {
        let Some(object) = self.objects.get(object) else { return Ok(None) };
        object.read_graph(self.gpu).map_err(lost)
    }

    fn submit(&mut self, camera: &Camera) {
        let [width, height] = self.targets.size;
        let view = camera.view(&self.bounds, f64::from(width) / f64::from(height));
        let timer = self.timer.as_ref();
        let objects = &mut self.objects;
        self.renderer.render(self.gpu, &self.targets, &view, self.background, objects, timer);
    }

    fn read_tally(&self) -> Result<Option<Tally>, Failure> {
        if self.renderer.options().path == DetectionPath::Vertex {
            return Ok(None);
        }
        let sum = self.objects.iter().try_fold(Tally::default(), |sum, object| {
            object.read_tally(self.gpu).map(|tally| sum.plus(&tally)).map_err(lost)
        });
        sum.map(Some)
    }

    fn read_passes(&self) -> Result<Vec<(&'static str, Option<f64>)>, Failure> {
        let times = self.timer.as_ref().map(|timer| timer.read(self.gpu)).transpose();
        let times = times.map_err(lost)?.map_or_else(Vec::new, |times| times.passes_ms);
        let times = times.into_iter().map(Some).chain(std::iter::repeat(None));
        Ok(PASS_NAMES.into_iter().zip(times).collect())
    }
}

fn lost(error: ReadbackError) -> Failure {
    Failure::fault(error.to_string())
}

fn resource_failure(error: &ResourceError, size: [u32; 2], samples: u32) -> Failure {
    match error {
        ResourceError::OutOfMemory => Failure::fault(format!(
            "{error}: the picture alone, {}x{} with {samples} samples, needs {} MiB; make --size \
             smaller or use --samples 1",
            size[0],
            size[1],
            Targets::byte_count(size, samples) >> 20
        )),
        ResourceError::Fault(_) => {
            Failure { message: error.to_string(), status: ExitStatus::Internal }
        }
    }
}

fn check_size(gpu: &Gpu, size: [u32; 2]) -> Result<(), Failure> {
    let limit = gpu.device.limits().max_texture_dimension_2d;
    if size.iter().any(|&side| side > limit) {
        let [width, height] = size;
        return Err(Failure::fault(format!(
            "--size {width}x{height}: this adapter draws at most {limit} pixels a side"
        )));
    }
    Ok(())
}

/// The failure that a missing or unfit adapter is: exit status 3.
#[must_use]
pub fn adapter_failure(error: &GpuError) -> Failure {
    Failure { message: error.to_string(), status: ExitStatus::NoAdapter }
}
