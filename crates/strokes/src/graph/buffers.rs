//! The stroke graph of one object in one view, written by the GPU alone.
//!
//! | buffer | bytes |
//! |---|---|
//! | nodes, elements | 32 and 48 per edge that can be linked (one edge in 8) |
//! | chain states, twice | 16 per edge that can be linked |
//! | previous nodes, chains | 4 and 8 per edge that can be linked |
//! | sums | 8 per 16 items |
//! | joints | 16 per edge that can be linked |
//! | points, strokes, ribbons | 48, 16 and 80 per point (two per edge that can be linked, and up to 65,536) |

use bytemuck::{Pod, Zeroable};
use edgemesh::index::to_u32;
use wgpu::BufferUsages;
use wgpu::util::DeviceExt as _;

use crate::mesh::capacity::BYTES_PER_NODE;
use crate::mesh::layout::ChunkUniform;
use crate::style::drawing_style::{MAX_LAYERS, MAX_STROKE_SETS};

/// The most rounds of linking: each looks four times as far, and 4 to this power is the number of
/// all indices. WGSL twin: the constant of this name.
pub const MAX_LINK_ROUNDS: usize = 16;

/// Items that one invocation sums up before a scan. WGSL twin: the constant of this name.
pub const ITEMS_PER_SUM: u32 = 16;

/// In [`LinkNode::edge`]: the chain runs from the record's `v1` to its `v0`. WGSL twin: the
/// constant of this name.
pub const BACKWARD: u32 = 1 << 30;

/// No node follows; also the bits of the record in [`LinkNode::edge`]. WGSL twin: the constant of
/// this name.
pub const NO_NODE: u32 = (1 << 29) - 1;

/// In [`LinkNode::next`]: the edge is clipped where it begins. WGSL twin: as above.
pub const CUT_START: u32 = 1 << 31;

/// In [`LinkNode::next`]: the edge is clipped where it ends. WGSL twin: as above.
pub const CUT_END: u32 = 1 << 30;

/// In [`LinkNode::next`]: the whole edge is clipped. WGSL twin: as above.
pub const CUT_WHOLE: u32 = 1 << 29;

/// In [`Element::count`]: the first element follows the last. WGSL twin: as above.
pub const ON_LOOP: u32 = 1 << 31;

/// Steps of arc length per pixel. WGSL twin: the constant of this name.
pub const ARC_PER_PX: f32 = 1024.0;

/// Which stroke sets are linked, and the sizes of the buffers. WGSL twin:
/// `shaders/common/stroke_graph.wgsl`, as for all structs here.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct GraphUniform {
    /// Chunks of the mesh.
    pub chunk_count: u32,
    /// How many of `sets` are in use.
    pub set_count: u32,
    /// The most joints of all stroke sets.
    pub joint_capacity: u32,
    /// The most points of all paths.
    pub point_capacity: u32,
    /// 1 if a layer draws contours, else 0.
    pub draws_contours: u32,
    /// The most linked stroke sets of one layer.
    pub sets_per_layer: u32,
    /// Unused.
    pub padding: [u32; 2],
    /// The stroke sets in the order of drawing.
    pub sets: [LinkedSet; MAX_STROKE_SETS],
}

/// A stroke set as linking reads it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct LinkedSet {
    /// The layer whose edges are drawn.
    pub layer: u32,
    /// 1 if its strokes are linked.
    pub is_linked: u32,
    /// Unused.
    pub padding: [u32; 2],
}

/// The counts of a stroke graph.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[non_exhaustive]
#[repr(C)]
pub struct GraphHeader {
    /// Linked edges.
    pub node_count: u32,
    /// Joints of all linked stroke sets: one per element.
    pub joint_count: u32,
    /// Points of all paths.
    pub point_count: u32,
    /// Strokes of all paths.
    pub stroke_count: u32,
    /// Chains of all layers.
    pub chain_count: u32,
    /// Arc length of all chains, in pixels.
    pub total_px: f32,
    /// The most points of all paths.
    pub point_capacity: u32,
    /// The most linked stroke sets of one layer.
    pub sets_per_layer: u32,
    /// The first node of each layer; the last is the number of nodes.
    pub layer_first: [u32; MAX_LAYERS + 1],
    /// The first joint of each stroke set; the last is the number of joints.
    pub set_first: [u32; MAX_STROKE_SETS + 1],
    /// 1 for each round of linking that changed anything.
    pub changed: [u32; MAX_LINK_ROUNDS],
}

/// A linked edge, in the direction of its chain.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[non_exhaustive]
#[repr(C)]
pub struct LinkNode {
    /// Start of the edge, in pixels from the middle of the picture, y up.
    pub s0: [f32; 2],
    /// End of the edge.
    pub s1: [f32; 2],
    /// Depth at the start.
    pub z0: f32,
    /// Depth at the end.
    pub z1: f32,
    /// Index of the record in the mesh (29 bits), with `LineBits` of contours and of edges that
    /// their own solid hides, and bit 30 if the chain runs from the record's `v1` to its `v0`.
    pub edge: u32,
    /// The node that follows, or all ones (29 bits), with bits of what is clipped: the whole
    /// edge (29), its end (30), its start (31).
    pub next: u32,
}

/// The links of a node after some rounds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct ChainState {
    /// The node `reach` steps on.
    pub jump: u32,
    /// The last node of an open chain; on a loop the smallest node so far, with [`ON_LOOP`].
    pub anchor: u32,
    /// Steps to the anchor.
    pub distance: u32,
    /// Steps to `jump`.
    pub reach: u32,
}

/// A chain, at its anchor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Chain {
    /// First element.
    pub first: u32,
    /// Number of elements.
    pub count: u32,
}

/// An element of a chain, in the order of the chain.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[non_exhaustive]
#[repr(C)]
pub struct Element {
    /// As in [`LinkNode`].
    pub s0: [f32; 2],
    /// As in [`LinkNode`].
    pub s1: [f32; 2],
    /// As in [`LinkNode`].
    pub z0: f32,
    /// As in [`LinkNode`].
    pub z1: f32,
    /// As in [`LinkNode`].
    pub edge: u32,
    /// As in [`LinkNode`].
    pub next: u32,
    /// First element of the chain.
    pub first: u32,
    /// Number of elements of the chain, with bit 31 on a loop: the first element follows the
    /// last.
    pub count: u32,
    /// Arc length up to here in 1/1024 pixels, from an arbitrary start; it wraps around.
    pub arc: u32,
    /// Index of the node.
    pub node: u32,
}

impl Element {
    /// Index of the record in the mesh.
    #[must_use]
    pub const fn record(&self) -> u32 {
        self.edge & NO_NODE
    }

    /// Whether the chain runs from the record's `v1` to its `v0`.
    #[must_use]
    pub const fn is_backward(&self) -> bool {
        self.edge & BACKWARD != 0
    }

    /// Number of elements of the chain.
    #[must_use]
    pub const fn chain_length(&self) -> u32 {
        self.count & !ON_LOOP
    }
}

/// The start of an element in the path of a stroke set.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Joint {
    /// Cosine of the turn, measured over some pixels.
    pub cosine: f32,
    /// A break, a corner, a place to split at: one bit each.
    pub kind: u32,
    /// Number of points of the element.
    pub point_count: u32,
    /// First point of the element.
    pub first_point: u32,
}

/// A point of a path. It begins the segment to the next point.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[non_exhaustive]
#[repr(C)]
pub struct PathPoint {
    /// Pixels from the middle of the picture, y up.
    pub position: [f32; 2],
    /// From the point to the drawn line, in pixels.
    pub offset: [f32; 2],
    /// Depth, 1 near and 0 far.
    pub depth: f32,
    /// Arc length up to here in 1/1024 pixels, from an arbitrary start; it wraps around.
    pub arc: u32,
    /// Joint of the point's element.
    pub joint: u32,
    /// `POINT_` flags of `shaders/common/stroke_graph.wgsl` in the lowest eight bits, the stroke
    /// set above them.
    pub flags: u32,
    /// Start and end of the drawn part of the segment, as fractions.
    pub cut: [f32; 2],
    /// The stroke of the segment.
    pub stroke: u32,
    /// Unused.
    pub padding: u32,
}

/// A stroke of the graph: consecutive segments.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[non_exhaustive]
#[repr(C)]
pub struct Stroke {
    /// The point that begins the first segment.
    pub first: u32,
    /// The point that begins the last segment.
    pub last: u32,
    /// Arc length at the start, as in [`PathPoint::arc`].
    pub start_arc: u32,
    /// Arc length at the end.
    pub end_arc: u32,
}

/// A segment of a stroke as it is drawn. Pairs are values at its start and at its end.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[non_exhaustive]
#[repr(C)]
pub struct Ribbon {
    /// Start, in pixels from the middle of the picture, y up.
    pub a: [f32; 2],
    /// End, in the same pixels.
    pub b: [f32; 2],
    /// Repeats of the brush along the stroke.
    pub u: [f32; 2],
    /// Half of the width, in pixels.
    pub half_width: [f32; 2],
    /// Unit vector of half the turn at the start, along and across the segment.
    pub join0: [f32; 2],
    /// Unit vector of half the turn at the end.
    pub join1: [f32; 2],
    /// Periods of dashes along the stroke.
    pub dash: [f32; 2],
    /// Depth of the line.
    pub depth: [f32; 2],
    /// Fraction of a dash period that is ink; 1 for whole lines.
    pub ink: f32,
    /// Opacities as fractions of 16 bits, the start in the lower half.
    pub opacity: u32,
    /// Kinds of both ends, and the side of the line that the ribbon lies on.
    pub ends: u32,
    /// Surfaces more than this many pixels in front of the line hide the ribbon; 0 if none does.
    pub near_px: f32,
}

impl Ribbon {
    /// Whether the segment is drawn: it is not past the end of a path, and not hidden.
    #[must_use]
    pub const fn is_drawn(&self) -> bool {
        self.ends & NOT_DRAWN != NOT_DRAWN
    }
}

/// In [`Ribbon::ends`]: nothing is drawn. WGSL twin: the constant of this name.
pub const NOT_DRAWN: u32 = 15;

/// The size of a dispatch.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Groups {
    /// One workgroup.
    One,
    /// Read from the arguments, at one of the places in [`arguments`].
    By(u32),
}

/// Places of the arguments of dispatches and draws, in words. WGSL twins: the constants of these
/// names.
pub mod arguments {
    use crate::style::drawing_style::MAX_STROKE_SETS;

    /// Dispatches over nodes.
    pub const NODE_GROUPS: u32 = 0;
    /// Dispatches over sums of nodes.
    pub const NODE_SUM_GROUPS: u32 = 3;
    /// Dispatches over joints.
    pub const JOINT_GROUPS: u32 = 6;
    /// Dispatches over sums of joints.
    pub const JOINT_SUM_GROUPS: u32 = 9;
    /// Dispatches over points.
    pub const POINT_GROUPS: u32 = 12;
    /// Dispatches over sums of points.
    pub const POINT_SUM_GROUPS: u32 = 15;
    /// Draws of ribbons: five words per stroke set.
    pub const RIBBON_DRAWS: u32 = 18;
    /// Dispatches over the nodes of each chunk: three words per chunk.
    #[expect(clippy::cast_possible_truncation, reason = "16")]
    pub const CHUNK_GROUPS: u32 = RIBBON_DRAWS + 5 * MAX_STROKE_SETS as u32;
}

const _: () = assert!(BYTES_PER_NODE == 8 * size_of::<Ribbon>() as u64, "as the mesh reckons");

/// The most points of the even grid along paths, besides two for each element: a quarter of a
/// million pixels of lines at four pixels per point. Longer lines have points further apart,
/// and meshes of few edges have room for fewer. The objects of meshes with several objects
/// share them.
const GRID_POINTS: u32 = 1 << 16;
const LEAST_GRID_POINTS: u32 = 1 << 11;
const LEAST_SHARED_GRID_POINTS: u32 = 1 << 9;
const GRID_POINTS_A_NODE: u32 = 1 << 8;

/// The sizes of the buffers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct GraphSize {
    pub(crate) nodes: u32,
    /// Elements of all linked stroke sets.
    pub(crate) joints: u32,
    pub(crate) points: u32,
}

impl GraphSize {
    /// Sizes for stroke sets with at most `sets_per_layer` in one layer, in each of `objects`
    /// objects.
    pub(crate) fn new(
        device: &wgpu::Device,
        chunks: &[ChunkUniform],
        sets_per_layer: u32,
        objects: u32,
    ) -> Self {
        let nodes = chunks.iter().map(|chunk| chunk.node_capacity).sum::<u32>().max(1);
        let limit = device.limits().max_storage_buffer_binding_size;
        let most = u32::try_from(limit / size_of::<Ribbon>() as u64).unwrap_or(u32::MAX);
        let joints = nodes.saturating_mul(sets_per_layer).min(most);
        let grid = LEAST_GRID_POINTS + nodes.min(GRID_POINTS) * GRID_POINTS_A_NODE;
        let grid = grid.min((GRID_POINTS / objects.max(1)).max(LEAST_SHARED_GRID_POINTS));
        let points = joints.saturating_mul(2).saturating_add(grid).min(most);
        Self { nodes, joints, points }
    }

    /// Rounds that link the longest possible chain: each looks four times as far.
    pub(crate) fn rounds(&self) -> usize {
        let doublings = self.nodes.next_power_of_two().trailing_zeros();
        doublings.div_ceil(2).max(1) as usize
    }
}

/// The buffers of a stroke graph.
#[derive(Debug)]
pub(crate) struct GraphBuffers {
    pub(crate) size: GraphSize,
    pub(crate) header: wgpu::Buffer,
    pub(crate) bases: wgpu::Buffer,
    pub(crate) arguments: wgpu::Buffer,
    pub(crate) nodes: wgpu::Buffer,
    pub(crate) elements: wgpu::Buffer,
    pub(crate) previous: wgpu::Buffer,
    pub(crate) sums: wgpu::Buffer,
    pub(crate) states: [wgpu::Buffer; 2],
    pub(crate) chains: wgpu::Buffer,
    pub(crate) joints: wgpu::Buffer,
    pub(crate) points: wgpu::Buffer,
    pub(crate) strokes: wgpu::Buffer,
    pub(crate) ribbons: wgpu::Buffer,
}

impl GraphBuffers {
    pub(crate) fn new(
        device: &wgpu::Device,
        chunks: &[ChunkUniform],
        sets_per_layer: u32,
        objects: u32,
    ) -> Self {
        let size = GraphSize::new(device, chunks, sets_per_layer, objects);
        let buffer = |label: &str, count: u32, bytes: usize, usage: BufferUsages| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: u64::from(count) * bytes as u64,
                usage: BufferUsages::STORAGE | usage,
                mapped_at_creation: false,
            })
        };
        let read_back = BufferUsages::COPY_SRC;
        let none = BufferUsages::empty();
        let nodes = size.nodes;
        let state = || buffer("chain states", nodes, size_of::<ChainState>(), none);
        // The node capacity of each chunk, and room for the bases of its layers.
        let mut bases: Vec<u32> = chunks.iter().map(|chunk| chunk.node_capacity).collect();
        bases.resize((MAX_LAYERS + 2) * chunks.len().max(1), 0);
        let chunk_count = to_u32(chunks.len());
        let arguments = arguments::CHUNK_GROUPS + 3 * chunk_count;
        Self {
            header: buffer("graph header", 1, size_of::<GraphHeader>(), read_back),
            bases: device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("bases"),
                contents: bytemuck::cast_slice(&bases),
                usage: BufferUsages::STORAGE,
            }),
            arguments: buffer("graph arguments", arguments, 4, BufferUsages::INDIRECT),
            nodes: buffer("link nodes", nodes, size_of::<LinkNode>(), read_back),
            elements: buffer("elements", nodes, size_of::<Element>(), read_back),
            previous: buffer("previous nodes", nodes, 4, BufferUsages::COPY_DST),
            sums: buffer("sums", size.points.max(nodes).div_ceil(ITEMS_PER_SUM), 8, none),
            states: [state(), state()],
            chains: buffer("chains", nodes, size_of::<Chain>(), none),
            joints: buffer("joints", size.joints, size_of::<Joint>(), none),
            points: buffer("path points", size.points, size_of::<PathPoint>(), read_back),
            // A stroke has at least one segment.
            strokes: buffer("graph strokes", size.points, size_of::<Stroke>(), read_back),
            ribbons: buffer("ribbons", size.points, size_of::<Ribbon>(), read_back),
            size,
        }
    }

    /// Dispatches the workgroups that the arguments have at `at`, one of the places in
    /// [`arguments`].
    pub(crate) fn dispatch(&self, pass: &mut wgpu::ComputePass, at: u32) {
        pass.dispatch_workgroups_indirect(&self.arguments, 4 * u64::from(at));
    }
}
