// One vertex of a stroke: quad, caps, and where the brush lies on them.
// Rust twin, with the reasons: crates/edgemesh/src/oracle/stroke_vertex.rs.
#import <common/feature.wgsl>
#import <common/stroke_cap.wgsl>

// Behind the near plane, where nothing is seen (section 3.2).
const BEHIND: vec4f = vec4f(0.0, 0.0, -1.0, 1.0);

struct ClipEdge {
    c0: vec4f,
    c1: vec4f,
    n0: vec4f,
    n1: vec4f,
    r: f32,
}

struct StrokeShape {
    viewport_px: vec2f,
    width_px: f32,
    brush_aspect: f32,
}

struct StrokeVertex {
    position: vec4f,
    uv: vec2f,
}

fn stroke_vertex(edge: ClipEdge, shape: StrokeShape, bits: u32, index: u32) -> StrokeVertex {
    let spine = project_spine(edge.c0, edge.c1, shape.viewport_px);
    let hidden = StrokeVertex(BEHIND, vec2f(0.0));
    if all(spine.p == vec2f(0.0)) {
        return hidden;
    }
    let m0 = screen_normal(lerp(edge.c0, edge.c1, spine.t0), edge.n0, shape.viewport_px);
    let m1 = screen_normal(lerp(edge.c0, edge.c1, spine.t1), edge.n1, shape.viewport_px);
    let is_half = (bits & CONTOUR) != 0u;
    // p lies left of the edge, and so does face A where it looks at the eye.
    let contour_side = select(1.0, -1.0, (bits & A_FACES) != 0u);
    let side0 = select(stroke_sign(dot(m0, spine.p)), contour_side, is_half);
    let side1 = select(stroke_sign(dot(m1, spine.p)), contour_side, is_half);
    let length_px = length(spine.s1 - spine.s0);
    let u0 = edge.r;
    let u1 = edge.r + side0 * length_px / (shape.width_px * shape.brush_aspect);

    if index < 6u {
        // Corners 0, 1, 2 and 0, 2, 3.
        let i = select(index, (index - 3u + u32(index > 3u)), index >= 3u);
        let s = select(
            stroke_quad(spine, shape.width_px * 0.5, i),
            half_quad(spine, shape.width_px, side0, i),
            is_half,
        );
        let is_end = i == 1u || i == 2u;
        let rim = select(side0 * 0.5 + 0.5, 1.0, is_half);
        let uv = vec2f(select(u0, u1, is_end), select(rim, 1.0 - rim, i >= 2u));
        return on_screen(s, select(spine.z0, spine.z1, is_end), uv, shape);
    }
    let is_start = index < 9u;
    // A clipped end is no vertex of the mesh, and nobody meets it there.
    if (is_start && spine.t0 > 0.0) || (!is_start && spine.t1 < 1.0) {
        return hidden;
    }
    let m = select(m1, m0, is_start);
    let side = select(side1, side0, is_start);
    let j = cap_corner(side, index % 3u);
    let reach_px = select(shape.width_px * 0.5, shape.width_px, is_half);
    let s = select(spine.s1, spine.s0, is_start);
    let uv = vec2f(select(u1, u0, is_start), select(0.0, select(0.5, 1.0, is_half), j == 0u));
    let position_px = stroke_cap(s, spine.p, m, side, reach_px, j);
    return on_screen(position_px, select(spine.z1, spine.z0, is_start), uv, shape);
}

fn on_screen(position_px: vec2f, depth: f32, uv: vec2f, shape: StrokeShape) -> StrokeVertex {
    // w = 1 after our own divide: every varying is linear on the screen.
    return StrokeVertex(vec4f(position_px / (shape.viewport_px * 0.5), depth, 1.0), uv);
}
