// What one view makes of all runs of edges of an object, and its counts. Rust
// twins: RunState and Tally in crates/strokes/src/view_buffers.rs.
#import <common/object_limits.wgsl>

// Edges an invocation looks at. Rust twin: EDGES_PER_RUN in mesh_buffers.rs.
const EDGES_PER_RUN: u32 = 64u;

struct RunState {
    // Edges that are drawn without being contours, one bit each.
    marked: vec2u,
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
    contour: atomic<u32>,
    stroke_count: u32,
    ridge: atomic<u32>,
    valley: atomic<u32>,
    boundary: atomic<u32>,
    marked: atomic<u32>,
    material: atomic<u32>,
    smoothing: atomic<u32>,
    // Where the edges of each layer begin in the live list; the last is their
    // number.
    layer_first: array<u32, 8>,
}
