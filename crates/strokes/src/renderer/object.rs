//! An object of a scene: a mesh, where it stands, and how it looks.

use std::sync::Arc;

use edgemesh::edge_mesh::Bounds;
use edgemesh::index::to_u32;
use edgemesh::line::kind::LineKind;
use edgemesh::view::camera::View;
use edgemesh::view::projection::to_pixels;
use glam::{DMat4, Mat4, Vec2, Vec3, Vec4};

use crate::draw::stroke_layouts::StrokeLayouts;
use crate::gpu::bind::{bind_buffers, uniform_buffer};
use crate::gpu::device::Gpu;
use crate::gpu::readback::{PendingRead, ReadbackError, read_buffer};
use crate::graph::buffers::{
    Element, GraphBuffers, GraphHeader, GraphUniform, LinkNode, PathPoint, Ribbon, Stroke,
};
use crate::graph::link::LinkDraw;
use crate::graph::path::PathDraw;
use crate::mesh::buffers::{ChunkBuffers, EdgeSource, MeshBuffers};
use crate::mesh::layout::ChunkUniform;
use crate::renderer::{DetectionPath, PreparedDraw, PreparedLook, Renderer};
use crate::style::drawing_style::{MAX_DRAWS, Visibility};
use crate::view::detect::DetectDraw;
use crate::view::frame::{FrameUniform, ObjectUniform};
use crate::view::live_lists::{ObjectBuffers, Tally, ViewBuffers};

/// An object of a scene.
#[derive(Debug)]
pub struct Object {
    /// Takes the positions of its mesh to the scene.
    pub world_from_object: DMat4,
    pub(crate) mesh: Arc<MeshBuffers>,
    pub(crate) look: Arc<PreparedLook>,
    pub(crate) fill_group: wgpu::BindGroup,
    pub(crate) parts: Vec<ObjectPart>,
    pub(crate) whole: ObjectBuffers,
    /// Where strokes are linked.
    pub(crate) graph: Option<ObjectGraph>,
    /// Whether what no view changes is still to be worked out.
    pub(crate) is_stale: bool,
    /// Where the object is on the screen; nowhere known for sure where a part of its
    /// box is behind the eye.
    pub(crate) seen: Option<SeenBox>,
    /// False where the transform flattens the object to nothing.
    pub(crate) is_placed: bool,
    uniform: wgpu::Buffer,
}

/// The stroke graph as a view made it, for tests and inspection.
#[derive(Debug)]
pub struct GraphReadback {
    /// How much of everything there is.
    pub header: GraphHeader,
    /// The layer of each draw that is linked.
    pub draw_layers: Vec<Option<u32>>,
    /// The edges that are linked, layer by layer.
    pub nodes: Vec<LinkNode>,
    /// The elements of all chains, one chain after another.
    pub elements: Vec<Element>,
    /// The points of all paths, draw by draw.
    pub points: Vec<PathPoint>,
    /// The strokes along them.
    pub strokes: Vec<Stroke>,
    /// Their segments, one a point.
    pub ribbons: Vec<Ribbon>,
}

impl GraphReadback {
    /// The draw that an element of a path belongs to.
    fn draw_of(&self, path: u32) -> usize {
        let firsts = &self.header.draw_first[..self.draw_layers.len()];
        firsts.iter().rposition(|first| *first <= path).unwrap_or(0)
    }

    /// The layer of an element of a path, as the points count them.
    #[must_use]
    pub fn layer_of(&self, path: u32) -> usize {
        self.draw_layers.get(self.draw_of(path)).copied().flatten().unwrap_or(0) as usize
    }

    /// The layer of a node.
    #[must_use]
    pub fn layer_of_node(&self, node: u32) -> usize {
        self.header.layer_first.iter().rposition(|first| *first <= node).unwrap_or(0)
    }

    /// Which of the elements an element of a path is.
    #[must_use]
    pub fn element_of(&self, path: u32) -> usize {
        let first = self.header.draw_first[self.draw_of(path)];
        (self.header.layer_first[self.layer_of(path)] + path - first) as usize
    }
}

/// The stroke graph of an object.
#[derive(Debug)]
pub(crate) struct ObjectGraph {
    pub(crate) buffers: GraphBuffers,
    /// `@group(1)` of its passes.
    pub(crate) uniform: wgpu::BindGroup,
    pub(crate) link: LinkDraw,
    pub(crate) path: PathDraw,
    /// `@group(3)` of its ribbons.
    pub(crate) ribbons: wgpu::BindGroup,
}

/// A box on the screen, in pixels from its upper left corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SeenBox {
    pub(crate) min: Vec2,
    pub(crate) max: Vec2,
}

impl SeenBox {
    /// Around the corners of `bounds`.
    fn of(clip_from_object: &Mat4, bounds: &Bounds, viewport_px: Vec2) -> Option<Self> {
        let [low, high] = [Vec3::from(bounds.min), Vec3::from(bounds.max)];
        let mut seen: Option<Self> = None;
        for corner in 0..8_u32 {
            let pick = |axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
            let clip = *clip_from_object * Vec4::new(pick(0), pick(1), pick(2), 1.0);
            if clip.w <= 0.0 || clip.z > clip.w {
                return None;
            }
            let px = to_pixels(clip, viewport_px) * Vec2::new(1.0, -1.0) + 0.5 * viewport_px;
            let point = Self { min: px, max: px };
            seen = Some(seen.map_or(point, |seen| seen.union(&point)));
        }
        seen
    }

    /// Around both.
    pub(crate) fn union(&self, other: &Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The pixels within `reach_px` of it, on a picture of this size: left, top, width
    /// and height.
    pub(crate) fn pixels(&self, reach_px: f32, size: [u32; 2]) -> [u32; 4] {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
        let clamped = |value: f32, side: u32| (value.max(0.0) as u32).min(side);
        let [width, height] = size;
        let (min, max) = (self.min - reach_px, self.max + reach_px);
        let (left, top) = (clamped(min.x.floor(), width), clamped(min.y.floor(), height));
        let (right, bottom) = (clamped(max.x.ceil(), width), clamped(max.y.ceil(), height));
        [left, top, right.saturating_sub(left), bottom.saturating_sub(top)]
    }
}

/// What one chunk of the object needs.
#[derive(Debug)]
pub(crate) struct ObjectPart {
    /// `@group(2)` of its edges.
    pub(crate) edges: wgpu::BindGroup,
    /// `@group(3)` where every edge is drawn by its index.
    pub(crate) planes: Option<wgpu::BindGroup>,
    /// Where detection runs in compute shaders.
    pub(crate) lists: Option<PartLists>,
}

/// The lists of a view, and how they are bound.
#[derive(Debug)]
pub(crate) struct PartLists {
    pub(crate) view: ViewBuffers,
    pub(crate) detect: DetectDraw,
    /// `@group(3)` of the expansion, one a draw.
    pub(crate) expand: Vec<Option<wgpu::BindGroup>>,
    /// `@group(3)` of strokes from the list.
    pub(crate) listed: wgpu::BindGroup,
}

impl Object {
    pub(crate) fn new(
        gpu: &Gpu,
        renderer: &Renderer,
        mesh: Arc<MeshBuffers>,
        look: Arc<PreparedLook>,
    ) -> Self {
        let device = &gpu.device;
        let empty: ObjectUniform = bytemuck::Zeroable::zeroed();
        let uniform = uniform_buffer(device, "object", &empty);
        let expanded =
            |draw: &PreparedDraw| (!draw.lies_over_surface && !draw.is_linked).then_some(draw.kind);
        let expanded: Vec<Option<LineKind>> = look.draws.iter().map(expanded).collect();
        let sizes: Vec<ChunkUniform> = mesh.chunks.iter().map(|chunk| chunk.size).collect();
        let whole = ObjectBuffers::new(device, &sizes);
        let part = |chunk: &ChunkBuffers| {
            let lists = (renderer.options.path == DetectionPath::Compute).then(|| {
                let (layers, object) = (look.layer_count, (&uniform, &whole));
                lists(device, renderer, object, chunk, layers, &expanded)
            });
            ObjectPart {
                edges: edges_group(device, renderer, &uniform, chunk),
                planes: planes_group(device, &renderer.layouts, chunk),
                lists,
            }
        };
        let parts: Vec<ObjectPart> = mesh.chunks.iter().map(part).collect();
        Self {
            world_from_object: DMat4::IDENTITY,
            graph: graph(device, renderer, (&uniform, &whole), &mesh, &parts, &look),
            fill_group: renderer.fill.draw(device, &uniform),
            parts,
            whole,
            mesh,
            look,
            is_stale: true,
            is_placed: true,
            seen: None,
            uniform,
        }
    }

    /// Sets what the next submission sees of the object.
    pub(crate) fn look_from(&mut self, gpu: &Gpu, view: &View, frame: &FrameUniform) {
        let viewport_px = frame.viewport_px.into();
        let mut uniform =
            ObjectUniform::new(view, &frame.part(), self.world_from_object, &self.mesh.bounds);
        // What is cut open shows its inside, as to an eye within.
        if let Some(uniform) = uniform.as_mut().filter(|_| frame.clip_plane_count > 0) {
            uniform.eye_is_outside = 0;
        }
        self.is_placed = uniform.is_some();
        self.seen = uniform.and_then(|uniform| {
            SeenBox::of(&uniform.clip_from_object(), &self.mesh.bounds, viewport_px)
        });
        if let Some(uniform) = uniform {
            gpu.queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&uniform));
        }
    }

    /// The mesh.
    #[must_use]
    pub fn mesh(&self) -> &MeshBuffers {
        &self.mesh
    }

    pub(crate) fn has_silhouette(&self) -> bool {
        self.look.draws.iter().any(|draw| draw.visibility == Visibility::Silhouette)
    }

    /// The counts of the last view, or nothing where vertex shaders detect.
    ///
    /// # Errors
    /// Where the device is lost.
    pub fn read_tally(&self, gpu: &Gpu) -> Result<Tally, ReadbackError> {
        let tallies: Vec<Tally> = self.read_tallies(gpu)?;
        Ok(tallies.iter().fold(Tally::default(), |sum, tally| sum.plus(tally)))
    }

    /// Begins to read the counts of each chunk in the last view.
    ///
    /// # Errors
    /// Where the device is lost.
    pub fn begin_read_tallies(&self, gpu: &Gpu) -> Result<PendingRead<Tally>, ReadbackError> {
        PendingRead::begin(gpu, &self.whole.tallies, self.parts.len())
    }

    fn read_tallies(&self, gpu: &Gpu) -> Result<Vec<Tally>, ReadbackError> {
        read_buffer(gpu, &self.whole.tallies, self.parts.len())
    }

    /// The live list of one chunk in the last view: each entry is the index of a
    /// record of the chunk, with the first three of `LineBits` above it.
    ///
    /// # Errors
    /// Where the device is lost.
    pub fn read_live(&self, gpu: &Gpu, chunk: usize) -> Result<Vec<u32>, ReadbackError> {
        let lists = self.parts.get(chunk).and_then(|part| part.lists.as_ref());
        let Some(lists) = lists else { return Ok(Vec::new()) };
        let count = self.read_tallies(gpu)?.get(chunk).map_or(0, |tally| tally.stroke_count);
        read_buffer(gpu, &lists.view.live, count as usize)
    }

    /// The chains of the last view: the edges in order, and for each the first of its
    /// chain and how many that has; nothing where no strokes are linked.
    ///
    /// # Errors
    /// Where the device is lost.
    pub fn read_graph(&self, gpu: &Gpu) -> Result<Option<GraphReadback>, ReadbackError> {
        let Some(ObjectGraph { buffers, .. }) = &self.graph else { return Ok(None) };
        let header: Vec<GraphHeader> = read_buffer(gpu, &buffers.header, 1)?;
        let count = header[0].node_count as usize;
        let nodes = read_buffer(gpu, &buffers.nodes, count)?;
        let elements = read_buffer(gpu, &buffers.elements, count)?;
        let points = read_buffer(gpu, &buffers.points, header[0].point_count as usize)?;
        let ribbons = read_buffer(gpu, &buffers.ribbons, header[0].point_count as usize)?;
        let strokes = read_buffer(gpu, &buffers.strokes, header[0].stroke_count as usize)?;
        let draws = self.look.draws.iter();
        let draw_layers = draws.map(|draw| draw.is_linked.then_some(draw.layer)).collect();
        let header = header[0];
        Ok(Some(GraphReadback { header, draw_layers, nodes, elements, points, strokes, ribbons }))
    }

    /// The facing bits of one chunk in the last view, 32 faces a word; of the
    /// indexed layout.
    ///
    /// # Errors
    /// Where the device is lost.
    pub fn read_facing(&self, gpu: &Gpu, chunk: usize) -> Result<Vec<u32>, ReadbackError> {
        let lists = self.parts.get(chunk).and_then(|part| part.lists.as_ref());
        let Some(lists) = lists else { return Ok(Vec::new()) };
        let words = self.mesh.chunks[chunk].size.face_count.div_ceil(32);
        read_buffer(gpu, &lists.view.facing, words as usize)
    }
}

/// The graph of an object whose look links strokes.
fn graph(
    device: &wgpu::Device,
    renderer: &Renderer,
    (object, whole): (&wgpu::Buffer, &ObjectBuffers),
    mesh: &MeshBuffers,
    parts: &[ObjectPart],
    look: &PreparedLook,
) -> Option<ObjectGraph> {
    let pipelines = renderer.graph.as_ref()?;
    if !look.draws.iter().any(|draw| draw.is_linked) {
        return None;
    }
    let sizes: Vec<ChunkUniform> = mesh.chunks.iter().map(|chunk| chunk.size).collect();
    let of_layer =
        |layer: u32| look.draws.iter().filter(|draw| draw.is_linked && draw.layer == layer).count();
    let most = (0..look.layer_count).map(of_layer).max().unwrap_or(1);
    let buffers = GraphBuffers::new(device, &sizes, to_u32(most));
    let views = parts.iter().filter_map(|part| part.lists.as_ref().map(|lists| &lists.view));
    let chunks: Vec<_> = mesh.chunks.iter().zip(views).collect();
    let link = pipelines.link.draw(device, object, whole, &chunks, &buffers)?;
    let mut draws = [[0; 4]; MAX_DRAWS];
    for (words, draw) in draws.iter_mut().zip(&look.draws) {
        *words = [draw.layer, u32::from(draw.is_linked), 0, 0];
    }
    let uniform = GraphUniform {
        chunk_count: to_u32(sizes.len()),
        draw_count: to_u32(look.draws.len()),
        path_capacity: buffers.size.paths,
        point_capacity: buffers.size.points,
        draws_contours: u32::from(look.draws_contours),
        draws_a_layer: to_u32(most),
        padding: [0; 2],
        draws,
    };
    let uniform = uniform_buffer(device, "graph", &uniform);
    let uniform = bind_buffers(device, "graph", pipelines.link.graph_layout(), &[(0, &uniform)]);
    let path = pipelines.path.draw(device, object, &buffers);
    let ribbons = pipelines.coverage.draw(device, &buffers.ribbons);
    Some(ObjectGraph { buffers, uniform, link, path, ribbons })
}

fn lists(
    device: &wgpu::Device,
    renderer: &Renderer,
    (uniform, whole): (&wgpu::Buffer, &ObjectBuffers),
    chunk: &ChunkBuffers,
    layer_count: u32,
    expanded: &[Option<LineKind>],
) -> PartLists {
    let layouts = &renderer.layouts;
    let view = ViewBuffers::new(device, &chunk.size, layer_count, expanded);
    let read = [(0, &view.live), (1, &view.draws)];
    let expand = view.vertices.iter().map(|vertices| {
        let buffers = [(0, &view.live), (1, &view.draws), (2, vertices.as_ref()?)];
        Some(bind_buffers(device, "expand strokes", &layouts.expand, &buffers))
    });
    PartLists {
        detect: renderer.detect.draw(device, uniform, chunk, whole, &view),
        expand: expand.collect(),
        listed: bind_buffers(device, "listed strokes", &layouts.listed, &read),
        view,
    }
}

fn edges_group(
    device: &wgpu::Device,
    renderer: &Renderer,
    uniform: &wgpu::Buffer,
    chunk: &ChunkBuffers,
) -> wgpu::BindGroup {
    let layouts = &renderer.layouts;
    let object = [(0, uniform), (1, &chunk.uniform)];
    match &chunk.source {
        EdgeSource::Indexed { records, positions, normals, triangles, .. } => {
            let edges = [(2, records), (3, positions), (4, normals), (5, triangles)];
            let buffers = [&object[..], &edges].concat();
            bind_buffers(device, "edges", &layouts.edges, &buffers)
        }
        EdgeSource::Replicated { .. } if renderer.options.path == DetectionPath::Vertex => {
            bind_buffers(device, "object", &layouts.object, &object)
        }
        EdgeSource::Replicated { vertices } => {
            let buffers = [&object[..], &[(2, vertices)]].concat();
            bind_buffers(device, "edges", &layouts.edges, &buffers)
        }
    }
}

fn planes_group(
    device: &wgpu::Device,
    layouts: &StrokeLayouts,
    chunk: &ChunkBuffers,
) -> Option<wgpu::BindGroup> {
    let EdgeSource::Indexed { planes, .. } = &chunk.source else { return None };
    Some(bind_buffers(device, "planes", &layouts.planes, &[(0, planes)]))
}
