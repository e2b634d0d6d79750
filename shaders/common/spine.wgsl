// The spine: an edge clipped in clip space and projected to pixels from the middle of the
// tile, y up. Rust twin: crates/edgemesh/src/oracle/spine.rs, for whole pictures only.
//
//            p      left of the edge
//            ^
//   s0 ------+-----> s1

const MIN_LENGTH_PX: f32 = 1e-4;

// The ends in pixels and their depths, the unit vector to the left, and the parameters of
// the ends along the edge. p is zero if nothing is left to draw.
struct Spine {
    s0: vec2f,
    s1: vec2f,
    z0: f32,
    z1: f32,
    p: vec2f,
    t0: f32,
    t1: f32,
}

// The part of a segment inside the near plane and the guard band (left, right, bottom,
// top, at w = 1), as parameters t0 and t1; t0 > t1 if nothing is inside.
fn clip_segment(c0: vec4f, c1: vec4f, band: vec4f) -> vec2f {
    var range = vec2f(0.0, 1.0);
    range = clip_by_plane(range, c0.w - c0.z, c1.w - c1.z);
    range = clip_by_plane(range, band.y * c0.w - c0.x, band.y * c1.w - c1.x);
    range = clip_by_plane(range, c0.x - band.x * c0.w, c1.x - band.x * c1.w);
    range = clip_by_plane(range, band.w * c0.w - c0.y, band.w * c1.w - c1.y);
    return clip_by_plane(range, c0.y - band.z * c0.w, c1.y - band.z * c1.w);
}

fn clip_by_plane(range: vec2f, d0: f32, d1: f32) -> vec2f {
    if d0 < 0.0 && d1 < 0.0 {
        return vec2f(1.0, 0.0);
    }
    let crossing = d0 / (d0 - d1);
    if d0 < 0.0 {
        return vec2f(max(range.x, crossing), range.y);
    }
    if d1 < 0.0 {
        return vec2f(range.x, min(range.y, crossing));
    }
    return range;
}

fn project_spine(c0: vec4f, c1: vec4f, viewport_px: vec2f, band: vec4f) -> Spine {
    let range = clip_segment(c0, c1, band);
    var spine = Spine();
    spine.t0 = range.x;
    spine.t1 = range.y;
    if range.x >= range.y {
        return spine;
    }
    let a = lerp(c0, c1, range.x);
    let b = lerp(c0, c1, range.y);
    spine.s0 = to_pixels(a, viewport_px);
    spine.s1 = to_pixels(b, viewport_px);
    spine.z0 = a.z / a.w;
    spine.z1 = b.z / b.w;
    let along = spine.s1 - spine.s0;
    let length_px = length(along);
    if length_px >= MIN_LENGTH_PX {
        spine.p = vec2f(-along.y, along.x) / length_px;
    }
    return spine;
}

// Exact at both ends; mix() need not be.
fn lerp(c0: vec4f, c1: vec4f, t: f32) -> vec4f {
    return c0 * (1.0 - t) + c1 * t;
}

fn to_pixels(clip: vec4f, viewport_px: vec2f) -> vec2f {
    return clip.xy / clip.w * (viewport_px * 0.5);
}

// The unit direction of a normal on the screen, or zero.
fn screen_normal(clip: vec4f, normal_clip: vec4f, viewport_px: vec2f) -> vec2f {
    let moved = normal_clip.xy * clip.w - clip.xy * normal_clip.w;
    let scaled = moved * viewport_px;
    // Divided by the larger component first: the square of a tiny vector is zero.
    let largest = max(abs(scaled.x), abs(scaled.y));
    if largest <= 0.0 {
        return vec2f(0.0);
    }
    let even = scaled / largest;
    return even / length(even);
}
