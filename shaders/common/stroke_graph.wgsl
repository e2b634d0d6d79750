// What the stroke graph of one object is made of. Rust twins:
// crates/strokes/src/graph/buffers.rs.
#import <common/object_limits.wgsl>

// Invocations a workgroup.
const GROUP: u32 = 64u;

// Rounds of linking, at most: each looks four times as far.
const MAX_LINK_ROUNDS: u32 = 16u;

// Items that one invocation sums up before a scan.
const ITEMS_PER_SUM: u32 = 16u;

// Which stroke sets are linked, and how much room there is.
struct GraphUniform {
    chunk_count: u32,
    set_count: u32,
    joint_capacity: u32,
    point_capacity: u32,
    // 1 where contours are in a layer as such: else an edge is what else it is.
    draws_contours: u32,
    // The most linked stroke sets of one layer.
    sets_per_layer: u32,
    padding: vec2u,
    sets: array<LinkedSet, MAX_STROKE_SETS>,
}

// What linking must know of a stroke set.
struct LinkedSet {
    layer: u32,
    // 1 if its strokes are linked.
    is_linked: u32,
    padding: vec2u,
}

struct GraphHeader {
    node_count: u32,
    // Elements of all linked stroke sets together: one joint each.
    joint_count: u32,
    point_count: u32,
    stroke_count: u32,
    chain_count: u32,
    // Arc length of all chains, in pixels.
    total_px: f32,
    // Points that there is room for.
    point_capacity: u32,
    sets_per_layer: u32,
    // Where the nodes of each layer begin; the last is their number.
    layer_first: array<u32, MAX_LAYERS + 1u>,
    // Where the joints of each stroke set begin, and their number.
    set_first: array<u32, MAX_STROKE_SETS + 1u>,
    // 1 where a round of linking changed anything.
    changed: array<atomic<u32>, MAX_LINK_ROUNDS>,
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
const CUT_WHOLE: u32 = 0x20000000u;

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
    // As in the node.
    s0: vec2f,
    s1: vec2f,
    z0: f32,
    z1: f32,
    edge: u32,
    next: u32,
    // The first element of its chain.
    first: u32,
    // Elements of its chain, and ON_LOOP where the last is followed by the first.
    count: u32,
    // Arc length up to here, in ARC_PER_PX of a pixel, from anywhere.
    arc: u32,
    node: u32,
}

// Arc lengths are whole numbers, so that sums are the same in any order, and those
// of a chain are exact however long all chains together are.
const ARC_PER_PX: f32 = 1024.0;

// Workgroups of dispatches: three words each.
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

// The beginning of an element in the path of a stroke set.
struct Joint {
    // Cosine of the turn there, measured over some pixels.
    cosine: f32,
    kind: u32,
    // Points of the element, and the first among all.
    point_count: u32,
    first_point: u32,
}

// Kinds of joints.
const BREAK: u32 = 1u;
const CORNER: u32 = 2u;
const SPLIT: u32 = 4u;
const FOLD: u32 = 8u;
// Those that keep their place.
const KEPT: u32 = BREAK | CORNER;

// A point of a path; with the one that follows it, a segment.
struct PathPoint {
    // Pixels from the middle of the picture, y up; a contour's front is on the left.
    position: vec2f,
    // How far beside it the line is drawn.
    offset: vec2f,
    depth: f32,
    // Arc length up to here along the points, in ARC_PER_PX of a pixel, from anywhere.
    arc: u32,
    // The joint of the element that it is on.
    joint: u32,
    flags: u32,
    // What of its segment is drawn, as fractions from and to; the other way round for
    // nothing.
    cut: vec2f,
    stroke: u32,
    padding: u32,
}

// Flags of points: no segment comes before it, none after it; strokes are cut there; nothing hides it; it is on a contour; it is the place where
// a loop was cut; what hides it is no further in front than a line is wide; the path
// turns there.
const POINT_STARTS: u32 = 1u;
const POINT_ENDS: u32 = 2u;
const POINT_SPLITS: u32 = 4u;
const POINT_IS_VISIBLE: u32 = 8u;
const POINT_ON_CONTOUR: u32 = 16u;
const POINT_ON_SEAM: u32 = 32u;
const POINT_IS_GRAZED: u32 = 64u;
const POINT_IS_CORNER: u32 = 128u;
const SET_SHIFT: u32 = 8u;

// A stroke: from the first segment to the last one, and from arc length to arc length.
struct Stroke {
    first: u32,
    last: u32,
    start_arc: u32,
    end_arc: u32,
}

// A segment of a stroke, ready to be drawn.
struct Ribbon {
    a: vec2f,
    b: vec2f,
    u: vec2f,
    // Half of the width at both ends, in pixels.
    half_width: vec2f,
    // Unit vectors of the turns at both ends, halved: along and across the segment.
    join0: vec2f,
    join1: vec2f,
    // Dashes so far at both ends, in periods.
    dash: vec2f,
    // Depth of the line at both ends.
    depth: vec2f,
    // Of a period, how much is ink; 1 for whole lines.
    ink: f32,
    // At both ends, as fractions.
    opacity: u32,
    // How it begins and how it ends, four bits each; two bits for its side; IS_INSIDE.
    ends: u32,
    // What is filled so many pixels before the line hides it; 0 for never.
    near_px: f32,
}

// How a segment begins and ends.
const ENDS_ROUND: u32 = 0u;
const ENDS_FLAT: u32 = 1u;
const ENDS_POINTED: u32 = 2u;
const JOINS_ROUND: u32 = 3u;
const JOINS_MITRED: u32 = 4u;
// Without a line between the two: one of them is shorter than the other is wide.
const JOINS_LOOSELY: u32 = 5u;
// Round about the line of a one-sided stroke, to meet another one at a corner.
const ENDS_AROUND: u32 = 6u;
const NOT_DRAWN: u32 = 15u;
const IS_INSIDE: u32 = 1024u;
