//! The instances of a scene in their styles, with their lists and stroke graphs.
//!
//! Lists and stroke graphs stay from frame to frame, and from style to style if those have the
//! same shape. A drawing belongs to one eye, and to renderers with the same options.

use std::sync::Arc;

use edgemesh::index::to_u32;

use crate::draw::stroke_indices::IndexKey;
use crate::gpu::bind::{bind_buffers, uniform_buffer};
use crate::gpu::device::Gpu;
use crate::gpu::readback::{PendingRead, ReadbackError, read_buffer, read_buffers};
use crate::graph::buffers::{GraphBuffers, GraphUniform};
use crate::graph::link::{LinkBindings, LinkedChunk};
use crate::graph::path::PathBindings;
use crate::graph::readback::GraphReadback;
use crate::mesh::buffers::{ChunkBuffers, MeshBuffers};
use crate::mesh::geometry::{ChunkGeometry, EdgeGeometry};
use crate::mesh::instance::MeshInstance;
use crate::mesh::layout::ChunkUniform;
use crate::render::error::RenderError;
use crate::render::frame_request::{FrameRequest, PASS_NAMES};
use crate::render::options::{DetectionStage, RendererOptions};
use crate::render::pipelines::Pipelines;
use crate::render::prepared_style::{ListShape, PreparedStyle};
use crate::view::detect::DetectBindings;
use crate::view::live_lists::{ChunkLists, ObjectRuns, Tally};
use crate::view::view_state::ObjectState;

/// The instances of a scene in their styles, with the lists and stroke graphs of the last frame.
#[derive(Debug, Default)]
pub struct Drawing {
    /// Those of the renderer that updated the drawing.
    options: Option<RendererOptions>,
    objects: Vec<DrawnObject>,
}

/// An instance in its style, with the lists and the stroke graph of the last frame.
#[derive(Debug)]
pub struct DrawnObject {
    pub(crate) instance: MeshInstance,
    pub(crate) style: Arc<PreparedStyle>,
    /// The object's uniform in the view state.
    uniform: wgpu::Buffer,
    shape: ListShape,
    /// `@group(2)` of the fill.
    pub(crate) fill: wgpu::BindGroup,
    pub(crate) chunks: Vec<DrawnChunk>,
    pub(crate) runs: ObjectRuns,
    /// If strokes are linked.
    pub(crate) graph: Option<ObjectGraph>,
    /// Whether the static edges must be found again.
    pub(crate) is_stale: bool,
}

/// The stroke graph of an object.
#[derive(Debug)]
pub(crate) struct ObjectGraph {
    pub(crate) buffers: GraphBuffers,
    /// `@group(1)` of its passes.
    pub(crate) uniform: wgpu::BindGroup,
    pub(crate) link: LinkBindings,
    pub(crate) path: PathBindings,
    /// `@group(3)` of its ribbons.
    pub(crate) ribbons: wgpu::BindGroup,
}

/// One chunk of an object.
#[derive(Debug)]
pub(crate) struct DrawnChunk {
    /// `@group(2)` of its edges.
    pub(crate) edges: wgpu::BindGroup,
    /// `@group(3)` if every edge is drawn by its index.
    pub(crate) planes: Option<wgpu::BindGroup>,
    /// If compute shaders detect.
    pub(crate) lists: Option<BoundLists>,
}

/// The lists of a chunk, with their bind groups.
#[derive(Debug)]
pub(crate) struct BoundLists {
    pub(crate) lists: ChunkLists,
    pub(crate) detect: DetectBindings,
    /// `@group(3)` of the expansion, one per stroke set.
    pub(crate) expand: Vec<Option<wgpu::BindGroup>>,
    /// `@group(3)` of strokes from the list.
    pub(crate) listed: wgpu::BindGroup,
}

impl Drawing {
    /// An empty drawing, for [`Renderer::encode`](crate::Renderer::encode).
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The objects, in the order of the instances.
    #[must_use]
    pub fn objects(&self) -> &[DrawnObject] {
        &self.objects
    }

    /// The counts of all objects in the last frame, zero if vertex shaders detect; waits for all
    /// submitted work.
    ///
    /// # Errors
    /// [`ReadbackError`], if the device is lost or has no memory for the copy.
    pub fn read_tally(&self, gpu: &Gpu) -> Result<Tally, ReadbackError> {
        let tallies: Vec<Tally> = read_buffers(gpu, &self.tallies())?;
        Ok(tallies.iter().fold(Tally::default(), |sum, tally| sum.plus(tally)))
    }

    /// Begins to read the counts of each chunk of each object in the last frame.
    ///
    /// # Errors
    /// As [`Self::read_tally`].
    pub fn begin_read_tallies(&self, gpu: &Gpu) -> Result<PendingRead<Tally>, ReadbackError> {
        PendingRead::begin_all(gpu, &self.tallies())
    }

    /// The counts of the objects, with the number of chunks of each.
    fn tallies(&self) -> Vec<(&wgpu::Buffer, usize)> {
        self.objects.iter().map(|object| (&object.runs.tallies, object.chunks.len())).collect()
    }

    pub(crate) fn objects_mut(&mut self) -> &mut [DrawnObject] {
        &mut self.objects
    }

    /// Takes over the instances and styles of `request`; keeps lists and graphs that fit.
    pub(crate) fn update(
        &mut self,
        gpu: &Gpu,
        pipelines: &mut Pipelines,
        request: &FrameRequest,
    ) -> Result<(), RenderError> {
        check(&pipelines.options, request)?;
        let FrameRequest { view, instances, styles, .. } = *request;
        if self.options.replace(pipelines.options) != Some(pipelines.options) {
            self.objects.clear();
        }
        // Another renderer with the same options may have prepared the styles.
        if styles.iter().any(|style| style.is_linked()) {
            pipelines.build_graph(&gpu.device)?;
        }
        self.objects.truncate(instances.len());
        for (at, (instance, style)) in instances.iter().zip(styles).enumerate() {
            grow_indices(&gpu.device, pipelines, instance.mesh(), style);
            let state = &view.objects()[at];
            let known = self.objects.get_mut(at).filter(|known| known.fits(instance, state));
            match known {
                Some(known) => known.restyle(&gpu.device, pipelines, instance, style),
                None => {
                    let new = DrawnObject::new(&gpu.device, pipelines, instance, style, state);
                    if at < self.objects.len() {
                        self.objects[at] = new;
                    } else {
                        self.objects.push(new);
                    }
                }
            }
            if let Some(graph) = &self.objects[at].graph {
                let points = graph.buffers.size.points;
                pipelines.grow_indices(&gpu.device, IndexKey::Quads, points);
            }
        }
        Ok(())
    }
}

/// Whether the parts of a frame fit the renderer's options and each other.
fn check(options: &RendererOptions, request: &FrameRequest) -> Result<(), RenderError> {
    let FrameRequest { view, instances, styles, .. } = *request;
    for targets in [Some(request.targets), request.overview].into_iter().flatten() {
        if *targets.formats() != options.formats {
            let targets = *targets.formats();
            return Err(RenderError::Formats { targets, renderer: options.formats });
        }
    }
    let needed = to_u32(PASS_NAMES.len());
    if let Some(passes) = request.timer.map(|timer| timer.count()).filter(|&has| has < needed) {
        return Err(RenderError::ShortTimer { passes, needed });
    }
    if styles.len() != instances.len() {
        return Err(RenderError::StyleCount { styles: styles.len(), instances: instances.len() });
    }
    if view.objects().len() != instances.len() {
        let (view, instances) = (view.objects().len(), instances.len());
        return Err(RenderError::ViewState { view, instances });
    }
    for (instance, style) in instances.iter().zip(styles) {
        if style.options != *options {
            return Err(RenderError::OtherRenderer);
        }
        let mesh = instance.mesh().options();
        if mesh.layout != options.layout {
            return Err(RenderError::Layout { mesh: mesh.layout, renderer: options.layout });
        }
        if style.is_linked() && !mesh.links {
            return Err(RenderError::NoLinks);
        }
    }
    Ok(())
}

fn grow_indices(
    device: &wgpu::Device,
    pipelines: &mut Pipelines,
    mesh: &MeshBuffers,
    style: &PreparedStyle,
) {
    for key in style.sets.iter().flat_map(|set| set.index_keys()) {
        for chunk in &mesh.chunks {
            pipelines.grow_indices(
                device,
                key,
                match key {
                    IndexKey::Expanded(_) => chunk.size.capacity,
                    _ => chunk.size.edge_count,
                },
            );
        }
    }
}

impl DrawnObject {
    fn new(
        device: &wgpu::Device,
        pipelines: &Pipelines,
        instance: &MeshInstance,
        style: &Arc<PreparedStyle>,
        state: &ObjectState,
    ) -> Self {
        let mesh = instance.mesh();
        let sizes: Vec<ChunkUniform> = mesh.chunks.iter().map(|chunk| chunk.size).collect();
        let binder = Binder {
            device,
            pipelines,
            uniform: state.uniform(),
            runs: &ObjectRuns::new(device, &sizes),
            shape: &style.list_shape(),
        };
        let chunks = mesh.chunks.iter().zip(&instance.geometry().chunks);
        let chunks: Vec<DrawnChunk> =
            chunks.map(|(chunk, geometry)| binder.chunk(chunk, geometry)).collect();
        Self {
            graph: binder.graph(instance, &chunks, style),
            fill: pipelines.fill.bind(device, state.uniform()),
            uniform: state.uniform().clone(),
            shape: binder.shape.clone(),
            runs: binder.runs.clone(),
            chunks,
            instance: instance.clone(),
            style: style.clone(),
            is_stale: true,
        }
    }

    /// Whether the object is of this instance's mesh and geometry, as this eye sees it.
    fn fits(&self, instance: &MeshInstance, state: &ObjectState) -> bool {
        Arc::ptr_eq(self.instance.mesh(), instance.mesh())
            && Arc::ptr_eq(self.instance.geometry(), instance.geometry())
            && self.uniform == *state.uniform()
    }

    /// Takes over another style or place.
    fn restyle(
        &mut self,
        device: &wgpu::Device,
        pipelines: &Pipelines,
        instance: &MeshInstance,
        style: &Arc<PreparedStyle>,
    ) {
        self.instance = instance.clone();
        if Arc::ptr_eq(&self.style, style) {
            return;
        }
        let shape = style.list_shape();
        self.is_stale |= self.style.classes != style.classes;
        let binder =
            Binder { device, pipelines, uniform: &self.uniform, runs: &self.runs, shape: &shape };
        if shape != self.shape {
            let chunks = instance.mesh().chunks.iter().zip(&instance.geometry().chunks);
            self.chunks = chunks.map(|(chunk, geometry)| binder.chunk(chunk, geometry)).collect();
            self.graph = binder.graph(instance, &self.chunks, style);
        } else if let Some(graph) = &mut self.graph
            && let Some(uniform) = binder.graph_uniform(instance.mesh(), &graph.buffers, style)
        {
            graph.uniform = uniform;
        }
        self.shape = shape;
        self.style = style.clone();
    }

    /// The instance that is drawn.
    #[must_use]
    pub const fn instance(&self) -> &MeshInstance {
        &self.instance
    }

    /// The counts of the last frame, zero if vertex shaders detect; waits for all submitted
    /// work.
    ///
    /// # Errors
    /// [`ReadbackError`], if the device is lost or has no memory for the copy.
    pub fn read_tally(&self, gpu: &Gpu) -> Result<Tally, ReadbackError> {
        let tallies: Vec<Tally> = self.read_tallies(gpu)?;
        Ok(tallies.iter().fold(Tally::default(), |sum, tally| sum.plus(tally)))
    }

    fn read_tallies(&self, gpu: &Gpu) -> Result<Vec<Tally>, ReadbackError> {
        read_buffer(gpu, &self.runs.tallies, self.chunks.len())
    }

    /// The live list of one chunk in the last frame, empty if there is no such chunk: each entry
    /// is the index of a record of the chunk, with the first three of `LineBits` above it.
    ///
    /// # Errors
    /// As [`Self::read_tally`].
    pub fn read_live(&self, gpu: &Gpu, chunk: usize) -> Result<Vec<u32>, ReadbackError> {
        let bound = self.chunks.get(chunk).and_then(|chunk| chunk.lists.as_ref());
        let Some(bound) = bound else { return Ok(Vec::new()) };
        let count = self.read_tallies(gpu)?.get(chunk).map_or(0, |tally| tally.stroke_count);
        read_buffer(gpu, &bound.lists.live, count as usize)
    }

    /// The stroke graph of the last frame; `None` if no strokes are linked.
    ///
    /// # Errors
    /// As [`Self::read_tally`].
    pub fn read_graph(&self, gpu: &Gpu) -> Result<Option<GraphReadback>, ReadbackError> {
        let Some(graph) = &self.graph else { return Ok(None) };
        let sets = self.style.sets.iter();
        let set_layers = sets.map(|set| set.is_linked.then_some(set.layer)).collect();
        GraphReadback::read(gpu, &graph.buffers, set_layers).map(Some)
    }

    /// The facing bits of one chunk in the last frame, 32 faces per word; empty in all but the
    /// indexed layout, and if there is no such chunk.
    ///
    /// # Errors
    /// As [`Self::read_tally`].
    pub fn read_facing(&self, gpu: &Gpu, chunk: usize) -> Result<Vec<u32>, ReadbackError> {
        let bound = self.chunks.get(chunk).and_then(|chunk| chunk.lists.as_ref());
        let Some(bound) = bound else { return Ok(Vec::new()) };
        let words = self.instance.mesh().chunks[chunk].size.face_count.div_ceil(32);
        read_buffer(gpu, &bound.lists.facing, words as usize)
    }
}

/// The parts that all bindings of an object share.
struct Binder<'a> {
    device: &'a wgpu::Device,
    pipelines: &'a Pipelines,
    /// Of the object.
    uniform: &'a wgpu::Buffer,
    runs: &'a ObjectRuns,
    shape: &'a ListShape,
}

impl Binder<'_> {
    fn chunk(&self, chunk: &ChunkBuffers, geometry: &ChunkGeometry) -> DrawnChunk {
        let detects = self.pipelines.options.stage == DetectionStage::Compute;
        DrawnChunk {
            edges: self.edges(chunk, geometry),
            planes: self.planes(geometry),
            lists: detects.then(|| self.lists(chunk, geometry)),
        }
    }

    fn edges(&self, chunk: &ChunkBuffers, geometry: &ChunkGeometry) -> wgpu::BindGroup {
        let layouts = &self.pipelines.layouts;
        let object = [(0, self.uniform), (1, &chunk.uniform)];
        match &geometry.edges {
            EdgeGeometry::Indexed { records, positions, normals, triangles, .. } => {
                let edges = [(2, records), (3, positions), (4, normals), (5, triangles)];
                let buffers = [&object[..], &edges].concat();
                bind_buffers(self.device, "edges", &layouts.edges, &buffers)
            }
            EdgeGeometry::Replicated { .. }
                if self.pipelines.options.stage == DetectionStage::Vertex =>
            {
                bind_buffers(self.device, "object", &layouts.object, &object)
            }
            EdgeGeometry::Replicated { vertices } => {
                let buffers = [&object[..], &[(2, vertices)]].concat();
                bind_buffers(self.device, "edges", &layouts.edges, &buffers)
            }
        }
    }

    fn planes(&self, geometry: &ChunkGeometry) -> Option<wgpu::BindGroup> {
        let EdgeGeometry::Indexed { planes, .. } = &geometry.edges else { return None };
        let layout = &self.pipelines.layouts.planes;
        Some(bind_buffers(self.device, "planes", layout, &[(0, planes)]))
    }

    fn lists(&self, chunk: &ChunkBuffers, geometry: &ChunkGeometry) -> BoundLists {
        let (device, layouts) = (self.device, &self.pipelines.layouts);
        let ListShape { layer_count, expanded, .. } = self.shape;
        let lists = ChunkLists::new(device, &chunk.size, *layer_count, expanded);
        let read = [(0, &lists.live), (1, &lists.arguments)];
        let expand = lists.vertices.iter().map(|vertices| {
            let buffers = [(0, &lists.live), (1, &lists.arguments), (2, vertices.as_ref()?)];
            Some(bind_buffers(device, "expand strokes", &layouts.expand, &buffers))
        });
        let detect = &self.pipelines.detect;
        BoundLists {
            detect: detect.bind(device, self.uniform, chunk, geometry, self.runs, &lists),
            expand: expand.collect(),
            listed: bind_buffers(device, "listed strokes", &layouts.listed, &read),
            lists,
        }
    }

    /// The graph of an object whose style links strokes.
    fn graph(
        &self,
        instance: &MeshInstance,
        drawn: &[DrawnChunk],
        style: &PreparedStyle,
    ) -> Option<ObjectGraph> {
        let pipelines = self.pipelines.graph.as_ref()?;
        if self.shape.linked_sets_per_layer == 0 {
            return None;
        }
        let mesh = instance.mesh();
        let sizes: Vec<ChunkUniform> = mesh.chunks.iter().map(|chunk| chunk.size).collect();
        let (sets, objects) = (self.shape.linked_sets_per_layer, mesh.options().objects);
        let buffers = GraphBuffers::new(self.device, &sizes, sets, objects);
        let lists = drawn.iter().filter_map(|chunk| Some(&chunk.lists.as_ref()?.lists));
        let chunks = mesh.chunks.iter().zip(&instance.geometry().chunks).zip(lists);
        let chunks: Vec<LinkedChunk> = chunks
            .map(|((buffers, geometry), lists)| LinkedChunk { buffers, geometry, lists })
            .collect();
        let link = &pipelines.link;
        Some(ObjectGraph {
            link: link.bind(self.device, self.uniform, self.runs, &chunks, &buffers)?,
            path: pipelines.path.bind(self.device, self.uniform, &buffers),
            ribbons: pipelines.coverage.bind(self.device, &buffers.ribbons),
            uniform: self.graph_uniform(mesh, &buffers, style)?,
            buffers,
        })
    }

    /// `@group(1)` of the passes of the stroke graph.
    fn graph_uniform(
        &self,
        mesh: &MeshBuffers,
        buffers: &GraphBuffers,
        style: &PreparedStyle,
    ) -> Option<wgpu::BindGroup> {
        let uniform = GraphUniform {
            chunk_count: to_u32(mesh.chunk_count()),
            set_count: to_u32(style.sets.len()),
            joint_capacity: buffers.size.joints,
            point_capacity: buffers.size.points,
            draws_contours: u32::from(style.draws_contours()),
            sets_per_layer: self.shape.linked_sets_per_layer,
            padding: [0; 2],
            sets: style.linked_sets(),
        };
        let layout = self.pipelines.graph.as_ref()?.link.graph_layout();
        let uniform = uniform_buffer(self.device, "graph", &uniform);
        Some(bind_buffers(self.device, "graph", layout, &[(0, &uniform)]))
    }
}
