// The buffers of one object's stroke graph. Rust twins: crates/strokes/src/graph/buffers.rs.
#import <common/object_limits.wgsl>

// Invocations per workgroup.
const GROUP: u32 = 64u;

// The most rounds of linking; each looks four times as far as the one before.
const MAX_LINK_ROUNDS: u32 = 16u;

// Items that one invocation sums up before a scan.
const ITEMS_PER_SUM: u32 = 16u;

// Which stroke sets are linked, and the capacities of the buffers.
struct GraphUniform {
    chunk_count: u32,
    set_count: u32,
    joint_capacity: u32,
    point_capacity: u32,
    // 1 if contours are drawn; otherwise an edge is linked by its other classes.
    draws_contours: u32,
    // The most linked stroke sets of one layer.
    sets_per_layer: u32,
    padding: vec2u,
    sets: array<LinkedSet, MAX_STROKE_SETS>,
}

// A stroke set, as linking needs it.
struct LinkedSet {
    layer: u32,
    // 1 if its strokes are linked.
    is_linked: u32,
    padding: vec2u,
}

struct GraphHeader {
    node_count: u32,
    // Elements of all linked stroke sets together; each has one joint.
    joint_count: u32,
    point_count: u32,
    stroke_count: u32,
    chain_count: u32,
    // Arc length of all chains, in pixels.
    total_px: f32,
    // The most points that the buffer can hold.
    point_capacity: u32,
    sets_per_layer: u32,
    // The first node of each layer; the last value is the number of nodes.
    layer_first: array<u32, MAX_LAYERS + 1u>,
    // The first joint of each stroke set; the last value is the number of joints.
    set_first: array<u32, MAX_STROKE_SETS + 1u>,
    // 1 if a round of linking changed anything.
    changed: array<atomic<u32>, MAX_LINK_ROUNDS>,
}

// One drawn edge, in the direction of its chain.
struct LinkNode {
    // Pixels from the middle of the tile, y up.
    s0: vec2f,
    s1: vec2f,
    // Depth at both ends.
    z0: f32,
    z1: f32,
    // The edge's index in the mesh, with CONTOUR and BEHIND_SOLID, and BACKWARD if the
    // chain runs from v1 to v0.
    edge: u32,
    // The next node or NO_NODE, with the bits below. Before resolve_links, the next edge.
    next: u32,
}

const BACKWARD: u32 = 0x40000000u;
const NO_NODE: u32 = 0x1fffffffu;
const CUT_START: u32 = 0x80000000u;
const CUT_END: u32 = 0x40000000u;
const CUT_WHOLE: u32 = 0x20000000u;

// The state of a node between two rounds of linking.
struct ChainState {
    // The node `reach` steps ahead; the last node of an open chain points to itself.
    jump: u32,
    // The last node of an open chain, or the smallest node found so far, with ON_LOOP.
    anchor: u32,
    // Steps to the anchor.
    distance: u32,
    // Steps to `jump`.
    reach: u32,
}

const ON_LOOP: u32 = 0x80000000u;

// A chain: its first element and its number of elements. Stored at the anchor's index.
struct Chain {
    first: u32,
    count: u32,
}

// The elements of all chains, one chain after another.
struct Element {
    // As in LinkNode.
    s0: vec2f,
    s1: vec2f,
    z0: f32,
    z1: f32,
    edge: u32,
    next: u32,
    // The first element of its chain.
    first: u32,
    // Elements of its chain, with ON_LOOP if the first follows the last.
    count: u32,
    // Arc length up to here, in pixels times ARC_PER_PX, from an arbitrary origin.
    arc: u32,
    node: u32,
}

// Arc lengths are integers, so that sums are the same in any order, and differences are
// exact however long all chains together are.
const ARC_PER_PX: f32 = 1024.0;

// Offsets of workgroup counts in the buffer of arguments, in words; three words each.
const NODE_GROUPS: u32 = 0u;
const NODE_SUM_GROUPS: u32 = 3u;
const JOINT_GROUPS: u32 = 6u;
const JOINT_SUM_GROUPS: u32 = 9u;
const POINT_GROUPS: u32 = 12u;
const POINT_SUM_GROUPS: u32 = 15u;
// Five words for the ribbons of each stroke set.
const RIBBON_DRAWS: u32 = 18u;
// Then the workgroups of each chunk.
const CHUNK_GROUPS: u32 = RIBBON_DRAWS + 5u * MAX_STROKE_SETS;

// The start of an element in the path of a stroke set.
struct Joint {
    // Cosine of the turn there, measured over some pixels.
    cosine: f32,
    kind: u32,
    // The number of points of the element, and its first point.
    point_count: u32,
    first_point: u32,
}

// Kinds of joints, as bits: the path begins; it turns; strokes are cut; the mesh folds.
const BREAK: u32 = 1u;
const CORNER: u32 = 2u;
const SPLIT: u32 = 4u;
const FOLD: u32 = 8u;
// Joints that keep their place.
const KEPT: u32 = BREAK | CORNER;

// A point of a path. With the next point it forms a segment of the same index.
struct PathPoint {
    // Pixels from the middle of the tile, y up; a contour's front face is on the left.
    position: vec2f,
    // Offset of the drawn line, in pixels.
    offset: vec2f,
    depth: f32,
    // Arc length up to here along the points, in pixels times ARC_PER_PX, from an arbitrary
    // origin.
    arc: u32,
    // The joint of the element that it is on.
    joint: u32,
    flags: u32,
    // The drawn part of its segment, as two fractions; the first is larger if there is none.
    cut: vec2f,
    stroke: u32,
    padding: u32,
}

// Flags of points, in this order: no segment before it; none after it; strokes are cut
// there; it is visible; it is on a contour; a loop was cut there; what hides it is so close
// that it can be its own surface; the path turns there.
const POINT_STARTS: u32 = 1u;
const POINT_ENDS: u32 = 2u;
const POINT_SPLITS: u32 = 4u;
const POINT_IS_VISIBLE: u32 = 8u;
const POINT_ON_CONTOUR: u32 = 16u;
const POINT_ON_SEAM: u32 = 32u;
const POINT_IS_GRAZED: u32 = 64u;
const POINT_IS_CORNER: u32 = 128u;
const SET_SHIFT: u32 = 8u;

// A stroke: its first and last segment, and the arc lengths at its start and end.
struct Stroke {
    first: u32,
    last: u32,
    start_arc: u32,
    end_arc: u32,
}

// A segment of a stroke, ready to be drawn.
struct Ribbon {
    // Start and end, in pixels from the middle of the tile, y up.
    a: vec2f,
    b: vec2f,
    // At both ends: place along the brush, and half of the width in pixels.
    u: vec2f,
    half_width: vec2f,
    // Unit vectors at half of the turn at both ends, along and across the segment.
    join0: vec2f,
    join1: vec2f,
    // At both ends: periods of dashes so far, and depth of the line.
    dash: vec2f,
    depth: vec2f,
    // The part of a period that is ink; 1 for solid lines.
    ink: f32,
    // At both ends, 16 bits each.
    opacity: u32,
    // Kinds of start and end, four bits each; two bits for its side; IS_INSIDE.
    ends: u32,
    // A fill more than this many pixels in front of the line hides it; 0 for never.
    near_px: f32,
}

// Kinds of ends of a segment.
const ENDS_ROUND: u32 = 0u;
const ENDS_FLAT: u32 = 1u;
const ENDS_POINTED: u32 = 2u;
const JOINS_ROUND: u32 = 3u;
const JOINS_MITRED: u32 = 4u;
// Both are round and overlap: one of them is too short for the line between them.
const JOINS_LOOSELY: u32 = 5u;
// Round around the line of a one-sided stroke, to meet another stroke at a corner.
const ENDS_AROUND: u32 = 6u;
const NOT_DRAWN: u32 = 15u;
const IS_INSIDE: u32 = 1024u;
