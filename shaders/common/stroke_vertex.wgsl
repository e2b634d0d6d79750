// One vertex of a stroke: quad, caps, and where the brush lies on them.
// Rust twin, with the reasons: crates/edgemesh/src/oracle/stroke_vertex.rs.
#import <common/feature.wgsl>
#import <common/stroke_cap.wgsl>

// Behind the near plane, where nothing is seen (section 3.2).
const BEHIND: vec4f = vec4f(0.0, 0.0, -1.0, 1.0);

const EDGE_ON_FACING: f32 = 0.05;
const LIFTED_FACING: f32 = 0.2;

struct ClipEdge {
    c0: vec4f,
    c1: vec4f,
    // Third vertices of face A and B; c3 = c0 where there is no B.
    c2: vec4f,
    c3: vec4f,
    // How squarely faces A and B look at the eye, 0 to 1.
    facing: vec2f,
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

    let reach_px = select(shape.width_px * 0.5, shape.width_px, is_half);

    if index < 6u {
        // Corners 0, 1, 2 and 0, 2, 3.
        let i = select(index, index - 3u + u32(index > 3u), index >= 3u);
        let s = select(
            stroke_quad(spine, reach_px, i),
            half_quad(spine, reach_px, side0, i),
            is_half,
        );
        let is_end = i == 1u || i == 2u;
        let rim = select(side0 * 0.5 + 0.5, 1.0, is_half);
        let uv = vec2f(select(u0, u1, is_end), select(rim, 1.0 - rim, i >= 2u));
        var z = select(spine.z0, spine.z1, is_end);
        if !is_half {
            z += quad_rise(edge, spine, shape.viewport_px, select(-1.0, 1.0, i >= 2u), reach_px);
        }
        return on_screen(s, z, uv, shape);
    }
    let is_start = index < 9u;
    // A clipped end is no vertex of the mesh, and nobody meets it there.
    if (is_start && spine.t0 > 0.0) || (!is_start && spine.t1 < 1.0) {
        return hidden;
    }
    let m = select(m1, m0, is_start);
    let side = select(side1, side0, is_start);
    let j = cap_corner(side, index % 3u);
    let s = select(spine.s1, spine.s0, is_start);
    var z = select(spine.z1, spine.z0, is_start);
    if j != 0u && !is_half {
        z += quad_rise(edge, spine, shape.viewport_px, side, reach_px);
    }
    let uv = vec2f(select(u1, u0, is_start), select(0.0, select(0.5, 1.0, is_half), j == 0u));
    return on_screen(stroke_cap(s, spine.p, m, side, reach_px, j), z, uv, shape);
}

// How much nearer than the edge the rim of a full quad must lie on one side.
fn quad_rise(edge: ClipEdge, spine: Spine, viewport_px: vec2f, side: f32, reach_px: f32) -> f32 {
    let middle = lerp(edge.c0, edge.c1, (spine.t0 + spine.t1) * 0.5);
    let a = in_front(middle, edge.c2);
    let b = in_front(middle, edge.c3);
    return max(
        rise_toward_eye(spine, a, edge.facing.x, viewport_px, side, reach_px),
        rise_toward_eye(spine, b, edge.facing.y, viewport_px, side, reach_px),
    );
}

// A point of the face for its third vertex, in front of the near plane.
fn in_front(middle: vec4f, apex: vec4f) -> vec4f {
    let middle_distance = middle.w - middle.z;
    let apex_distance = apex.w - apex.z;
    if apex_distance > 0.0 {
        return apex;
    }
    return lerp(middle, apex, 0.5 * middle_distance / (middle_distance - apex_distance));
}

// How much nearer the face with the point `apex` lies, reach_px away.
fn rise_toward_eye(
    spine: Spine,
    apex: vec4f,
    facing: f32,
    viewport_px: vec2f,
    side: f32,
    reach_px: f32,
) -> f32 {
    if apex.w <= 0.0 {
        return 0.0;
    }
    let along = spine.s1 - spine.s0;
    let to_apex = to_pixels(apex, viewport_px) - spine.s0;
    let distance_px = dot(to_apex, spine.p) * side;
    if distance_px < MIN_LENGTH_PX {
        return 0.0;
    }
    let t = dot(to_apex, along) / dot(along, along);
    let edge_depth = spine.z0 + (spine.z1 - spine.z0) * t;
    let rise = apex.z / apex.w - edge_depth;
    let share = lift_share(facing, distance_px / reach_px);
    return max(rise * min(reach_px / distance_px, 1.0) * share, 0.0);
}

// How much of a face's rise counts: nothing of a narrow wall seen edge on.
fn lift_share(facing: f32, reaches_wide: f32) -> f32 {
    let seen = (facing - EDGE_ON_FACING) / (LIFTED_FACING - EDGE_ON_FACING);
    let wide = 0.5 * reaches_wide - 1.0;
    return clamp(max(seen, wide), 0.0, 1.0);
}

fn on_screen(position_px: vec2f, depth: f32, uv: vec2f, shape: StrokeShape) -> StrokeVertex {
    // w = 1 after our own divide: every varying is linear on the screen.
    return StrokeVertex(vec4f(position_px / (shape.viewport_px * 0.5), depth, 1.0), uv);
}
