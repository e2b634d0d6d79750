// The state of runs of edges in one view, and the counts of the view. Rust twins: RunState
// and Tally in crates/strokes/src/view/live_lists.rs.
#import <common/line_class.wgsl>
#import <common/object_limits.wgsl>

// Edges per invocation. Rust twin: EDGES_PER_RUN in crates/strokes/src/mesh/layout.rs.
const EDGES_PER_RUN: u32 = 64u;

struct RunState {
    // Edges that are drawn in every view, one bit each.
    static_edges: vec2u,
    // Those of them that their own solid can hide.
    solid: vec2u,
    // Edges drawn in this view.
    live: vec2u,
    // Contours of this view.
    contour: vec2u,
    // 1 if the winding of two faces clashes, so that the cone cannot rule out contours.
    has_clash: u32,
    padding: u32,
}

// The counts of a chunk in a view.
struct Tally {
    // Edges in the live list.
    stroke_count: u32,
    // Edges of each line class.
    features: array<atomic<u32>, LINE_CLASS_COUNT>,
    // The first edge of each layer in the live list; the last value is the number of edges.
    layer_first: array<u32, MAX_LAYERS + 1u>,
}
