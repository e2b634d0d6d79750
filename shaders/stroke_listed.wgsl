// Draws strokes straight from the live list: those that did not fit into the expansion.
//
//        6                          9
//      . |  3 ----------------- 2   | .
//    5---4  .                   .   7--8
//           0 ----------------- 1
#import <common/edge_source.wgsl>
#import <common/stroke_ink.wgsl>

@group(3) @binding(0) var<storage, read> live: array<u32>;
@group(3) @binding(1) var<storage, read> draws: array<DrawArguments>;

@vertex
fn stroke_vertices(@builtin(vertex_index) vertex_index: u32) -> StrokeVarying {
    let slot = vertex_index / stroke.index_count;
    let entry = live[draws[stroke.set_index].first + slot];
    if is_passed_over(entry) {
        return varying_of(culled_vertex());
    }
    let edge = clip_edge(edge_geometry(entry & EDGE_INDEX_MASK));
    let corner = corner_of(vertex_index % stroke.index_count);
    return varying_of(stroke_vertex(edge, stroke_shape(), entry, corner));
}

@fragment
fn stroke_fragment(in: Varying) -> @location(0) vec4f {
    return cut(in.position, ink(in.uv, in.opacity));
}
