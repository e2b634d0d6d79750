// What one view makes of all runs of edges of an object, and its counts. Rust
// twins: RunState and Tally in crates/strokes/src/view/live_lists.rs.
#import <common/line_class.wgsl>
#import <common/object_limits.wgsl>

// Edges an invocation looks at. Rust twin: EDGES_PER_RUN in crates/strokes/src/mesh/layout.rs.
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
    // 1 where the winding of two faces clashes: their contours are elsewhere.
    has_clash: u32,
    padding: u32,
}

// The counts of a chunk in a view.
struct Tally {
    // Edges in the live list.
    stroke_count: u32,
    // Edges of each line class.
    features: array<atomic<u32>, LINE_CLASS_COUNT>,
    // Where the edges of each layer begin in the live list; the last is their
    // number.
    layer_first: array<u32, MAX_LAYERS + 1u>,
}
