//! The stroke graph of one object in one view, written by the GPU alone.
//!
//! | buffer | bytes |
//! |---|---|
//! | nodes, elements | 32 and 48 an edge that can be linked (of 8 edges one) |
//! | states of linking, twice | 16 each |
//! | nodes before, chains | 4 and 8 |
//! | sums | 8 for 16 items |
//! | joints | 16 an edge that can be linked |
//! | points, strokes, ribbons | 48, 16 and 80 a point (two for each edge that can be linked, and up to 65,536) |

use bytemuck::{Pod, Zeroable};
use edgemesh::index::to_u32;
use wgpu::BufferUsages;
use wgpu::util::DeviceExt as _;

use crate::mesh::capacity::BYTES_PER_NODE;
use crate::mesh::layout::ChunkUniform;
use crate::style::drawing_style::{MAX_LAYERS, MAX_STROKE_SETS};

/// Rounds of linking, at most: each looks four times as far, and 4 to this power is the number
/// of all indices. WGSL twin: the constant of this name.
pub const MAX_LINK_ROUNDS: usize = 16;

/// Items that one invocation sums up before a scan. WGSL twin: the constant of this
/// name.
pub const ITEMS_PER_SUM: u32 = 16;

/// In [`LinkNode::edge`]: the chain runs from its `v1` to its `v0`. WGSL twin: the
/// constant of this name.
pub const BACKWARD: u32 = 1 << 30;

/// No node follows. WGSL twin: the constant of this name.
pub const NO_NODE: u32 = (1 << 29) - 1;

/// In [`LinkNode::next`]: clipped where it begins. WGSL twin: as above.
pub const CUT_START: u32 = 1 << 31;

/// In [`LinkNode::next`]: clipped where it ends. WGSL twin: as above.
pub const CUT_END: u32 = 1 << 30;

/// In [`LinkNode::next`]: clipped as a whole. WGSL twin: as above.
pub const CUT_WHOLE: u32 = 1 << 29;

/// In [`Element::count`]: the last element is followed by the first. WGSL twin: as
/// above.
pub const ON_LOOP: u32 = 1 << 31;

/// Steps of arc length a pixel. WGSL twin: the constant of this name.
pub const ARC_PER_PX: f32 = 1024.0;

/// Which draws are linked, and how much there is room for. WGSL twin:
/// `shaders/common/stroke_graph.wgsl`, as of all structs here.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct GraphUniform {
    /// Chunks of the mesh.
    pub chunk_count: u32,
    /// Stroke sets of the style.
    pub set_count: u32,
    /// Joints of all stroke sets that there is room for.
    pub joint_capacity: u32,
    /// Points of all paths that there is room for.
    pub point_capacity: u32,
    /// 1 if contours are in a layer as such, else 0.
    pub draws_contours: u32,
    /// The most linked stroke sets of one layer.
    pub sets_per_layer: u32,
    /// Unused.
    pub padding: [u32; 2],
    /// The stroke sets in the order of drawing.
    pub sets: [LinkedSet; MAX_STROKE_SETS],
}

/// What linking must know of a stroke set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct LinkedSet {
    /// Its layer.
    pub layer: u32,
    /// 1 if its strokes are linked.
    pub is_linked: u32,
    /// Unused.
    pub padding: [u32; 2],
}

/// How much of everything there is in a view.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct GraphHeader {
    /// Edges that are linked.
    pub node_count: u32,
    /// Elements of all linked stroke sets together: one joint each.
    pub joint_count: u32,
    /// Points along them.
    pub point_count: u32,
    /// Strokes along them.
    pub stroke_count: u32,
    /// Chains of all layers.
    pub chain_count: u32,
    /// Arc length of all chains, in pixels.
    pub total_px: f32,
    /// Points that there is room for.
    pub point_capacity: u32,
    /// The most linked stroke sets of one layer.
    pub sets_per_layer: u32,
    /// Where the nodes of each layer begin; the last is their number.
    pub layer_first: [u32; MAX_LAYERS + 1],
    /// Where the joints of each stroke set begin, and their number.
    pub set_first: [u32; MAX_STROKE_SETS + 1],
    /// 1 for each round of linking that changed anything.
    pub changed: [u32; MAX_LINK_ROUNDS],
}

/// One drawn edge, in the direction of its chain.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct LinkNode {
    /// Where it begins, in pixels from the middle of the picture, y up.
    pub s0: [f32; 2],
    /// Where it ends.
    pub s1: [f32; 2],
    /// Depth where it begins.
    pub z0: f32,
    /// Depth where it ends.
    pub z1: f32,
    /// The edge's index in the mesh, with the line bits of contours and of what its own
    /// solid hides, and [`BACKWARD`].
    pub edge: u32,
    /// The node that follows, or [`NO_NODE`], with [`CUT_START`] and the others.
    pub next: u32,
}

/// What a node knows of its chain after some rounds of linking.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct ChainState {
    /// The node so many steps further on.
    pub jump: u32,
    /// The last node of an open chain, or the smallest so far with [`ON_LOOP`].
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
    /// Its first element.
    pub first: u32,
    /// How many it has.
    pub count: u32,
}

/// An element of a chain, in the order of the chain.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Element {
    /// As in its node.
    pub s0: [f32; 2],
    /// As in its node.
    pub s1: [f32; 2],
    /// As in its node.
    pub z0: f32,
    /// As in its node.
    pub z1: f32,
    /// As in its node.
    pub edge: u32,
    /// As in its node.
    pub next: u32,
    /// The first element of its chain.
    pub first: u32,
    /// How many elements its chain has, with [`ON_LOOP`] where the last is followed
    /// by the first.
    pub count: u32,
    /// Arc length up to here in [`ARC_PER_PX`] of a pixel, from anywhere.
    pub arc: u32,
    /// Its node.
    pub node: u32,
}

/// The beginning of an element in the path of a stroke set.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Joint {
    /// Cosine of the turn there, measured over some pixels.
    pub cosine: f32,
    /// Whether it is a break, a corner, a place to split at: one bit each.
    pub kind: u32,
    /// Points of the element.
    pub point_count: u32,
    /// The first of them.
    pub first_point: u32,
}

/// A point of a path; with the one that follows it, a segment.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct PathPoint {
    /// Pixels from the middle of the picture, y up.
    pub position: [f32; 2],
    /// How far beside it the line is drawn, in pixels.
    pub offset: [f32; 2],
    /// Its depth.
    pub depth: f32,
    /// Arc length up to here along the points, in [`ARC_PER_PX`] of a pixel, from
    /// anywhere.
    pub arc: u32,
    /// The joint of the element that it is on.
    pub joint: u32,
    /// See the shader; the stroke set is above the lowest eight bits.
    pub flags: u32,
    /// What of its segment is drawn, as fractions.
    pub cut: [f32; 2],
    /// The stroke that its segment is a part of.
    pub stroke: u32,
    /// Unused.
    pub padding: u32,
}

/// A stroke.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Stroke {
    /// The point where its first segment begins.
    pub first: u32,
    /// The point where its last segment begins.
    pub last: u32,
    /// Arc length where it begins, as that of points.
    pub start_arc: u32,
    /// Arc length where it ends.
    pub end_arc: u32,
}

/// A segment of a stroke, ready to be drawn.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Ribbon {
    /// Where it begins, in pixels from the middle of the picture, y up.
    pub a: [f32; 2],
    /// Where it ends.
    pub b: [f32; 2],
    /// Along the brush at both ends.
    pub u: [f32; 2],
    /// Half of its width at both ends, in pixels.
    pub half_width: [f32; 2],
    /// Unit vector of half of the turn where it begins, along and across the segment.
    pub join0: [f32; 2],
    /// The same where it ends.
    pub join1: [f32; 2],
    /// Dashes so far at both ends, in periods.
    pub dash: [f32; 2],
    /// Depth of its line at both ends.
    pub depth: [f32; 2],
    /// Of a period, how much is ink; 1 for whole lines.
    pub ink: f32,
    /// Its opacity at both ends, as fractions of 16 bits.
    pub opacity: u32,
    /// How it begins and ends, and on which side it lies.
    pub ends: u32,
    /// What is filled so many pixels before the line hides it; 0 for never.
    pub near_px: f32,
}

impl Ribbon {
    /// Whether there is anything to draw: not so behind the end of a path, and where it
    /// is hidden.
    #[must_use]
    pub const fn is_drawn(&self) -> bool {
        self.ends & NOT_DRAWN != NOT_DRAWN
    }
}

/// In [`Ribbon::ends`]: nothing. WGSL twin: the constant of this name.
pub const NOT_DRAWN: u32 = 15;

/// How large a dispatch is.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Groups {
    /// One workgroup.
    One,
    /// As many as the arguments say, at one of the places in [`arguments`].
    By(u32),
}

/// Where the arguments of each kind of dispatch and draw begin, in words. WGSL twins: the
/// constants of these names.
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

/// Points of the even grid along paths that there is room for, besides two for each
/// element: a quarter of a million pixels of lines at four pixels a point. Where that
/// is too little the points lie further apart. Meshes of a few edges have fewer.
const GRID_POINTS: u32 = 1 << 16;
const LEAST_GRID_POINTS: u32 = 1 << 11;
const GRID_POINTS_A_NODE: u32 = 1 << 8;

/// What there is room for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct GraphSize {
    pub(crate) nodes: u32,
    /// Elements of all linked stroke sets.
    pub(crate) joints: u32,
    pub(crate) points: u32,
}

impl GraphSize {
    /// For stroke sets of which at most `sets_per_layer` are of one layer.
    pub(crate) fn new(device: &wgpu::Device, chunks: &[ChunkUniform], sets_per_layer: u32) -> Self {
        let nodes = chunks.iter().map(|chunk| chunk.node_capacity).sum::<u32>().max(1);
        let limit = device.limits().max_storage_buffer_binding_size;
        let most = u32::try_from(limit / size_of::<Ribbon>() as u64).unwrap_or(u32::MAX);
        let joints = nodes.saturating_mul(sets_per_layer).min(most);
        let grid = LEAST_GRID_POINTS + nodes.min(GRID_POINTS) * GRID_POINTS_A_NODE;
        let grid = grid.min(GRID_POINTS);
        let points = joints.saturating_mul(2).saturating_add(grid).min(most);
        Self { nodes, joints, points }
    }

    /// Rounds that link the longest chain there can be: each looks four times as far.
    pub(crate) fn rounds(&self) -> usize {
        let doublings = self.nodes.next_power_of_two().trailing_zeros();
        doublings.div_ceil(2).max(1) as usize
    }
}

/// The buffers.
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
    pub(crate) fn new(device: &wgpu::Device, chunks: &[ChunkUniform], sets_per_layer: u32) -> Self {
        let size = GraphSize::new(device, chunks, sets_per_layer);
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
        // Of each chunk what it may have, and room for where its layers begin.
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
            // A stroke has a segment at least.
            strokes: buffer("graph strokes", size.points, size_of::<Stroke>(), read_back),
            ribbons: buffer("ribbons", size.points, size_of::<Ribbon>(), read_back),
            size,
        }
    }

    /// Dispatches as many workgroups as the arguments say at `at`, one of the places in
    /// [`arguments`].
    pub(crate) fn dispatch(&self, pass: &mut wgpu::ComputePass, at: u32) {
        pass.dispatch_workgroups_indirect(&self.arguments, 4 * u64::from(at));
    }
}
