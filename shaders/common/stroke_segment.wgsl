// An edge as a stroke on the screen: the values that all of its vertices share (McGuire and
// Hughes, sections 3 and 4). Rust twin, with the reasons:
// crates/edgemesh/src/oracle/stroke_segment.rs.
#import <common/feature.wgsl>
#import <common/stroke_cap.wgsl>

const EDGE_ON_FACING: f32 = 0.05;
const LIFTED_FACING: f32 = 0.2;

// Kinds of lines, with their ends.
const THIN: u32 = 0u;
const QUAD: u32 = 1u;
const QUAD_AND_CAPS: u32 = 2u;
const QUAD_AND_DISKS: u32 = 3u;
const FIN: u32 = 4u;

// Parameterizations (section 4).
const OBJECT_SPACE: u32 = 0u;
const SCREEN_SPACE: u32 = 1u;

struct ClipEdge {
    c0: vec4f,
    c1: vec4f,
    // Third vertices of face A and face B; c3 = c0 if there is no face B.
    c2: vec4f,
    c3: vec4f,
    n0: vec4f,
    n1: vec4f,
    // Absolute cosines between the line of sight and the normals of faces A and B.
    facing: vec2f,
    // Distances of start and end from the eye, along the line of sight.
    distance: vec2f,
    r: f32,
}

struct StrokeShape {
    viewport_px: vec2f,
    // The object's origin on the screen, from the middle of the tile, y up.
    origin_px: vec2f,
    // Distances from the eye at which strokes begin and finish fading; equal for no fading.
    fade: vec2f,
    width: f32,
    // Pixels per world unit at w = 1.
    px_per_unit: f32,
    // Length of the brush divided by its height.
    brush_aspect: f32,
    // -1 if the object is mirrored, else 1.
    mirror: f32,
    kind: u32,
    placement: u32,
    parameterization: u32,
    // Whether the width is in world units instead of pixels.
    is_world_width: bool,
    // Where edges are clipped: left, right, bottom, top, at w = 1.
    guard_band: vec4f,
}

struct Segment {
    spine: Spine,
    is_drawn: bool,
    // Unit directions of the vertex normals on the screen.
    m0: vec2f,
    m1: vec2f,
    // +1 if the outside of a contour is on the side of p, -1 if on the other; 0 for other
    // lines.
    outside: f32,
    // Offsets of the near side and of the far side along p, at start and end.
    near_px: vec2f,
    far_px: vec2f,
    // Rise of the two sides above the spine toward the eye, in depth.
    near_rise: f32,
    far_rise: f32,
    // The side of the caps at start and end: +1 or -1.
    cap_side: vec2f,
    // u along the spine and the near side, and along the far one.
    u: vec2f,
    u_far: vec2f,
    v_near: f32,
    v_far: f32,
    v_spine: f32,
    opacity: vec2f,
}

fn stroke_segment(edge: ClipEdge, shape: StrokeShape, bits: u32) -> Segment {
    var segment = Segment();
    let spine = project_spine(edge.c0, edge.c1, shape.viewport_px, shape.guard_band);
    segment.spine = spine;
    segment.is_drawn = any(spine.p != vec2f(0.0));
    if !segment.is_drawn {
        return segment;
    }
    let a = lerp(edge.c0, edge.c1, spine.t0);
    let b = lerp(edge.c0, edge.c1, spine.t1);
    segment.m0 = screen_normal(a, edge.n0, shape.viewport_px);
    segment.m1 = screen_normal(b, edge.n1, shape.viewport_px);
    let side = outside_of(segment, shape, bits);
    segment.outside = select(0.0, side, (bits & CONTOUR) != 0u);
    let placement = placement_of(shape, bits);
    let width_px = vec2f(width_at(a, shape), width_at(b, shape));
    let start_px = quad_offsets(placement, side, width_px.x);
    let end_px = quad_offsets(placement, side, width_px.y);
    segment.near_px = vec2f(start_px.x, end_px.x);
    segment.far_px = vec2f(start_px.y, end_px.y);
    segment.opacity = vec2f(
        opacity_at(edge.distance.x * (1.0 - spine.t0) + edge.distance.y * spine.t0, shape),
        opacity_at(edge.distance.x * (1.0 - spine.t1) + edge.distance.y * spine.t1, shape),
    );
    segment.u = stroke_u(spine, shape, side, 0.5 * (width_px.x + width_px.y), edge.r);
    segment.u_far = segment.u;
    if placement == CENTERED {
        segment.v_far = 0.5 - 0.5 * side;
        segment.v_near = 1.0 - segment.v_far;
        segment.v_spine = 0.5;
        segment.cap_side = vec2f(
            stroke_sign(dot(segment.m0, spine.p)),
            stroke_sign(dot(segment.m1, spine.p)),
        );
        segment.near_rise = quad_rise(edge, spine, shape.viewport_px, segment.near_px);
    } else {
        segment.v_far = select(0.0, 1.0, placement == INSIDE);
        segment.v_near = 1.0 - segment.v_far;
        segment.v_spine = segment.v_near;
        segment.cap_side = vec2f(stroke_sign(end_px.y));
        if shape.kind == QUAD_AND_CAPS {
            segment.u_far = stretched_u(segment);
        }
    }
    // No face lies outside a contour.
    if placement != OUTSIDE || (bits & CONTOUR) == 0u {
        segment.far_rise = quad_rise(edge, spine, shape.viewport_px, segment.far_px);
    }
    return segment;
}

// +1 if the outside is on the side of p, else -1.
fn outside_of(segment: Segment, shape: StrokeShape, bits: u32) -> f32 {
    if (bits & CONTOUR) != 0u {
        // p is on the left of the edge, and so is face A if it faces the eye.
        return select(1.0, -1.0, (bits & A_FACES) != 0u) * shape.mirror;
    }
    return stroke_sign(dot(segment.m0, segment.spine.p));
}

fn placement_of(shape: StrokeShape, bits: u32) -> u32 {
    if shape.placement != AUTOMATIC {
        return shape.placement;
    }
    return select(CENTERED, OUTSIDE, (bits & CONTOUR) != 0u);
}

fn width_at(clip: vec4f, shape: StrokeShape) -> f32 {
    if !shape.is_world_width {
        return shape.width;
    }
    return min(shape.width * shape.px_per_unit / clip.w, shape.viewport_px.y);
}

fn opacity_at(distance: f32, shape: StrokeShape) -> f32 {
    if shape.fade.x >= shape.fade.y {
        return 1.0;
    }
    return clamp((shape.fade.y - distance) / (shape.fade.y - shape.fade.x), 0.0, 1.0);
}

// u at start and end (section 4). r is the edge's random scalar.
fn stroke_u(spine: Spine, shape: StrokeShape, side: f32, width_px: f32, r: f32) -> vec2f {
    let along = spine.s1 - spine.s0;
    // The paper's w, in repetitions of the brush per pixel.
    let w = side / (width_px * shape.brush_aspect);
    if shape.parameterization == OBJECT_SPACE {
        return vec2f(r, r + w * length(along));
    }
    if abs(along.y) > abs(along.x) {
        return w * (vec2f(spine.s0.y, spine.s1.y) - shape.origin_px.y);
    }
    return w * (vec2f(spine.s0.x, spine.s1.x) - shape.origin_px.x);
}

// u at the far corners of a half quad, whose brush is also stretched over its caps
// (Figure 9).
fn stretched_u(segment: Segment) -> vec2f {
    let spine = segment.spine;
    let a = select(cap_length(spine.p, segment.m0, segment.far_px.x, -1.0), 0.0, spine.t0 > 0.0);
    let b = length(spine.s1 - spine.s0);
    let c = select(cap_length(spine.p, segment.m1, segment.far_px.y, 1.0), 0.0, spine.t1 < 1.0);
    let run = segment.u.y - segment.u.x;
    return segment.u.x + run * vec2f(a, a + b) / (a + b + c);
}

// Pixels from the rim of the quad to the tip of its cap; 0 without a cap.
fn cap_length(p: vec2f, m: vec2f, far_px: f32, forward: f32) -> f32 {
    let side = stroke_sign(far_px);
    if !cap_fills_gap(p, m, side, forward) {
        return 0.0;
    }
    let tip = stroke_cap(vec2f(0.0), p, m, side, abs(far_px), 2u);
    return length(tip - p * far_px);
}

// The rise in depth of the side of a stroke that lies `side_px` along p at start and end: as
// much as the adjacent faces rise under it.
fn quad_rise(edge: ClipEdge, spine: Spine, viewport_px: vec2f, side_px: vec2f) -> f32 {
    let side = stroke_sign(side_px.x + side_px.y);
    let reach_px = max(abs(side_px.x), abs(side_px.y));
    let middle = lerp(edge.c0, edge.c1, (spine.t0 + spine.t1) * 0.5);
    let a = in_front(middle, edge.c2);
    let b = in_front(middle, edge.c3);
    return max(
        rise_toward_eye(spine, a, edge.facing.x, viewport_px, side, reach_px),
        rise_toward_eye(spine, b, edge.facing.y, viewport_px, side, reach_px),
    );
}

// A point of the face in front of the near plane: its third vertex, if that is in front.
fn in_front(middle: vec4f, apex: vec4f) -> vec4f {
    let middle_distance = middle.w - middle.z;
    let apex_distance = apex.w - apex.z;
    if apex_distance > 0.0 {
        return apex;
    }
    return lerp(middle, apex, 0.5 * middle_distance / (middle_distance - apex_distance));
}

// The rise in depth of the face with the point `apex`, reach_px away from the edge.
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

// The part of a face's rise that counts; none for a narrow face seen edge-on.
fn lift_share(facing: f32, reaches_wide: f32) -> f32 {
    let seen = (facing - EDGE_ON_FACING) / (LIFTED_FACING - EDGE_ON_FACING);
    let wide = 0.5 * reaches_wide - 1.0;
    return clamp(max(seen, wide), 0.0, 1.0);
}
