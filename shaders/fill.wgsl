// Fills the surface: depth, against which strokes are tested, and one flat color. Both
// sides of a face are filled.
#import <common/frame.wgsl>

// Rust twin: FillUniform in crates/strokes/src/draw/fill.rs.
struct FillUniform {
    color: vec4f,
}

@group(1) @binding(0) var<uniform> fill: FillUniform;

struct FillVarying {
    // Invariant, so that a later pass gets the same depth.
    @builtin(position) @invariant position: vec4f,
    @location(0) point_in_world: vec3f,
}

@vertex
fn fill_vertex(@location(0) position: vec3f) -> FillVarying {
    return FillVarying(
        object.clip_from_object * vec4f(position, 1.0),
        (object.world_from_object * vec4f(position, 1.0)).xyz,
    );
}

@fragment
fn fill_fragment(at: FillVarying) -> @location(0) vec4f {
    if is_cut_away(at.point_in_world) {
        discard;
    }
    return fill.color;
}
