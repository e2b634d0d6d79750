// The scene in one color.
#import <common/frame.wgsl>

struct Params {
    color: vec4f,
}

@group(1) @binding(0) var<uniform> params: Params;

struct FlatVarying {
    // Invariant, so that a later pass gets the same depth.
    @builtin(position) @invariant position: vec4f,
    @location(0) point_in_world: vec3f,
}

@vertex
fn flat_vertex(@location(0) position: vec3f) -> FlatVarying {
    return FlatVarying(
        object.clip_from_object * vec4f(position, 1.0),
        (object.world_from_object * vec4f(position, 1.0)).xyz,
    );
}

@fragment
fn flat(at: FlatVarying) -> @location(0) vec4f {
    if is_cut_away(at.point_in_world) {
        discard;
    }
    return vec4f(params.color.rgb * params.color.a, params.color.a);
}
