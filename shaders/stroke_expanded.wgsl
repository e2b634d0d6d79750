// Draws strokes from the vertices that expand_strokes.wgsl computed.
#import <common/stroke_ink.wgsl>

@vertex
fn stroke_vertices(
    @location(0) position: vec3f,
    @location(1) u: f32,
    @location(2) v_and_opacity: vec2f,
) -> Varying {
    return Varying(vec4f(position, 1.0), vec2f(u, v_and_opacity.x), v_and_opacity.y);
}

@fragment
fn stroke_fragment(in: Varying) -> @location(0) vec4f {
    return cut(in.position, ink(in.uv, in.opacity));
}
