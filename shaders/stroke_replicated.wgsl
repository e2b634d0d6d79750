// The layout and method of McGuire and Hughes (section 3) in 32-bit floats: four copies of
// an edge as vertices that differ only in the corner index i, and no storage buffer.
#import <common/replicated_corner.wgsl>

struct EdgeVertex {
    @location(0) v0: vec3f,
    @location(1) v1: vec3f,
    @location(2) v2: vec3f,
    @location(3) v3: vec3f,
    @location(4) n0: vec3f,
    @location(5) n1: vec3f,
    @location(6) r: f32,
    @location(7) corner_and_flags: u32,
}

@vertex
fn stroke_vertices(in: EdgeVertex, @builtin(instance_index) part: u32) -> StrokeVarying {
    let edge = EdgeGeometry(in.v0, in.v1, in.v2, in.v3, in.n0, in.n1, in.r);
    let corner = corner_of_part(part, in.corner_and_flags & 3u);
    let faces = faces_of_geometry(edge);
    return classified(edge, in.corner_and_flags >> 2u, faces, corner);
}

@fragment
fn stroke_fragment(in: Varying) -> @location(0) vec4f {
    return cut(in.position, ink(in.uv, in.opacity));
}
