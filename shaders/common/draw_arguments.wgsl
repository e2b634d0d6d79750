// The arguments of one draw of strokes, written by the GPU. Rust twin: DrawArguments in
// crates/strokes/src/view/live_lists.rs.
#import <common/object_limits.wgsl>

struct DrawArguments {
    // The expanded strokes, drawn with indices.
    index_count: u32,
    instance_count: u32,
    first_index: u32,
    base_vertex: u32,
    first_instance: u32,
    // Workgroups that expand them.
    groups_x: u32,
    groups_y: u32,
    groups_z: u32,
    // All other strokes, drawn straight from the list.
    vertex_count: u32,
    rest_instance_count: u32,
    first_vertex: u32,
    rest_first_instance: u32,
    // The draw's first edge in the live list, and how many edges are expanded.
    first: u32,
    expanded: u32,
    padding: vec2u,
}
