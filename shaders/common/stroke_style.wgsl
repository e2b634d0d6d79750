// The style of one draw of strokes.
#import <common/edge_geometry.wgsl>
#import <common/draw_arguments.wgsl>

// Rust twin: StrokeUniform in crates/strokes/src/draw/stroke.rs.
struct StrokeUniform {
    // Premultiplied.
    color: vec4f,
    fade: vec2f,
    width: f32,
    // Length of the brush divided by its height.
    brush_aspect: f32,
    kind: u32,
    placement: u32,
    parameterization: u32,
    // 1 if the width is in world units, 0 if in pixels.
    is_world_width: u32,
    // The layer whose edges are drawn, and the index of the stroke set.
    layer: u32,
    set_index: u32,
    // Indices per edge.
    index_count: u32,
    // 1 if edges hidden by their own solid are drawn.
    shows_hidden: u32,
    // Factor of the opacity behind transparent surfaces.
    behind_glass: f32,
    unused: u32,
    padding: vec2u,
    // For vertex shaders that detect features.
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

// Whether the draw leaves out an edge because its own solid hides it.
fn is_passed_over(bits: u32) -> bool {
    return (bits & BEHIND_SOLID) != 0u && stroke.shows_hidden == 0u;
}

// The corner for index i of an edge. Rust twin: LineKind::indices.
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
