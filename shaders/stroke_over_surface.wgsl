// Fragments of contours placed inside their edge, or centered on it: over the surface
// that they bound.
//
// That surface rises toward the eye faster than the faces at the edge do, and would cover
// the stroke if each fragment were tested at its own place. So these fragments test
// whether the edge is visible, a little outside it, where its own surface does not lie.
// Silhouettes also test there whether the object is their own. Fragments off the surface
// are tested where they are, as the depth test would.
//
//   on the screen:                      from the side, the eye on the right:
//
//     outside    x foot                           x foot
//     ===========o=========== edge                o edge
//                x start                          | '.
//     inside     x a fragment         the stroke  |   '.  the surface
#import <common/stroke_ink.wgsl>
#import <common/silhouette.wgsl>
#import <common/glass_depth.wgsl>

// Whether hidden lines are drawn instead of visible ones.
override IS_HIDDEN: bool = false;

// Whether surfaces of the scene are transparent.
override HAS_GLASS: bool = false;

// Depth and objects of the fill, in pictures of one and of four samples per pixel.
@group(0) @binding(1) var fill_depth: texture_depth_2d;
@group(0) @binding(2) var fill_depth_of_samples: texture_depth_multisampled_2d;
@group(0) @binding(3) var fill_object: texture_2d<u32>;
@group(0) @binding(4) var fill_object_of_samples: texture_multisampled_2d<u32>;

@fragment
fn over_surface_of_pixels(in: StrokeVarying) -> @location(0) vec4f {
    // Before any discard, because these take derivatives.
    let color = cut(in.position, ink(in.uv, in.opacity));
    let at = places_of(in);
    if !is_drawn(in, depths_of_pixels(at)) {
        discard;
    }
    return color * seen_share(in, at, 0u);
}

@fragment
fn over_surface_of_samples(
    in: StrokeVarying,
    @builtin(sample_index) sample: u32,
) -> @location(0) vec4f {
    let color = cut(in.position, ink(in.uv, in.opacity));
    let at = places_of(in);
    if !is_drawn(in, depths_of_samples(at, sample)) {
        discard;
    }
    return color * seen_share(in, at, sample);
}

@fragment
fn silhouette_of_pixels(in: StrokeVarying) -> @location(0) vec4f {
    let color = cut(in.position, ink(in.uv, in.opacity));
    let at = places_of(in);
    let objects = vec3u(
        textureLoad(fill_object, at.here, 0).x,
        textureLoad(fill_object, at.start, 0).x,
        textureLoad(fill_object, at.foot, 0).x,
    );
    if !is_around(in, objects) || !is_drawn(in, depths_of_pixels(at)) {
        discard;
    }
    return color * seen_share(in, at, 0u);
}

@fragment
fn silhouette_of_samples(
    in: StrokeVarying,
    @builtin(sample_index) sample: u32,
) -> @location(0) vec4f {
    let color = cut(in.position, ink(in.uv, in.opacity));
    let at = places_of(in);
    let objects = vec3u(
        textureLoad(fill_object_of_samples, at.here, i32(sample)).x,
        textureLoad(fill_object_of_samples, at.start, i32(sample)).x,
        textureLoad(fill_object_of_samples, at.foot, i32(sample)).x,
    );
    if !is_around(in, objects) || !is_drawn(in, depths_of_samples(at, sample)) {
        discard;
    }
    return color * seen_share(in, at, sample);
}

fn depths_of_pixels(at: Places) -> vec3f {
    return vec3f(
        textureLoad(fill_depth, at.here, 0),
        textureLoad(fill_depth, at.start, 0),
        textureLoad(fill_depth, at.foot, 0),
    );
}

fn depths_of_samples(at: Places, sample: u32) -> vec3f {
    return vec3f(
        textureLoad(fill_depth_of_samples, at.here, i32(sample)),
        textureLoad(fill_depth_of_samples, at.start, i32(sample)),
        textureLoad(fill_depth_of_samples, at.foot, i32(sample)),
    );
}

// The pixels at which a fragment reads the fill: its own, the one where its stroke starts
// over the surface, and the one outside the edge.
struct Places {
    here: vec2i,
    start: vec2i,
    foot: vec2i,
}

// Far enough over the surface that every sample of the pixel is on it.
const START_PX: f32 = 1.5;

// How much nearer or farther than the edge its own surface may be, in heights of the
// picture.
const OWN_REACH: f32 = 0.5;

fn places_of(in: StrokeVarying) -> Places {
    // over_px grows by one per pixel inward, so its gradient is the inward direction.
    let inward = vec2f(dpdx(in.over_px), dpdy(in.over_px));
    let foot = foot_of(in);
    let start = foot + inward * (FOOT_PX + START_PX);
    return Places(pixel_of(in.position.xy), pixel_of(start), pixel_of(foot));
}

// Whether the edge separates its own object from anything else (McGuire and Hughes,
// section 3.4).
fn is_around(in: StrokeVarying, objects: vec3u) -> bool {
    let own = objects.y;
    return own != NO_OBJECT && own != select(objects.x, objects.z, in.over_px > 0.0);
}

fn foot_of(in: StrokeVarying) -> vec2f {
    return vec2f(in.foot.x, -in.foot.y) + frame.viewport_px * 0.5;
}

fn is_in_picture(position_px: vec2f) -> bool {
    return all(position_px >= vec2f(0.0)) && all(position_px < frame.viewport_px);
}

fn pixel_of(position_px: vec2f) -> vec2i {
    return clamp(vec2i(floor(position_px)), vec2i(0), vec2i(frame.viewport_px) - 1);
}

// `depths` are those of the fill at the three places, reversed: 1 near, 0 far or empty.
fn is_drawn(in: StrokeVarying, depths: vec3f) -> bool {
    if in.over_px <= 0.0 {
        return (in.position.z < depths.x) == IS_HIDDEN;
    }
    let edge = in.foot.z;
    // Outside the picture there is no depth that could hide it.
    let is_hidden = edge < depths.z && is_in_picture(foot_of(in));
    if is_hidden != IS_HIDDEN {
        return false;
    }
    if IS_HIDDEN {
        return edge < depths.x;
    }
    return is_own_surface(edge, depths.x) && is_own_surface(edge, depths.y);
}

// The factor of the opacity behind transparent surfaces, which are met where the fill is.
fn seen_share(in: StrokeVarying, at: Places, sample: u32) -> f32 {
    if !HAS_GLASS || IS_HIDDEN {
        return 1.0;
    }
    let is_over = in.over_px > 0.0;
    let glass = glass_depth_at(select(at.here, at.foot, is_over), sample);
    let is_behind = select(in.position.z, in.foot.z, is_over) < glass;
    return select(1.0, stroke.behind_glass, is_behind);
}

// Whether the fill there can be the surface that the edge bounds, judged by its distance
// from the edge in depth. A stroke on small faces can reach past that surface, and
// something else can lie in front of it.
fn is_own_surface(edge: f32, filled: f32) -> bool {
    if filled <= 0.0 {
        return false;
    }
    let edge_distance = distance_of(edge);
    // A wall seen nearly edge-on comes nearer by its whole length within a pixel, and its
    // fill is pushed back just as far, by a pixel of slope.
    let away_px = abs(edge_distance - distance_of(filled)) * px_per_unit_at(edge_distance);
    return away_px <= OWN_REACH * frame.picture_px.y;
}
