//! A scene of edge meshes to pictures, without a window.

use std::path::PathBuf;
use std::time::Instant;

use edgemesh::build::Frame;
use edgemesh::camera::Camera;
use edgemesh::command::input::{InputOptions, Loaded};
use edgemesh::command::{ExitStatus, Failure};
use edgemesh::edge_mesh::Bounds;
use glam::Vec2;
use image::RgbaImage;
use strokes::frame::FrameUniform;
use strokes::gpu::{Gpu, GpuError, ResourceError};
use strokes::gpu_time::GpuTimer;
use strokes::mesh_buffers::{MeshBuffers, Tally};
use strokes::readback::{ReadbackError, read_buffer, read_picture};
use strokes::renderer::{Look, MeshDraw, PASS_NAMES, Renderer};
use strokes::targets::Targets;

/// Models in memory.
#[derive(Debug)]
pub struct Scene {
    /// Each model with its name and what was repaired in it.
    pub models: Vec<Loaded>,
    /// The box around all of them.
    pub bounds: Bounds,
    /// Where the scene lies in the files, the same for all models.
    pub frame: Frame,
}

impl Scene {
    /// Reads and builds the models of `paths`.
    ///
    /// # Errors
    /// The first model that cannot be read.
    pub fn load(paths: &[PathBuf], input: &InputOptions, is_quiet: bool) -> Result<Self, Failure> {
        Ok(Self::of(input.load_scene(paths, is_quiet)?))
    }

    /// A scene of models that are in one frame.
    #[must_use]
    pub fn of(models: Vec<Loaded>) -> Self {
        let meshes = || models.iter().map(|model| &model.mesh);
        let mut boxes = meshes().filter(|mesh| !mesh.positions.is_empty()).map(|mesh| mesh.bounds);
        let first = boxes.next().unwrap_or_default();
        let bounds = boxes.fold(first, |bounds, other| bounds.union(&other));
        let frame = meshes().next().map(|mesh| mesh.frame).unwrap_or_default();
        Self { models, bounds, frame }
    }
}

/// A scene on the GPU with everything that its pictures need.
#[derive(Debug)]
pub struct PictureRenderer<'a> {
    gpu: &'a Gpu,
    renderer: Renderer,
    targets: Targets,
    meshes: Vec<MeshDraw>,
    bounds: Bounds,
    timer: Option<GpuTimer>,
}

/// What a frame cost and drew.
#[derive(Debug, Clone)]
pub struct FrameStatistics {
    /// The counts of all meshes, summed.
    pub tally: Tally,
    /// Each pass with its milliseconds on the GPU, where the adapter has
    /// timestamps.
    pub passes: Vec<(&'static str, Option<f64>)>,
    /// From the submission until the GPU was done.
    pub frame_ms: f64,
}

impl<'a> PictureRenderer<'a> {
    /// Uploads the scene and builds the pipelines of `look`.
    ///
    /// # Errors
    /// Where the picture or a mesh is too large for the adapter, or a shader is
    /// wrong.
    pub fn new(
        gpu: &'a Gpu,
        scene: &Scene,
        look: &Look,
        size: [u32; 2],
        samples: u32,
    ) -> Result<Self, Failure> {
        check_size(gpu, size)?;
        let made = gpu.make(|| Self::make(gpu, scene, look, size, samples));
        made.map_err(|error| resource_failure(&error, size, samples))?
    }

    fn make(
        gpu: &'a Gpu,
        scene: &Scene,
        look: &Look,
        size: [u32; 2],
        samples: u32,
    ) -> Result<Self, Failure> {
        let renderer = Renderer::new(gpu, look, samples)
            .map_err(|error| Failure { message: error.to_string(), status: ExitStatus::Shader })?;
        let meshes = scene
            .models
            .iter()
            .map(|model| {
                let buffers = MeshBuffers::new(&gpu.device, &model.mesh)
                    .map_err(|error| Failure::fault(format!("{}: {error}", model.name)))?;
                Ok(renderer.mesh_draw(&gpu.device, buffers))
            })
            .collect::<Result<Vec<_>, Failure>>()?;
        Ok(Self {
            gpu,
            renderer,
            targets: Targets::new(&gpu.device, size, samples),
            meshes,
            bounds: scene.bounds,
            timer: GpuTimer::new(gpu, edgemesh::index::to_u32(PASS_NAMES.len())),
        })
    }

    /// Draws one picture, with premultiplied alpha.
    ///
    /// # Errors
    /// Where the device is lost.
    pub fn render(&self, camera: &Camera) -> Result<(RgbaImage, FrameStatistics), Failure> {
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

    fn submit(&self, camera: &Camera) {
        let [width, height] = self.targets.size;
        let aspect = f64::from(width) / f64::from(height);
        #[expect(clippy::cast_precision_loss, reason = "texture sizes are small")]
        let viewport_px = Vec2::new(width as f32, height as f32);
        let view = FrameUniform::new(&camera.view(&self.bounds, aspect), viewport_px);
        self.renderer.render(self.gpu, &self.targets, &view, &self.meshes, self.timer.as_ref());
    }

    fn read_tally(&self) -> Result<Tally, Failure> {
        let mut sum = Tally::default();
        for mesh in &self.meshes {
            let tallies: Vec<Tally> =
                read_buffer(self.gpu, mesh.buffers.tally(), 1).map_err(lost)?;
            let Some(tally) = tallies.first() else { continue };
            sum.instance_count += tally.instance_count;
            sum.contour += tally.contour;
            sum.ridge += tally.ridge;
            sum.valley += tally.valley;
            sum.boundary += tally.boundary;
            sum.marked += tally.marked;
            sum.material += tally.material;
            sum.smoothing += tally.smoothing;
        }
        Ok(sum)
    }

    fn read_passes(&self) -> Result<Vec<(&'static str, Option<f64>)>, Failure> {
        let times = self.timer.as_ref().map(|timer| timer.read_ms(self.gpu)).transpose();
        let times = times.map_err(lost)?.unwrap_or_default();
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
