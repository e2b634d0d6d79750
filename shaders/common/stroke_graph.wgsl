// What the stroke graph of one object is made of. Rust twins:
// crates/strokes/src/graph/buffers.rs.
#import <common/object_limits.wgsl>

// Invocations a workgroup.
const GROUP: u32 = 64u;

// Items that one invocation sums up before a scan.
const ITEMS_PER_SUM: u32 = 16u;

// Of GraphUniform.draws: which draws are linked, and how.
struct GraphUniform {
    layer_count: u32,
    chunk_count: u32,
    draw_count: u32,
    node_capacity: u32,
    path_capacity: u32,
    point_capacity: u32,
    // 1 where contours are in a layer as such: else an edge is what else it is.
    draws_contours: u32,
    padding: u32,
    // Layer of each draw, and 1 where its strokes are linked.
    draws: array<vec4u, MAX_DRAWS>,
}

struct GraphHeader {
    node_count: u32,
    // Elements of all linked draws together.
    path_count: u32,
    point_count: u32,
    stroke_count: u32,
    chain_count: u32,
    // Arc length of all paths, in pixels.
    total_px: f32,
    padding: vec2u,
    // Where the nodes of each layer begin; the last is their number.
    layer_first: array<u32, 8>,
    // Where the elements of each draw begin among all, and its points.
    draw_first: array<u32, 20>,
    // 1 where a round of linking changed anything.
    changed: array<atomic<u32>, 16>,
}

// One drawn edge, in the direction of its chain.
struct LinkNode {
    // Pixels from the middle of the picture, y up.
    s0: vec2f,
    s1: vec2f,
    // Depth at both ends.
    z0: f32,
    z1: f32,
    // The edge's index in the mesh, with CONTOUR and BEHIND_SOLID, and BACKWARD where
    // the chain runs from its v1 to its v0.
    edge: u32,
    // The node that follows, or NO_NODE, with the bits below. Until it is looked up,
    // the edge that follows.
    next: u32,
}

const BACKWARD: u32 = 0x40000000u;
const NO_NODE: u32 = 0x1fffffffu;
const CUT_START: u32 = 0x80000000u;
const CUT_END: u32 = 0x40000000u;
const UNSEEN: u32 = 0x20000000u;

// What a node knows of its chain after some rounds.
struct ChainState {
    // The node so many steps further on; the last one of an open chain is its own.
    jump: u32,
    // The last node of an open chain, or the smallest so far with ON_LOOP.
    anchor: u32,
    // Steps to the anchor.
    distance: u32,
    // Steps to `jump`.
    reach: u32,
}

const ON_LOOP: u32 = 0x80000000u;

// A chain, at its anchor: where it begins among all elements, and its length.
struct Chain {
    first: u32,
    count: u32,
}

// The elements of all chains, one chain after another.
struct Element {
    node: u32,
    // Of its chain.
    first: u32,
    // Elements of its chain, and ON_LOOP where the last is followed by the first.
    count: u32,
    // Arc length up to here, in ARC_PER_PX of a pixel, from anywhere.
    arc: u32,
}

// Arc lengths are whole numbers, so that sums are the same in any order, and those
// of a chain are exact however long all chains together are.
const ARC_PER_PX: f32 = 1024.0;

// Workgroups of dispatches: three words each.
const NODE_GROUPS: u32 = 0u;
const NODE_SUM_GROUPS: u32 = 3u;
const PATH_GROUPS: u32 = 6u;
const PATH_SUM_GROUPS: u32 = 9u;
const POINT_GROUPS: u32 = 12u;
const POINT_SUM_GROUPS: u32 = 15u;
// Then those of each chunk.
const CHUNK_GROUPS: u32 = 18u;
