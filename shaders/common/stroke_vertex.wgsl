// One vertex of a stroke: of a thin line, a quad, a cap, a half disk (McGuire and Hughes,
// section 3) or a fin (Card and Mitchell, Listing 1).
// Rust twin: crates/edgemesh/src/oracle/stroke_vertex.rs.
#import <common/stroke_segment.wgsl>

// Behind the near plane, where nothing is drawn (section 3.2).
const BEHIND: vec3f = vec3f(0.0, 0.0, -1.0);

// Additional vertices for each end of a quad.
const CAP_VERTICES: u32 = 3u;
const DISK_VERTICES: u32 = DISK_STEPS + 2u;

// This far outside a contour, no sample of a pixel lies on its own surface. Includes one
// pixel for the push of the fill, so that a surface close in front still hides the edge.
const FOOT_PX: f32 = 2.5;

struct StrokeVertex {
    // In clip space with w = 1, so that everything is linear on the screen.
    position: vec3f,
    u: f32,
    v: f32,
    opacity: f32,
    // Where a contour is tested for visibility: beside it, off the surface, in pixels from
    // the middle of the tile, y up; z is the depth of the edge.
    foot: vec3f,
    // How far the vertex lies over the surface that a contour bounds, in pixels; negative
    // off it, 0 for other lines.
    over_px: f32,
}

fn culled_vertex() -> StrokeVertex {
    return StrokeVertex(BEHIND, 0.0, 0.0, 0.0, vec3f(0.0), 0.0);
}

fn stroke_vertex(edge: ClipEdge, shape: StrokeShape, bits: u32, corner: u32) -> StrokeVertex {
    if shape.kind == FIN {
        return fin_vertex(edge, shape, corner);
    }
    return segment_vertex(stroke_segment(edge, shape, bits), shape, corner);
}

fn segment_vertex(segment: Segment, shape: StrokeShape, corner: u32) -> StrokeVertex {
    let spine = segment.spine;
    if !segment.is_drawn {
        return culled_vertex();
    }
    if shape.kind == THIN {
        let is_end = corner == 1u;
        return at_end(segment, shape, is_end, vec2f(0.0), 0.0, 0.5);
    }
    if corner < 4u {
        let is_end = corner == 1u || corner == 2u;
        if corner < 2u {
            let offset = spine.p * of_end(segment.near_px, is_end);
            return at_end(segment, shape, is_end, offset, segment.near_rise, segment.v_near);
        }
        let offset = spine.p * of_end(segment.far_px, is_end);
        var vertex = at_end(segment, shape, is_end, offset, segment.far_rise, segment.v_far);
        vertex.u = of_end(segment.u_far, is_end);
        return vertex;
    }
    let per_end = select(DISK_VERTICES, CAP_VERTICES, shape.kind == QUAD_AND_CAPS);
    let is_end = corner >= 4u + per_end;
    // A clipped end is not a vertex of the mesh, and needs no cap.
    if select(spine.t0 > 0.0, spine.t1 < 1.0, is_end) {
        return culled_vertex();
    }
    let i = (corner - 4u) % per_end;
    if shape.kind == QUAD_AND_CAPS {
        return cap_vertex(segment, shape, is_end, i);
    }
    return disk_vertex(segment, shape, is_end, i);
}

fn cap_vertex(segment: Segment, shape: StrokeShape, is_end: bool, i: u32) -> StrokeVertex {
    let side = of_end(segment.cap_side, is_end);
    let m = select(segment.m0, segment.m1, is_end);
    let j = cap_corner(side, i);
    // A cap that is left out gets no area.
    if j == 0u || !cap_fills_gap(segment.spine.p, m, side, select(-1.0, 1.0, is_end)) {
        return at_end(segment, shape, is_end, vec2f(0.0), 0.0, segment.v_spine);
    }
    let far_px = of_end(segment.far_px, is_end);
    let offset = stroke_cap(vec2f(0.0), segment.spine.p, m, side, abs(far_px), j);
    let is_far = stroke_sign(far_px) == side;
    let rise = select(segment.near_rise, segment.far_rise, is_far);
    let v = select(segment.v_near, segment.v_far, is_far);
    var vertex = at_end(segment, shape, is_end, offset, rise, v);
    if j == 1u {
        vertex.u = of_end(select(segment.u, segment.u_far, is_far), is_end);
    }
    return vertex;
}

fn disk_vertex(segment: Segment, shape: StrokeShape, is_end: bool, i: u32) -> StrokeVertex {
    if i == 0u {
        return at_end(segment, shape, is_end, vec2f(0.0), 0.0, segment.v_spine);
    }
    let near_px = of_end(segment.near_px, is_end);
    let far_px = of_end(segment.far_px, is_end);
    let left_px = max(max(near_px, far_px), 0.0);
    let right_px = max(-min(near_px, far_px), 0.0);
    let forward = select(-1.0, 1.0, is_end);
    let offset = half_disk(segment.spine.p, forward, left_px, right_px, i - 1u);
    let is_left = 2u * (i - 1u) < DISK_STEPS;
    let is_far = (far_px > 0.0) == is_left;
    let rise = select(segment.near_rise, segment.far_rise, is_far);
    let v = select(segment.v_near, segment.v_far, is_far);
    return at_end(segment, shape, is_end, offset, rise, v);
}

// A vertex at an offset from one end of the spine.
fn at_end(
    segment: Segment,
    shape: StrokeShape,
    is_end: bool,
    offset_px: vec2f,
    rise: f32,
    v: f32,
) -> StrokeVertex {
    let s = select(segment.spine.s0, segment.spine.s1, is_end);
    let z = select(segment.spine.z0, segment.spine.z1, is_end);
    let position = vec3f((s + offset_px) / (shape.viewport_px * 0.5), z + rise);
    let u = of_end(segment.u, is_end);
    let opacity = of_end(segment.opacity, is_end);
    let outward = segment.spine.p * segment.outside;
    let foot = vec3f(s + outward * FOOT_PX, z);
    return StrokeVertex(position, u, v, opacity, foot, -dot(offset_px, outward));
}

fn of_end(values: vec2f, is_end: bool) -> f32 {
    return select(values.x, values.y, is_end);
}

// A fin (Card and Mitchell, Listing 1): a quad that stands on the edge along the vertex
// normals. Corners are those of the quad; 2 and 3 are pushed out.
fn fin_vertex(edge: ClipEdge, shape: StrokeShape, corner: u32) -> StrokeVertex {
    let culled = culled_vertex();
    let spine = project_spine(edge.c0, edge.c1, shape.viewport_px, shape.guard_band);
    if all(spine.p == vec2f(0.0)) {
        return culled;
    }
    let start = lerp(edge.c0, edge.c1, spine.t0);
    let end = lerp(edge.c0, edge.c1, spine.t1);
    let start_tip = start + lerp(edge.n0, edge.n1, spine.t0) * fin_height(start, shape);
    let end_tip = end + lerp(edge.n0, edge.n1, spine.t1) * fin_height(end, shape);
    if start_tip.w - start_tip.z <= 0.0 || end_tip.w - end_tip.z <= 0.0 {
        return culled;
    }
    let is_end = corner == 1u || corner == 2u;
    let is_tip = corner >= 2u;
    let clip = select(select(start, end, is_end), select(start_tip, end_tip, is_end), is_tip);
    let m0 = screen_normal(start, edge.n0, shape.viewport_px);
    let side = stroke_sign(dot(m0, spine.p));
    let width_px = max(width_at(start, shape), MIN_LENGTH_PX);
    let u = of_end(stroke_u(spine, shape, side, width_px, edge.r), is_end);
    let t = select(spine.t0, spine.t1, is_end);
    let opacity = opacity_at(edge.distance.x * (1.0 - t) + edge.distance.y * t, shape);
    let v = select(1.0, 0.0, is_tip);
    return StrokeVertex(clip.xyz / clip.w, u, v, opacity, vec3f(0.0), 0.0);
}

// In world units; a width in pixels is scaled by the distance.
fn fin_height(clip: vec4f, shape: StrokeShape) -> f32 {
    if shape.is_world_width {
        return shape.width;
    }
    return shape.width * clip.w / shape.px_per_unit;
}
