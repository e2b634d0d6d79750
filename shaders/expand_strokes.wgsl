// Computes the vertices of each stroke once. The vertex shader that draws them only
// passes them on, however often the rasterizer asks for a vertex.
#import <common/edge_source.wgsl>
#import <common/stroke_style.wgsl>

@group(3) @binding(0) var<storage, read> live: array<u32>;
@group(3) @binding(1) var<storage, read> draws: array<DrawArguments>;
// Five words per vertex: position (3), u, then v and opacity in 16 bits each.
@group(3) @binding(2) var<storage, read_write> vertices: array<u32>;

// Vertices per edge.
override VERTEX_COUNT: u32 = 10u;

@compute @workgroup_size(64)
fn expand_strokes(@builtin(global_invocation_id) id: vec3u) {
    let slot = id.x;
    let arguments = draws[stroke.set_index];
    if slot >= arguments.expanded {
        return;
    }
    let entry = live[arguments.first + slot];
    let shape = stroke_shape();
    let edge = clip_edge(edge_geometry(entry & EDGE_INDEX_MASK));
    var segment = Segment();
    if stroke.kind != FIN && !is_passed_over(entry) {
        segment = stroke_segment(edge, shape, entry);
    }
    for (var corner = 0u; corner < VERTEX_COUNT; corner++) {
        var vertex = segment_vertex(segment, shape, corner);
        if stroke.kind == FIN && !is_passed_over(entry) {
            vertex = fin_vertex(edge, shape, corner);
        }
        let at = 5u * (VERTEX_COUNT * slot + corner);
        let position = bitcast<vec3u>(vertex.position);
        vertices[at] = position.x;
        vertices[at + 1u] = position.y;
        vertices[at + 2u] = position.z;
        vertices[at + 3u] = bitcast<u32>(vertex.u);
        vertices[at + 4u] = pack2x16unorm(vec2f(vertex.v, vertex.opacity));
    }
}
