//! One frame in one command buffer, without reading anything back: detect, link, expand,
//! fill, paths, coverage, strokes. The passes that draw are in `frame_encoder.rs`.

use std::sync::Arc;

use edgemesh::view::View;

use crate::draw::targets::Targets;
use crate::gpu::device::Gpu;
use crate::gpu::timer::{GpuTimer, TimedPasses};
use crate::graph::link::LinkPipeline;
use crate::render::drawing::{Drawing, DrawnObject};
use crate::render::error::RenderError;
use crate::render::frame_encoder::{DrawStep, FrameEncoder, Placed};
use crate::render::frame_request::{Fill, FrameRequest, PASS_NAMES};
use crate::render::options::RendererOptions;
use crate::render::pipelines::Pipelines;
use crate::render::prepared_style::{PreparedStyle, StrokeVertices};
use crate::render::scene_view::SceneView;
use crate::style::drawing_style::DrawingStyle;
use crate::view::detect::DetectPipeline;
use crate::view::frame::{FrameUniform, Surroundings};
use crate::view::tile::Tile;
use crate::view::view_state::ViewState;

/// Draws the strokes of meshes of one layout into targets of one format.
#[derive(Debug)]
pub struct Renderer {
    pipelines: Pipelines,
}

impl Renderer {
    /// Builds the pipelines that every style needs.
    ///
    /// # Errors
    /// [`RenderError::Shader`], an internal error.
    pub fn new(gpu: &Gpu, options: RendererOptions) -> Result<Self, RenderError> {
        Ok(Self { pipelines: Pipelines::new(gpu, options)? })
    }

    /// The options in effect, after unsupported combinations were replaced.
    #[must_use]
    pub const fn options(&self) -> &RendererOptions {
        &self.pipelines.options
    }

    /// Builds the pipelines, uniforms and textures of a style. Styles share pipelines and
    /// brushes.
    ///
    /// # Errors
    /// [`RenderError::NoStencil`], [`RenderError::TooManyLayers`] and [`RenderError::Shader`].
    pub fn prepare(
        &mut self,
        gpu: &Gpu,
        style: &DrawingStyle,
    ) -> Result<Arc<PreparedStyle>, RenderError> {
        self.pipelines.prepare(gpu, style).map(Arc::new)
    }

    /// Submits one frame of `scene` as `view` sees it, over `background` (premultiplied RGBA, 0
    /// to 1).
    ///
    /// # Errors
    /// As [`Self::encode`].
    pub fn render(
        &mut self,
        gpu: &Gpu,
        targets: &Targets,
        scene: &mut SceneView,
        view: &View,
        background: [f64; 4],
        timer: Option<&GpuTimer>,
    ) -> Result<(), RenderError> {
        let tile = Tile::whole(targets.viewport_px());
        let uniform = FrameUniform::new(view, &tile, &Surroundings::default());
        scene.view.set(gpu, view, &uniform, &scene.instances);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let request = FrameRequest {
            targets,
            instances: &scene.instances,
            styles: &scene.styles,
            view: &scene.view,
            fill: Fill::Clear(background),
            glass_depth: None,
            overview: None,
            resolves: true,
            timer: timer.map(|timer| timer.passes_from(0)),
        };
        self.encode(gpu, &mut encoder, &mut scene.drawing, &request)?;
        if let Some(timer) = timer {
            timer.resolve(&mut encoder);
        }
        gpu.queue.submit([encoder.finish()]);
        Ok(())
    }

    /// Encodes a frame, to be submitted before the next one is encoded. `drawing` keeps the
    /// lists of the frame; pass it with the same view state in the next frame.
    ///
    /// # Errors
    /// [`RenderError`], if the parts of the request do not fit together; nothing is encoded
    /// then.
    pub fn encode(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        drawing: &mut Drawing,
        request: &FrameRequest,
    ) -> Result<(), RenderError> {
        let FrameRequest { targets, view, timer, .. } = *request;
        drawing.update(gpu, &mut self.pipelines, request)?;
        let pipelines = &self.pipelines;
        let placed = placed(drawing, view);
        let frame = Frame { pipelines, view, placed: &placed, timer };
        frame.detect(encoder);
        frame.link(encoder);
        frame.expand(encoder);
        let asks_for_fill = |placed: &Placed| {
            placed.object.style.sets.iter().any(|set| set.reads_fill || set.is_linked)
        };
        let asks_for_fill = placed.iter().any(asks_for_fill);
        let with_fill = |targets: &Targets| {
            let layout = &pipelines.layouts.frame_fill;
            let (device, frame, glass) = (&gpu.device, view.frame(), request.glass_depth);
            asks_for_fill.then(|| targets.bind_with_frame(device, layout, frame, glass))
        };
        let encode = FrameEncoder {
            pipelines,
            targets,
            frame: view.frame().bind_group(),
            objects: &placed,
            frame_fill: with_fill(targets),
            overview_fill: request.overview.and_then(with_fill),
            steps: DrawStep::plan(&placed),
            resolves: request.resolves,
            clips: view.uniform().clip_plane_count > 0,
        };
        let values = encode.stencil_values();
        encode.encode_fill(encoder, request.fill, &values, timer);
        encode.encode_paths(encoder, timer);
        let coverage = targets.coverage(&gpu.device, encode.batches().count());
        encode.encode_coverage(encoder, &coverage, timer);
        let laid = encode.composite_groups(&gpu.device, &coverage);
        encode.encode_strokes(encoder, &values, &laid, timer);
        let drawn = drawing.objects_mut().iter_mut().zip(view.objects());
        for (object, _) in drawn.filter(|(_, state)| state.is_placed()) {
            object.is_stale = false;
        }
        Ok(())
    }
}

/// The objects that their transforms do not flatten.
fn placed<'a>(drawing: &'a Drawing, view: &'a ViewState) -> Vec<Placed<'a>> {
    let objects = drawing.objects().iter().zip(view.objects());
    objects
        .filter(|(_, state)| state.is_placed())
        .map(|(object, state)| Placed { object, state })
        .collect()
}

/// The compute passes before anything is drawn.
struct Frame<'a> {
    pipelines: &'a Pipelines,
    view: &'a ViewState,
    placed: &'a [Placed<'a>],
    timer: Option<TimedPasses<'a>>,
}

impl Frame<'_> {
    fn objects(&self) -> impl Iterator<Item = &DrawnObject> {
        self.placed.iter().map(|placed| placed.object)
    }

    /// The compute pass with this number, with the frame bound.
    fn pass<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        number: u32,
    ) -> wgpu::ComputePass<'e> {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some(PASS_NAMES[number as usize]),
            timestamp_writes: self.timer.map(|timer| timer.compute(number)),
        });
        pass.set_bind_group(0, self.view.frame().bind_group(), &[]);
        pass
    }

    fn detect(&self, encoder: &mut wgpu::CommandEncoder) {
        for object in self.objects() {
            let tallies = &object.runs.tallies;
            DetectPipeline::clear(encoder, tallies, object.chunks.len(), object.is_stale);
        }
        let mut pass = self.pass(encoder, 0);
        for object in self.objects().filter(|object| !object.style.sets.is_empty()) {
            pass.set_bind_group(1, &object.style.detect_pass, &[]);
            for bound in object.chunks.iter().filter_map(|chunk| chunk.lists.as_ref()) {
                self.pipelines.detect.record(&mut pass, &bound.detect, object.is_stale);
            }
        }
    }

    fn link(&self, encoder: &mut wgpu::CommandEncoder) {
        let graphs = || self.objects().filter_map(|object| object.graph.as_ref());
        for graph in graphs() {
            LinkPipeline::clear(encoder, &graph.buffers);
        }
        let mut pass = self.pass(encoder, 1);
        let Some(pipelines) = &self.pipelines.graph else { return };
        for graph in graphs() {
            pass.set_bind_group(1, &graph.uniform, &[]);
            pipelines.link.record(&mut pass, &graph.buffers, &graph.link);
        }
    }

    fn expand(&self, encoder: &mut wgpu::CommandEncoder) {
        let mut pass = self.pass(encoder, 2);
        for object in self.objects() {
            for (index, set) in object.style.sets.iter().enumerate() {
                let StrokeVertices::Lists { expanded: Some((expand, _)), .. } = &set.vertices
                else {
                    continue;
                };
                pass.set_bind_group(1, &set.style, &[]);
                for chunk in &object.chunks {
                    let Some(bound) = &chunk.lists else { continue };
                    let Some(group) = &bound.expand[index] else { continue };
                    pass.set_bind_group(2, &chunk.edges, &[]);
                    expand.record(&mut pass, group, &bound.lists, index);
                }
            }
        }
    }
}
