// The layout and method of McGuire and Hughes (section 3) at 16 bits. Vertex formats have
// two or four components, so the eighteen numbers arrive in fours and are split here.
#import <common/replicated_corner.wgsl>

struct EdgeVertex16 {
    @location(0) a: vec4i,
    @location(1) b: vec4i,
    @location(2) c: vec4i,
    @location(3) d: vec4i,
    @location(4) e: vec2i,
    @location(5) corner_and_flags: vec4u,
}

@vertex
fn stroke_vertices(in: EdgeVertex16, @builtin(instance_index) part: u32) -> StrokeVarying {
    let edge = EdgeGeometry(
        position(in.a.xyz),
        position(vec3i(in.a.w, in.b.xy)),
        position(vec3i(in.b.zw, in.c.x)),
        position(in.c.yzw),
        vec3f(in.d.xyz) / 32767.0,
        vec3f(vec3i(in.d.w, in.e)) / 32767.0,
        f32(in.corner_and_flags.x >> 2u) / 64.0,
    );
    let flags = in.corner_and_flags;
    let word = word_of_24_bits(flags.y | (flags.z << 8u) | (flags.w << 16u));
    let corner = corner_of_part(part, flags.x & 3u);
    return classified(edge, word, faces_of_geometry(edge), corner);
}

fn position(steps: vec3i) -> vec3f {
    return dequantize(vec3f(steps), object.center, object.step);
}

@fragment
fn stroke_fragment(in: Varying) -> @location(0) vec4f {
    return cut(in.position, ink(in.uv, in.opacity));
}
