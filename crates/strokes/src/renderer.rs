//! One frame: detect, expand, fill, strokes, in one command buffer and without
//! reading anything back.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::sync::Arc;

use edgemesh::camera::View;
use edgemesh::oracle::feature::EdgeClass;
use edgemesh::oracle::stroke_segment::LineKind;
use wgpu::util::DeviceExt as _;

use crate::detect::DetectPipeline;
use crate::expand::ExpandPipeline;
use crate::fill::{FillKind, FillPipeline};
use crate::frame::{Frame, FrameUniform, frame_layout};
use crate::gpu::Gpu;
use crate::gpu_time::GpuTimer;
use crate::graph::GraphPipelines;
use crate::graph::buffers::RIBBON_DRAWS;
use crate::graph::coverage::CHANNELS;
use crate::graph::link::LinkPipeline;
use crate::look::{Look, Visibility};
use crate::mesh_buffers::{Layout, MeshBuffers};
use crate::object::{Object, ObjectPart};
use crate::shader::ShaderError;
use crate::silhouette::{NO_OBJECT, StencilValues};
use crate::stroke::{StrokeVariant, VertexSource, stroke_pipeline, style_group};
use crate::stroke_layouts::StrokeLayouts;
use crate::targets::{TargetFormats, Targets};
use crate::view_buffers::{DrawArguments, REST_OFFSET};

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
    frame: Frame,
    expand: HashMap<LineKind, Arc<ExpandPipeline>>,
    strokes: HashMap<StrokeVariant, wgpu::RenderPipeline>,
    indices: HashMap<IndexKey, IndexBuffer>,
}

/// A look with its pipelines and its textures.
#[derive(Debug)]
pub struct PreparedLook {
    pub(crate) layer_count: u32,
    /// Whether contours are in a layer as such.
    pub(crate) draws_contours: bool,
    pub(crate) draws: Vec<PreparedDraw>,
    detect_pass: wgpu::BindGroup,
    fill_pass: wgpu::BindGroup,
    fill_kind: FillKind,
    /// The styles of linked strokes, where there are such.
    path_pass: Option<wgpu::BindGroup>,
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
    color: [f32; 4],
    is_textured: bool,
    style: wgpu::BindGroup,
    vertices: DrawVertices,
}

#[derive(Debug)]
enum DrawVertices {
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

impl Renderer {
    /// Builds the pipelines that every look needs.
    ///
    /// # Errors
    /// Where a shader cannot be put together.
    pub fn new(gpu: &Gpu, mut options: RendererOptions) -> Result<Self, ShaderError> {
        let device = &gpu.device;
        if options.layout == Layout::FaceNormals {
            options.path = DetectionPath::Vertex;
        }
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
        if look.draws().iter().any(|draw| draw.style.is_linked()) {
            self.make_graph(&gpu.device)?;
        }
        let mut draws = Vec::new();
        for (index, draw) in look.draws().iter_mut().enumerate() {
            if self.options.layout == Layout::FaceNormals {
                draw.style.kind = LineKind::Fin;
            }
            let style = style_group(gpu, &self.layouts, draw, index, &table);
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
                is_textured: draw.style.brush.is_some(),
                style,
                vertices,
            });
        }
        let fill_kind = if look.fill_color.is_some() { FillKind::Whole } else { FillKind::Clear };
        Ok(Arc::new(PreparedLook {
            draws_contours: table.drawn & 1 << EdgeClass::Contour as u32 != 0,
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
        let viewport_px = targets.viewport_px();
        self.frame.write(&gpu.queue, &FrameUniform::new(view, viewport_px));
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        for object in objects.iter_mut() {
            object.look_from(gpu, view, viewport_px);
        }
        let placed: Vec<&Object> = objects.iter().filter(|object| object.is_placed).collect();
        self.encode_detect(&mut encoder, &placed, timer);
        self.encode_link(&mut encoder, &placed, timer);
        self.encode_expand(&mut encoder, &placed, timer);
        let asks_for_fill = |object: &&Object| {
            object.look.draws.iter().any(|draw| draw.lies_over_surface || draw.is_linked)
        };
        let frame_fill = placed
            .iter()
            .any(asks_for_fill)
            .then(|| self.frame.with_fill(&gpu.device, &self.layouts.frame_fill, targets));
        let steps = DrawStep::plan(&placed);
        let frame = FrameEncoder { renderer: self, targets, objects: &placed, frame_fill, steps };
        let values = frame.stencil_values();
        frame.encode_fill(&mut encoder, background, &values, timer);
        frame.encode_paths(&mut encoder, timer);
        let coverage = targets.coverage(&gpu.device, frame.batches().count());
        frame.encode_coverage(&mut encoder, &coverage, timer);
        let laid = frame.composite_groups(&gpu.device, &coverage);
        frame.encode_strokes(&mut encoder, &values, &laid, timer);
        if let Some(timer) = timer {
            timer.resolve(&mut encoder);
        }
        gpu.queue.submit([encoder.finish()]);
        for object in objects.iter_mut().filter(|object| object.is_placed) {
            object.is_stale = false;
        }
    }

    fn encode_detect(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        objects: &[&Object],
        timer: Option<&GpuTimer>,
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
        timer: Option<&GpuTimer>,
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
        timer: Option<&GpuTimer>,
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

    fn set_indices(&self, pass: &mut wgpu::RenderPass, key: IndexKey) {
        if let Some(indices) = self.indices.get(&key) {
            pass.set_index_buffer(indices.buffer.slice(..), wgpu::IndexFormat::Uint32);
        }
    }
}

/// The part of a frame that draws.
struct FrameEncoder<'a> {
    renderer: &'a Renderer,
    targets: &'a Targets,
    objects: &'a [&'a Object],
    /// The frame with what was filled, where a draw asks for it.
    frame_fill: Option<wgpu::BindGroup>,
    steps: Vec<DrawStep>,
}

/// What is drawn at once, in the order of a frame.
enum DrawStep {
    /// The strokes of an object and one of its draws, edge by edge.
    Edges { object: usize, draw: usize },
    /// Linked strokes: up to four draws, each of all objects with that look.
    Linked(Vec<LinkedDraw>),
}

struct LinkedDraw {
    objects: Vec<usize>,
    draw: usize,
}

impl DrawStep {
    /// All but silhouettes that are drawn edge by edge, which need the stencil.
    fn plan(objects: &[&Object]) -> Vec<Self> {
        let mut steps: Vec<Self> = Vec::new();
        for visibility in [Visibility::Hidden, Visibility::Visible, Visibility::Silhouette] {
            for (object, placed) in objects.iter().enumerate() {
                let draws = placed.look.draws.iter().enumerate();
                for (draw, prepared) in draws.filter(|(_, draw)| draw.visibility == visibility) {
                    if prepared.is_linked {
                        Self::add_linked(&mut steps, objects, object, draw);
                    } else if visibility != Visibility::Silhouette {
                        steps.push(Self::Edges { object, draw });
                    }
                }
            }
        }
        steps
    }

    /// Objects that look alike share a channel, so that a scene has as many as it has
    /// looks.
    fn add_linked(steps: &mut Vec<Self>, objects: &[&Object], object: usize, draw: usize) {
        let is_same = |linked: &LinkedDraw| {
            let look = &objects[linked.objects[0]].look;
            linked.draw == draw && Arc::ptr_eq(look, &objects[object].look)
        };
        let linked = steps.iter_mut().filter_map(|step| match step {
            Self::Linked(draws) => Some(draws),
            Self::Edges { .. } => None,
        });
        if let Some(same) = linked.flatten().find(|linked| is_same(linked)) {
            same.objects.push(object);
            return;
        }
        let new = LinkedDraw { objects: vec![object], draw };
        match steps.last_mut() {
            Some(Self::Linked(draws)) if draws.len() < CHANNELS => draws.push(new),
            _ => steps.push(Self::Linked(vec![new])),
        }
    }
}

/// The stencil values of the objects, cut where the stencil must be cleared.
struct StencilBatches {
    /// One an object; [`NO_OBJECT`] for those without a silhouette.
    values: Vec<u32>,
    /// The first object of each batch behind the first one.
    clears: Vec<usize>,
}

impl StencilBatches {
    /// The objects of each batch, as ranges.
    fn ranges(&self) -> Vec<std::ops::Range<usize>> {
        let starts = std::iter::once(0).chain(self.clears.iter().copied());
        let ends = self.clears.iter().copied().chain([self.values.len()]);
        starts.zip(ends).map(|(start, end)| start..end).collect()
    }
}

impl FrameEncoder<'_> {
    fn stencil_values(&self) -> StencilBatches {
        let mut counter = StencilValues::default();
        let mut batches = StencilBatches { values: Vec::new(), clears: Vec::new() };
        for (index, object) in self.objects.iter().enumerate() {
            if !object.has_silhouette() {
                batches.values.push(NO_OBJECT);
                continue;
            }
            let (value, must_clear) = counter.next();
            batches.values.push(value);
            if must_clear {
                batches.clears.push(index);
            }
        }
        batches
    }

    fn encode_fill(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        [r, g, b, a]: [f64; 4],
        batches: &StencilBatches,
        timer: Option<&GpuTimer>,
    ) {
        let background = wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a });
        let color = self.targets.color_attachment(background, false);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(PASS_NAMES[3]),
            color_attachments: &[Some(color)],
            depth_stencil_attachment: Some(self.targets.cleared_depth()),
            timestamp_writes: timer.map(|timer| timer.render(3)),
            ..Default::default()
        });
        let first_batch = batches.clears.first().copied().unwrap_or(self.objects.len());
        for (index, object) in self.objects.iter().enumerate() {
            let value = if index < first_batch { batches.values[index] } else { NO_OBJECT };
            self.fill(&mut pass, object, object.look.fill_kind, value);
        }
    }

    fn fill(&self, pass: &mut wgpu::RenderPass, object: &Object, kind: FillKind, value: u32) {
        self.renderer.fill.set(pass, kind);
        pass.set_bind_group(0, &self.renderer.frame.bind_group, &[]);
        pass.set_bind_group(1, &object.look.fill_pass, &[]);
        pass.set_bind_group(2, &object.fill_group, &[]);
        pass.set_stencil_reference(value);
        FillPipeline::record(pass, &object.mesh);
    }

    fn batches(&self) -> impl Iterator<Item = &[LinkedDraw]> {
        self.steps.iter().filter_map(|step| match step {
            DrawStep::Linked(draws) => Some(&draws[..]),
            DrawStep::Edges { .. } => None,
        })
    }

    /// From chains to ribbons, by the depth of the fill.
    fn encode_paths(&self, encoder: &mut wgpu::CommandEncoder, timer: Option<&GpuTimer>) {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some(PASS_NAMES[4]),
            timestamp_writes: timer.map(|timer| timer.compute(4)),
        });
        let Some((frame, pipelines)) = self.frame_fill.as_ref().zip(self.renderer.graph.as_ref())
        else {
            return;
        };
        pass.set_bind_group(0, frame, &[]);
        for object in self.objects {
            if let Some((graph, styles)) = object.graph.as_ref().zip(object.look.path_pass.as_ref())
            {
                pass.set_bind_group(1, styles, &[]);
                pipelines.path.record(&mut pass, &graph.buffers, &graph.path);
            }
        }
    }

    /// The coverage of linked strokes, one texture a batch.
    fn encode_coverage(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        textures: &[wgpu::TextureView],
        timer: Option<&GpuTimer>,
    ) {
        if textures.is_empty() {
            // The timer expects every pass.
            encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some(PASS_NAMES[5]),
                timestamp_writes: timer.map(|timer| timer.compute(5)),
            });
        }
        let Some(pipelines) = &self.renderer.graph else { return };
        for (batch, (draws, texture)) in self.batches().zip(textures).enumerate() {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some(PASS_NAMES[5]),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: texture,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                timestamp_writes: timer.filter(|_| batch == 0).map(|timer| timer.render(5)),
                ..Default::default()
            });
            pass.set_bind_group(0, &self.renderer.frame.bind_group, &[]);
            self.renderer.set_indices(&mut pass, IndexKey::Quads);
            for (channel, linked) in draws.iter().enumerate() {
                for object in linked.objects.iter().map(|&object| self.objects[object]) {
                    let Some(graph) = &object.graph else { continue };
                    let draw = &object.look.draws[linked.draw];
                    pipelines.coverage.set_ribbons(&mut pass, channel, draw.is_textured);
                    pass.set_bind_group(1, &draw.style, &[]);
                    pass.set_bind_group(3, &graph.ribbons, &[]);
                    let at = 4 * (RIBBON_DRAWS + 5 * linked.draw) as u64;
                    pass.draw_indexed_indirect(&graph.buffers.arguments, at);
                }
            }
        }
    }

    /// How each batch of coverage is laid over the picture.
    fn composite_groups(
        &self,
        device: &wgpu::Device,
        textures: &[wgpu::TextureView],
    ) -> Vec<wgpu::BindGroup> {
        let Some(pipelines) = &self.renderer.graph else { return Vec::new() };
        let group = |(draws, texture): (&[LinkedDraw], &wgpu::TextureView)| {
            let mut colors = [[0.0; 4]; CHANNELS];
            for (color, linked) in colors.iter_mut().zip(draws) {
                *color = self.objects[linked.objects[0]].look.draws[linked.draw].color;
            }
            pipelines.coverage.composite_group(device, colors, texture)
        };
        self.batches().zip(textures).map(group).collect()
    }

    /// What the steps say, in order.
    fn draw_steps(&self, pass: &mut wgpu::RenderPass, laid: &[wgpu::BindGroup], values: &[u32]) {
        let mut laid = laid.iter();
        for step in &self.steps {
            match step {
                DrawStep::Edges { object, draw } => {
                    self.strokes(pass, self.objects[*object], *draw)
                }
                DrawStep::Linked(draws) => {
                    let pipelines = self.renderer.graph.as_ref();
                    if let Some((pipelines, group)) = pipelines.zip(laid.next()) {
                        pipelines.coverage.record_composite(pass, group, draws.len());
                    }
                    // What found no room to be linked.
                    for linked in draws {
                        for &object in &linked.objects {
                            pass.set_stencil_reference(values[object]);
                            self.strokes(pass, self.objects[object], linked.draw);
                        }
                    }
                }
            }
        }
    }

    fn encode_strokes(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        batches: &StencilBatches,
        laid: &[wgpu::BindGroup],
        timer: Option<&GpuTimer>,
    ) {
        let ranges = batches.ranges();
        for (batch, range) in ranges.iter().enumerate() {
            let is_first = batch == 0;
            if !is_first {
                self.encode_marks(encoder, range.clone(), &batches.values);
            }
            let is_last = batch + 1 == ranges.len();
            let color = self.targets.color_attachment(wgpu::LoadOp::Load, is_last);
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some(PASS_NAMES[6]),
                color_attachments: &[Some(color)],
                depth_stencil_attachment: Some(self.targets.read_depth()),
                timestamp_writes: timer.filter(|_| is_first).map(|timer| timer.render(6)),
                ..Default::default()
            });
            if is_first {
                self.draw_steps(&mut pass, laid, &batches.values);
            }
            for index in range.clone().filter(|&index| batches.values[index] != NO_OBJECT) {
                pass.set_stencil_reference(batches.values[index]);
                let object = self.objects[index];
                for (draw, prepared) in object.look.draws.iter().enumerate() {
                    if prepared.visibility == Visibility::Silhouette && !prepared.is_linked {
                        self.strokes(&mut pass, object, draw);
                    }
                }
            }
        }
    }

    /// Clears the stencil and marks a further batch of objects in it.
    fn encode_marks(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        range: std::ops::Range<usize>,
        values: &[u32],
    ) {
        let color = self.targets.color_attachment(wgpu::LoadOp::Load, false);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("marks"),
            color_attachments: &[Some(color)],
            depth_stencil_attachment: Some(self.targets.cleared_stencil()),
            ..Default::default()
        });
        for index in range {
            self.fill(&mut pass, self.objects[index], FillKind::Mark, values[index]);
        }
    }

    /// The strokes of a draw, edge by edge.
    fn strokes(&self, pass: &mut wgpu::RenderPass, object: &Object, index: usize) {
        if let Some(draw) = object.look.draws.get(index) {
            let frame = &self.renderer.frame.bind_group;
            let frame =
                self.frame_fill.as_ref().filter(|_| draw.lies_over_surface).unwrap_or(frame);
            pass.set_bind_group(0, frame, &[]);
            pass.set_bind_group(1, &draw.style, &[]);
            for (chunk, part) in object.mesh.chunks.iter().zip(&object.parts) {
                match &draw.vertices {
                    DrawVertices::Lists { expanded, listed } => {
                        let expanded = expanded.as_ref().map(|(_, pipeline)| pipeline);
                        self.listed_strokes(pass, part, draw, index, expanded, listed);
                    }
                    DrawVertices::All(pipeline) => {
                        let index_count = edgemesh::index::to_u32(draw.kind.indices().len());
                        pass.set_pipeline(pipeline);
                        pass.set_bind_group(2, &part.edges, &[]);
                        pass.set_bind_group(3, part.planes.as_ref(), &[]);
                        pass.draw(0..index_count * chunk.size.edge_count, 0..1);
                    }
                    DrawVertices::Attributes(pipeline) => {
                        let crate::mesh_buffers::EdgeSource::Replicated { vertices } =
                            &chunk.source
                        else {
                            continue;
                        };
                        pass.set_pipeline(pipeline);
                        pass.set_bind_group(2, &part.edges, &[]);
                        pass.set_vertex_buffer(0, vertices.slice(..));
                        self.attribute_strokes(pass, draw.kind, chunk.size.edge_count);
                    }
                }
            }
        }
    }

    /// What was expanded, then the rest of the list.
    fn listed_strokes(
        &self,
        pass: &mut wgpu::RenderPass,
        part: &ObjectPart,
        draw: &PreparedDraw,
        index: usize,
        expanded: Option<&wgpu::RenderPipeline>,
        listed: &wgpu::RenderPipeline,
    ) {
        let Some(lists) = &part.lists else { return };
        let arguments = (index * size_of::<DrawArguments>()) as u64;
        if let (Some(expanded), Some(vertices)) = (expanded, &lists.view.vertices[index]) {
            pass.set_pipeline(expanded);
            pass.set_vertex_buffer(0, vertices.slice(..));
            self.renderer.set_indices(pass, IndexKey::Expanded(draw.kind));
            pass.draw_indexed_indirect(&lists.view.draws, arguments);
        }
        pass.set_pipeline(listed);
        pass.set_bind_group(2, &part.edges, &[]);
        pass.set_bind_group(3, &lists.listed, &[]);
        pass.draw_indirect(&lists.view.draws, arguments + REST_OFFSET);
    }

    /// The paper's passes: all quads, then all ends, a triangle of each at a time.
    fn attribute_strokes(&self, pass: &mut wgpu::RenderPass, kind: LineKind, edge_count: u32) {
        let key = if kind == LineKind::Thin { IndexKey::Lines } else { IndexKey::Quads };
        let per_edge = edgemesh::index::to_u32(key.pattern().0.len());
        self.renderer.set_indices(pass, key);
        pass.draw_indexed(0..per_edge * edge_count, 0, 0..1);
        let parts = edgemesh::index::to_u32(kind.indices().len() / 3).saturating_sub(2);
        if parts > 0 {
            self.renderer.set_indices(pass, IndexKey::Ends);
            pass.draw_indexed(0..3 * edge_count, 0, 1..1 + parts);
        }
    }
}

/// Index buffers that all meshes share.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum IndexKey {
    /// Vertices that were expanded.
    Expanded(LineKind),
    /// Of four vertices an edge the first two.
    Lines,
    /// The quads of four vertices an edge.
    Quads,
    /// One triangle of an end from four vertices an edge.
    Ends,
}

impl IndexKey {
    fn of(draw: &PreparedDraw) -> Vec<Self> {
        match &draw.vertices {
            DrawVertices::Lists { expanded: None, .. } => Vec::new(),
            DrawVertices::Lists { .. } => vec![Self::Expanded(draw.kind)],
            DrawVertices::All(_) => Vec::new(),
            DrawVertices::Attributes(_) => vec![Self::Lines, Self::Quads, Self::Ends],
        }
    }

    /// The indices of the first edge, and how many vertices an edge has.
    fn pattern(self) -> (Vec<u32>, u32) {
        match self {
            Self::Expanded(kind) => (kind.indices(), kind.vertex_count()),
            Self::Lines => (vec![0, 1], 4),
            Self::Quads => (vec![0, 1, 2, 0, 2, 3], 4),
            Self::Ends => (vec![0, 1, 2], 4),
        }
    }
}

#[derive(Debug)]
struct IndexBuffer {
    count: u32,
    buffer: wgpu::Buffer,
}

impl IndexBuffer {
    fn new(device: &wgpu::Device, key: IndexKey, count: u32) -> Self {
        let (pattern, stride) = key.pattern();
        let of_edge = |edge: u32| pattern.iter().map(move |&vertex| vertex + stride * edge);
        let indices: Vec<u32> = (0..count.max(1)).flat_map(of_edge).collect();
        let buffer = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("stroke indices"),
            contents: bytemuck::cast_slice(&indices),
            usage: wgpu::BufferUsages::INDEX,
        });
        Self { count, buffer }
    }
}
