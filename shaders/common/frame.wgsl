// What one view needs, the same for every pass, and what it makes of one object.
// Rust twins: FrameUniform and ObjectUniform in crates/strokes/src/view/frame.rs.

struct FrameUniform {
    // Size of what is drawn: the picture, or a part of it.
    viewport_px: vec2f,
    // Pixels a unit of the world has at w = 1.
    px_per_unit: f32,
    clip_plane_count: u32,
    // At a distance d along the line of sight, clip z is x d + y and w is z d + w.
    projection: vec4f,
    // Size of the whole picture.
    picture_px: vec2f,
    // The upper left corner of what is drawn, from that of the picture.
    corner_px: vec2f,
    // Where edges are clipped at the sides: left, right, bottom, top, at w = 1.
    guard_band: vec4f,
    // Takes points of clip space back to the world.
    world_from_clip: mat4x4f,
    // The eye with w = 1, or the direction to the viewer with w = 0.
    eye: vec4f,
    // The distance from the eye along the line of sight is dot(point in world, this).
    sight: vec4f,
    // Right and up in the picture, of unit length.
    right: vec4f,
    up: vec4f,
    // A light at a point with w = 1, or in a direction of unit length with w = 0.
    light: vec4f,
    light_color: vec3f,
    // Half the diagonal of the box around the scene.
    scene_radius: f32,
    // Points of the world are drawn where dot(point, plane) is negative for none.
    clip_planes: array<vec4f, MAX_CLIP_PLANES>,
}

const MAX_CLIP_PLANES: u32 = 6u;

struct ObjectUniform {
    // Takes the object's positions to clip space; depth 1 near, 0 far.
    clip_from_object: mat4x4f,
    // Takes it back.
    object_from_clip: mat4x4f,
    // Takes its normals to clip space, as directions of a unit of the world.
    clip_from_normal: mat4x4f,
    // The eye in the object's space with w = 1, or the direction to the viewer
    // with w = 0.
    eye: vec4f,
    // The distance from the eye along the line of sight is dot(position, this).
    distance: vec4f,
    // The object's origin on the screen, from the middle of what is drawn.
    origin_px: vec2f,
    // -1 where the object is seen as in a mirror, else 1.
    mirror: f32,
    // 1 where the eye is outside of the object's box, else 0.
    eye_is_outside: u32,
    // Replicated at 16 bits: the position of step 0, and units a step.
    center: vec3f,
    step: f32,
    world_from_object: mat4x4f,
    // Takes normals to the world, as directions of a unit of the world.
    world_from_normal: mat4x4f,
}

@group(0) @binding(0) var<uniform> frame: FrameUniform;
@group(2) @binding(0) var<uniform> object: ObjectUniform;

// The distance from the eye along the line of sight.
fn distance_of(depth: f32) -> f32 {
    let clip = frame.projection;
    return (clip.y - depth * clip.w) / (depth * clip.z - clip.x);
}

// Pixels that a unit of the world has at a distance.
fn px_per_unit_at(distance: f32) -> f32 {
    return frame.px_per_unit / dot(frame.projection.zw, vec2f(distance, 1.0));
}

// Whether there can be clip planes: shaders that discard nothing test depths early.
override CLIPS: bool = true;

// Whether a clip plane cuts a point of the world away.
fn is_cut_away(point_in_world: vec3f) -> bool {
    if !CLIPS {
        return false;
    }
    // Those that are not there are zero and cut nothing. A bound from the uniform makes
    // some drivers compile the shader anew in every frame (Mesa's llvmpipe).
    for (var plane = 0u; plane < MAX_CLIP_PLANES; plane++) {
        if dot(frame.clip_planes[plane], vec4f(point_in_world, 1.0)) < 0.0 {
            return true;
        }
    }
    return false;
}

// The middle of what is drawn, in pixels from the middle of the picture, y up; twin:
// Tile::middle_px in crates/strokes/src/view/tile.rs.
fn middle_px() -> vec2f {
    let from_corner = frame.corner_px + 0.5 * (frame.viewport_px - frame.picture_px);
    return vec2f(from_corner.x, -from_corner.y);
}

// The point of the world at a place of what is drawn, in pixels, and a depth.
fn world_of(place_px: vec2f, depth: f32) -> vec3f {
    let across = place_px / frame.viewport_px;
    let clip = vec4f(2.0 * across.x - 1.0, 1.0 - 2.0 * across.y, depth, 1.0);
    let world = frame.world_from_clip * clip;
    return world.xyz / world.w;
}
