// The style of one draw of strokes, and which of its edges it draws.
#import <common/edge_geometry.wgsl>
#import <common/draw_arguments.wgsl>

// Rust twin: StrokeUniform in crates/strokes/src/draw/stroke.rs.
struct StrokeUniform {
    // Premultiplied.
    color: vec4f,
    fade: vec2f,
    width: f32,
    // Length of the brush over its height.
    brush_aspect: f32,
    kind: u32,
    placement: u32,
    parameterization: u32,
    // 1 where the width is in units of the world, 0 in pixels.
    is_world_width: u32,
    // The layer whose edges are drawn, and the draw's place among all.
    layer: u32,
    set_index: u32,
    // Indices an edge.
    index_count: u32,
    // 1 where edges that their own solid hides are drawn.
    shows_hidden: u32,
    // The classes, for vertex shaders that detect.
    classes: ClassTable,
}

@group(1) @binding(0) var<uniform> stroke: StrokeUniform;

fn stroke_shape() -> StrokeShape {
    return StrokeShape(
        frame.viewport_px,
        object.origin_px,
        stroke.fade,
        stroke.width,
        frame.px_per_unit,
        stroke.brush_aspect,
        object.mirror,
        stroke.kind,
        stroke.placement,
        stroke.parameterization,
        stroke.is_world_width != 0u,
        frame.guard_band,
    );
}

// Whether the draw passes over an edge: one that its own solid hides.
fn is_passed_over(bits: u32) -> bool {
    return (bits & BEHIND_SOLID) != 0u && stroke.shows_hidden == 0u;
}

// The corner that index i of an edge names. Rust twin: LineKind::indices.
fn corner_of(i: u32) -> u32 {
    if stroke.kind == THIN || i < 3u {
        return i;
    }
    if i < 6u {
        return array<u32, 3>(0u, 2u, 3u)[i - 3u];
    }
    if stroke.kind == QUAD_AND_CAPS {
        return i - 2u;
    }
    let triangle = (i - 6u) / 3u;
    let middle = 4u + select(0u, DISK_VERTICES, triangle >= DISK_STEPS);
    let k = (i - 6u) % 3u;
    return middle + select(triangle % DISK_STEPS + k, 0u, k == 0u);
}
