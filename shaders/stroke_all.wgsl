// Draws every edge of the indexed layout; the vertex shader decides which are features
// (McGuire and Hughes, section 3).
#import <common/faces_planes.wgsl>
#import <common/stroke_classified.wgsl>

@vertex
fn stroke_vertices(@builtin(vertex_index) vertex_index: u32) -> StrokeVarying {
    let edge = vertex_index / stroke.index_count;
    let corner = corner_of(vertex_index % stroke.index_count);
    let faces = edge_faces(edge);
    return classified(edge_geometry(edge), edge_word(edge), faces, corner);
}

@fragment
fn stroke_fragment(in: Varying) -> @location(0) vec4f {
    return cut(in.position, ink(in.uv, in.opacity));
}
