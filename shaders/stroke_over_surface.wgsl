// The fragments of contours that lie inside of their edge, or centerd on it: over
// the surface that they bound.
//
// That surface turns toward the eye faster than any one face tells, and would
// swallow them if each fragment were tested where it is. So these ask whether the
// edge is visible: a little outside of it, where nothing of its own surface lies.
// Silhouettes ask there as well whether it is their own object. What lies off the
// surface asks where it is, as the depth test would.
//
//   on the screen:                      from the side, the eye on the right:
//
//     outside    x foot                           x foot
//     ===========o=========== edge                o edge
//                x start                          | '.
//     inside     x a fragment         the stroke  |   '.  the surface
#import <common/stroke_ink.wgsl>
#import <common/silhouette.wgsl>

// Whether what is hidden is drawn, and what is visible is not.
override IS_HIDDEN: bool = false;

// The fill's depth and its objects, in pictures of one sample a pixel and of four.
@group(0) @binding(1) var fill_depth: texture_depth_2d;
@group(0) @binding(2) var fill_depth_of_samples: texture_depth_multisampled_2d;
@group(0) @binding(3) var fill_object: texture_2d<u32>;
@group(0) @binding(4) var fill_object_of_samples: texture_multisampled_2d<u32>;

@fragment
fn over_surface_of_pixels(in: StrokeVarying) -> @location(0) vec4f {
    // Before anything is discarded: these take derivatives.
    let color = cut(in.position, ink(in.uv, in.opacity));
    let at = places_of(in);
    if !is_drawn(in, depths_of_pixels(at)) {
        discard;
    }
    return color;
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
    return color;
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
    return color;
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
    return color;
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

// The pixels where a fragment asks what was filled: its own, the one where its
// stroke starts over the surface, the one beside the edge.
struct Places {
    here: vec2i,
    start: vec2i,
    foot: vec2i,
}

// Far enough over the surface for every sample of the pixel to be on it.
const START_PX: f32 = 1.5;

// How much nearer than the edge its own surface may be, or farther, in heights of
// the picture.
const OWN_REACH: f32 = 0.5;

fn places_of(in: StrokeVarying) -> Places {
    // A pixel further in is a pixel further over the surface.
    let inward = vec2f(dpdx(in.over_px), dpdy(in.over_px));
    let foot = foot_of(in);
    let start = foot + inward * (FOOT_PX + START_PX);
    return Places(pixel_of(in.position.xy), pixel_of(start), pixel_of(foot));
}

// Whether the edge is between its own object and anything else (section 3.4).
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

// `depths` are those of the fill at the three places; reversed: 1 near, 0 far and
// where nothing was filled.
fn is_drawn(in: StrokeVarying, depths: vec3f) -> bool {
    if in.over_px <= 0.0 {
        return (in.position.z < depths.x) == IS_HIDDEN;
    }
    let edge = in.foot.z;
    // Beyond the picture nothing is known to hide it.
    let is_hidden = edge < depths.z && is_in_picture(foot_of(in));
    if is_hidden != IS_HIDDEN {
        return false;
    }
    if IS_HIDDEN {
        return edge < depths.x;
    }
    return is_own_surface(edge, depths.x) && is_own_surface(edge, depths.y);
}

// Whether what was filled there can be the surface that the edge bounds, by how
// far before or behind the edge it lies. Where edges are small, a stroke reaches
// past that surface, over what is elsewhere; and something else can lie before it.
fn is_own_surface(edge: f32, filled: f32) -> bool {
    if filled <= 0.0 {
        return false;
    }
    let edge_distance = distance_of(edge);
    // A wall seen nearly edge on comes nearer by its whole length within a pixel;
    // and as far its fill is pushed back, by a pixel of slope.
    let away_px = abs(edge_distance - distance_of(filled)) * px_per_unit_at(edge_distance);
    return away_px <= OWN_REACH * frame.picture_px.y;
}
