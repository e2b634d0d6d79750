//! One frame in one command buffer, without reading anything back: detect, link,
//! expand, fill, paths, coverage, strokes. What draws is in `frame_encoder.rs`.

pub(crate) mod frame_encoder;
mod graph_pipelines;
pub mod object;

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::sync::Arc;

use edgemesh::line::class::LineClass;
use edgemesh::line::kind::LineKind;
use edgemesh::view::camera::View;
use edgemesh_shaders::ShaderError;

use crate::draw::expand::ExpandPipeline;
use crate::draw::fill::{FillKind, FillPipeline};
use crate::draw::stroke::{StrokeVariant, VertexSource, stroke_pipeline, style_group};
use crate::draw::stroke_indices::{IndexBuffer, IndexKey};
use crate::draw::stroke_layouts::StrokeLayouts;
use crate::draw::targets::Targets;
use crate::gpu::device::Gpu;
use crate::gpu::target_formats::TargetFormats;
use crate::gpu::timer::{GpuTimer, TimedPasses};
use crate::graph::link::LinkPipeline;
use crate::mesh::buffers::MeshBuffers;
use crate::mesh::layout::Layout;
use crate::renderer::frame_encoder::{DrawStep, FrameEncoder};
use crate::renderer::graph_pipelines::GraphPipelines;
use crate::renderer::object::Object;
use crate::style::brush::BrushTextures;
use crate::style::drawing_style::{Look, Visibility};
use crate::view::detect::DetectPipeline;
use crate::view::frame::{Frame, FrameUniform, Surroundings, frame_layout};
use crate::view::tile::PicturePart;

/// The passes of a frame, in order, as [`GpuTimer`] numbers them.
pub const PASS_NAMES: [&str; 7] =
    ["detect", "link", "expand", "fill", "paths", "coverage", "strokes"];

/// Where feature edges are detected.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum DetectionPath {
    /// In compute shaders, which list the edges to draw.
    #[default]
    Compute,
    /// In the vertex shader, as in the paper: every edge is drawn, and what is no
    /// feature lies behind the near plane.
    Vertex,
}

/// What a renderer is made for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RendererOptions {
    /// How the edges of all meshes lie in memory.
    pub layout: Layout,
    /// Where features are detected; in the vertex shader for
    /// [`Layout::FaceNormals`], which has no other.
    pub path: DetectionPath,
    /// What is drawn into.
    pub formats: TargetFormats,
}

/// The pipelines for one kind of target and mesh.
#[derive(Debug)]
pub struct Renderer {
    pub(crate) options: RendererOptions,
    pub(crate) layouts: StrokeLayouts,
    pub(crate) detect: DetectPipeline,
    pub(crate) fill: FillPipeline,
    /// Once a look links strokes.
    pub(crate) graph: Option<GraphPipelines>,
    pub(crate) frame: Frame,
    expand: HashMap<LineKind, Arc<ExpandPipeline>>,
    strokes: HashMap<StrokeVariant, wgpu::RenderPipeline>,
    indices: HashMap<IndexKey, IndexBuffer>,
    brushes: BrushTextures,
}

/// What is done about the surface before strokes are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fill {
    /// The picture is cleared to a premultiplied colour, and objects are filled.
    Clear([f64; 4]),
    /// The picture stays; its depth is made anew.
    Depth,
    /// Picture and depth are there, drawn with [`crate::draw::fill::push_away`]; the stencil
    /// is marked where it is needed.
    Done,
}

/// A frame to be encoded.
#[derive(Debug, Clone, Copy)]
pub struct FrameRequest<'a> {
    /// Where to.
    pub targets: &'a Targets,
    /// As who sees the whole picture.
    pub view: &'a View,
    /// The same for the shaders, and which part of it is drawn.
    pub uniform: &'a FrameUniform,
    /// What is under the strokes.
    pub fill: Fill,
    /// The whole picture, smaller, where a part of it is drawn: its depth tells where
    /// linked strokes are seen, so that they begin and end alike in all parts.
    pub overview: Option<&'a Targets>,
    /// Whether the samples are averaged to the picture in the end.
    pub resolves: bool,
    /// [`PASS_NAMES`] passes of a timer.
    pub timer: Option<TimedPasses<'a>>,
}

/// A look with its pipelines and its textures.
#[derive(Debug)]
pub struct PreparedLook {
    pub(crate) layer_count: u32,
    /// Whether contours are in a layer as such.
    pub(crate) draws_contours: bool,
    pub(crate) draws: Vec<PreparedDraw>,
    pub(crate) detect_pass: wgpu::BindGroup,
    pub(crate) fill_pass: wgpu::BindGroup,
    pub(crate) fill_kind: FillKind,
    /// The styles of linked strokes, where there are such.
    pub(crate) path_pass: Option<wgpu::BindGroup>,
}

/// One draw of strokes.
#[derive(Debug)]
pub(crate) struct PreparedDraw {
    pub(crate) layer: u32,
    pub(crate) kind: LineKind,
    pub(crate) visibility: Visibility,
    pub(crate) lies_over_surface: bool,
    pub(crate) is_linked: bool,
    /// Premultiplied.
    pub(crate) color: [f32; 4],
    /// How far ink lies from the lines at most, in pixels; not known where widths are
    /// those of the world.
    pub(crate) reach_px: Option<f32>,
    pub(crate) is_textured: bool,
    pub(crate) style: wgpu::BindGroup,
    pub(crate) vertices: DrawVertices,
}

#[derive(Debug)]
pub(crate) enum DrawVertices {
    Lists {
        /// None where no stroke is expanded.
        expanded: Option<(Arc<ExpandPipeline>, wgpu::RenderPipeline)>,
        listed: wgpu::RenderPipeline,
    },
    All(wgpu::RenderPipeline),
    Attributes(wgpu::RenderPipeline),
}

impl PreparedLook {
    /// Whether any strokes are linked: the mesh must have links then.
    #[must_use]
    pub fn is_linked(&self) -> bool {
        self.draws.iter().any(|draw| draw.is_linked)
    }
}

impl RendererOptions {
    /// What a renderer with these options comes to be: [`Layout::FaceNormals`] has no
    /// lists.
    #[must_use]
    pub fn possible(self) -> Self {
        match self.layout {
            Layout::FaceNormals => Self { path: DetectionPath::Vertex, ..self },
            _ => self,
        }
    }
}

impl Renderer {
    /// Builds the pipelines that every look needs.
    ///
    /// # Errors
    /// Where a shader cannot be put together.
    pub fn new(gpu: &Gpu, options: RendererOptions) -> Result<Self, ShaderError> {
        let device = &gpu.device;
        let options = options.possible();
        let frame = frame_layout(device);
        Ok(Self {
            layouts: StrokeLayouts::new(device, &frame, options.layout, &options.formats),
            detect: DetectPipeline::new(device, &frame, options.layout)?,
            fill: FillPipeline::new(device, &frame, &options.formats)?,
            graph: None,
            frame: Frame::new(device, &frame, &bytemuck::Zeroable::zeroed()),
            options,
            expand: HashMap::new(),
            strokes: HashMap::new(),
            indices: HashMap::new(),
            brushes: BrushTextures::new(device),
        })
    }

    /// What it is made for, as it turned out.
    #[must_use]
    pub const fn options(&self) -> &RendererOptions {
        &self.options
    }

    /// Prepares a look.
    ///
    /// # Errors
    /// Where a shader cannot be put together.
    ///
    /// # Panics
    /// Where the look has a silhouette and the targets have no stencil.
    pub fn prepare(&mut self, gpu: &Gpu, look: &Look) -> Result<Arc<PreparedLook>, ShaderError> {
        let has_stencil = self.options.formats.has_stencil();
        assert!(look.silhouette.is_none() || has_stencil, "a silhouette needs a stencil");
        let table = look.class_table();
        if look.is_linked() {
            self.make_graph(&gpu.device)?;
        }
        let mut draws = Vec::new();
        for (index, draw) in look.draws().iter_mut().enumerate() {
            if self.options.layout == Layout::FaceNormals {
                draw.style.kind = LineKind::Fin;
            }
            let style = style_group(gpu, &self.layouts, &mut self.brushes, draw, index, &table);
            let RendererOptions { path, layout, .. } = self.options;
            let mut pipeline = |source| self.stroke(gpu, StrokeVariant::new(source, draw));
            let kind = draw.style.kind;
            let lies_over_surface = draw.lies_over_surface();
            let vertices = match (path, layout) {
                (DetectionPath::Compute, _) => {
                    let listed = pipeline(VertexSource::Listed)?;
                    let expanded = if lies_over_surface || draw.style.is_linked() {
                        None
                    } else {
                        let drawn = pipeline(VertexSource::Expanded)?;
                        Some((self.expansion(gpu, kind)?, drawn))
                    };
                    DrawVertices::Lists { expanded, listed }
                }
                (DetectionPath::Vertex, Layout::Indexed) => {
                    DrawVertices::All(pipeline(VertexSource::All)?)
                }
                (DetectionPath::Vertex, _) => {
                    DrawVertices::Attributes(pipeline(VertexSource::Attributes)?)
                }
            };
            let visibility = draw.visibility;
            let is_linked = draw.style.is_linked() && path == DetectionPath::Compute;
            draws.push(PreparedDraw {
                layer: draw.layer,
                kind,
                visibility,
                lies_over_surface,
                is_linked,
                color: draw.style.color,
                reach_px: draw.style.reach_px(),
                is_textured: draw.style.brush.is_some(),
                style,
                vertices,
            });
        }
        let fill_kind = if look.fill_color.is_some() { FillKind::Whole } else { FillKind::Clear };
        Ok(Arc::new(PreparedLook {
            draws_contours: table.drawn & 1 << LineClass::Contour as u32 != 0,
            layer_count: edgemesh::index::to_u32(look.layers.len()).max(1),
            draws,
            detect_pass: self.detect.pass(&gpu.device, look),
            fill_pass: self.fill.pass(&gpu.device, look.fill_color.unwrap_or_default()),
            fill_kind,
            path_pass: self.graph.as_ref().map(|graph| graph.path.pass(&gpu.device, look)),
        }))
    }

    /// Prepares an object; its mesh must be in the renderer's layout.
    ///
    /// # Panics
    /// Where the mesh is in another layout, or has no links and the look needs them.
    #[must_use]
    pub fn object(
        &mut self,
        gpu: &Gpu,
        mesh: &Arc<MeshBuffers>,
        look: &Arc<PreparedLook>,
    ) -> Object {
        assert_eq!(mesh.layout, self.options.layout, "a mesh in the renderer's layout");
        assert!(
            !look.is_linked() || mesh.has_links(),
            "a mesh with links for strokes that are linked"
        );
        for draw in &look.draws {
            for chunk in &mesh.chunks {
                for key in IndexKey::of(draw) {
                    let count = match key {
                        IndexKey::Expanded(_) => chunk.size.capacity,
                        _ => chunk.size.edge_count,
                    };
                    self.make_indices(&gpu.device, key, count);
                }
            }
        }
        let object = Object::new(gpu, self, mesh.clone(), look.clone());
        if let Some(graph) = &object.graph {
            self.make_indices(&gpu.device, IndexKey::Quads, graph.buffers.size.points);
        }
        object
    }

    /// The pipelines of the stroke graph, once they are needed and can be used.
    fn make_graph(&mut self, device: &wgpu::Device) -> Result<(), ShaderError> {
        let RendererOptions { layout, path, formats } = &self.options;
        if *path == DetectionPath::Compute && self.graph.is_none() {
            self.graph = Some(GraphPipelines::new(device, &self.layouts, *layout, formats)?);
        }
        Ok(())
    }

    fn stroke(
        &mut self,
        gpu: &Gpu,
        variant: StrokeVariant,
    ) -> Result<wgpu::RenderPipeline, ShaderError> {
        Ok(match self.strokes.entry(variant) {
            Entry::Occupied(known) => known.get().clone(),
            Entry::Vacant(new) => {
                let RendererOptions { layout, formats, .. } = &self.options;
                let made = stroke_pipeline(&gpu.device, &self.layouts, *layout, formats, variant)?;
                new.insert(made).clone()
            }
        })
    }

    fn expansion(&mut self, gpu: &Gpu, kind: LineKind) -> Result<Arc<ExpandPipeline>, ShaderError> {
        Ok(match self.expand.entry(kind) {
            Entry::Occupied(known) => known.get().clone(),
            Entry::Vacant(new) => {
                let layout = self.options.layout;
                let made = ExpandPipeline::new(&gpu.device, &self.layouts, layout, kind)?;
                new.insert(Arc::new(made)).clone()
            }
        })
    }

    fn make_indices(&mut self, device: &wgpu::Device, key: IndexKey, count: u32) {
        if self.indices.get(&key).is_none_or(|known| known.count < count) {
            self.indices.insert(key, IndexBuffer::new(device, key, count));
        }
    }

    /// Submits one frame of `objects` as `view` sees them, over `background`
    /// (premultiplied).
    pub fn render(
        &self,
        gpu: &Gpu,
        targets: &Targets,
        view: &View,
        background: [f64; 4],
        objects: &mut [Object],
        timer: Option<&GpuTimer>,
    ) {
        let part = PicturePart::whole(targets.viewport_px());
        let uniform = FrameUniform::new(view, &part, &Surroundings::default());
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let frame = FrameRequest {
            targets,
            view,
            uniform: &uniform,
            fill: Fill::Clear(background),
            overview: None,
            resolves: true,
            timer: timer.map(|timer| timer.passes_from(0)),
        };
        self.encode(gpu, &mut encoder, objects, &frame);
        if let Some(timer) = timer {
            timer.resolve(&mut encoder);
        }
        gpu.queue.submit([encoder.finish()]);
    }

    /// Encodes a frame of `objects`, to be submitted before the next one is encoded.
    pub fn encode(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        objects: &mut [Object],
        frame: &FrameRequest,
    ) {
        let FrameRequest { targets, view, timer, .. } = *frame;
        self.frame.write(&gpu.queue, frame.uniform);
        for object in objects.iter_mut() {
            object.look_from(gpu, view, frame.uniform);
        }
        let placed: Vec<&Object> = objects.iter().filter(|object| object.is_placed).collect();
        self.encode_detect(encoder, &placed, timer);
        self.encode_link(encoder, &placed, timer);
        self.encode_expand(encoder, &placed, timer);
        let asks_for_fill = |object: &&Object| {
            object.look.draws.iter().any(|draw| draw.lies_over_surface || draw.is_linked)
        };
        let asks_for_fill = placed.iter().any(asks_for_fill);
        let with_fill = |targets: &Targets| {
            asks_for_fill
                .then(|| self.frame.with_fill(&gpu.device, &self.layouts.frame_fill, targets))
        };
        let steps = DrawStep::plan(&placed);
        let resolves = frame.resolves;
        let encode = FrameEncoder {
            renderer: self,
            targets,
            objects: &placed,
            frame_fill: with_fill(targets),
            overview_fill: frame.overview.and_then(with_fill),
            steps,
            resolves,
            clips: frame.uniform.clip_plane_count > 0,
        };
        let values = encode.stencil_values();
        encode.encode_fill(encoder, frame.fill, &values, timer);
        encode.encode_paths(encoder, timer);
        let coverage = targets.coverage(&gpu.device, encode.batches().count());
        encode.encode_coverage(encoder, &coverage, timer);
        let laid = encode.composite_groups(&gpu.device, &coverage);
        encode.encode_strokes(encoder, &values, &laid, timer);
        for object in objects.iter_mut().filter(|object| object.is_placed) {
            object.is_stale = false;
        }
    }

    fn encode_detect(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        objects: &[&Object],
        timer: Option<TimedPasses>,
    ) {
        for object in objects {
            let tallies = &object.whole.tallies;
            DetectPipeline::clear(encoder, tallies, object.parts.len(), object.is_stale);
        }
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some(PASS_NAMES[0]),
            timestamp_writes: timer.map(|timer| timer.compute(0)),
        });
        pass.set_bind_group(0, &self.frame.bind_group, &[]);
        for object in objects.iter().filter(|object| !object.look.draws.is_empty()) {
            pass.set_bind_group(1, &object.look.detect_pass, &[]);
            for lists in object.parts.iter().filter_map(|part| part.lists.as_ref()) {
                self.detect.record(&mut pass, &lists.detect, object.is_stale);
            }
        }
    }

    fn encode_link(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        objects: &[&Object],
        timer: Option<TimedPasses>,
    ) {
        let graphs = || objects.iter().filter_map(|object| object.graph.as_ref());
        for graph in graphs() {
            LinkPipeline::clear(encoder, &graph.buffers);
        }
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some(PASS_NAMES[1]),
            timestamp_writes: timer.map(|timer| timer.compute(1)),
        });
        pass.set_bind_group(0, &self.frame.bind_group, &[]);
        let Some(pipelines) = &self.graph else { return };
        for graph in graphs() {
            pass.set_bind_group(1, &graph.uniform, &[]);
            pipelines.link.record(&mut pass, &graph.buffers, &graph.link);
        }
    }

    fn encode_expand(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        objects: &[&Object],
        timer: Option<TimedPasses>,
    ) {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some(PASS_NAMES[2]),
            timestamp_writes: timer.map(|timer| timer.compute(2)),
        });
        pass.set_bind_group(0, &self.frame.bind_group, &[]);
        for object in objects {
            for (index, draw) in object.look.draws.iter().enumerate() {
                let DrawVertices::Lists { expanded: Some((expand, _)), .. } = &draw.vertices else {
                    continue;
                };
                pass.set_bind_group(1, &draw.style, &[]);
                for part in &object.parts {
                    let Some(lists) = &part.lists else { continue };
                    let Some(group) = &lists.expand[index] else { continue };
                    pass.set_bind_group(2, &part.edges, &[]);
                    expand.record(&mut pass, group, &lists.view, index);
                }
            }
        }
    }

    pub(crate) fn set_indices(&self, pass: &mut wgpu::RenderPass, key: IndexKey) {
        if let Some(indices) = self.indices.get(&key) {
            pass.set_index_buffer(indices.buffer.slice(..), wgpu::IndexFormat::Uint32);
        }
    }
}
