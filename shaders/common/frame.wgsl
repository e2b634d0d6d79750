// The uniforms of a view, which are the same for every pass, and of an object in it.
// Rust twins: FrameUniform and ObjectUniform in crates/strokes/src/view/frame.rs.

struct FrameUniform {
    // Size of the drawn tile, or of the whole picture.
    viewport_px: vec2f,
    // Pixels per world unit at w = 1.
    px_per_unit: f32,
    clip_plane_count: u32,
    // At a distance d along the line of sight, clip z is x d + y and w is z d + w.
    projection: vec4f,
    // Size of the whole picture.
    picture_px: vec2f,
    // Upper left corner of the tile, from that of the picture.
    corner_px: vec2f,
    // Where edges are clipped: left, right, bottom, top, in clip space at w = 1.
    guard_band: vec4f,
    world_from_clip: mat4x4f,
    // In world space: the eye with w = 1, or the direction to the viewer with w = 0.
    eye: vec4f,
    // The distance from the eye along the line of sight is dot(point in world, this).
    sight: vec4f,
    // Right and up in the picture, unit vectors in world space.
    right: vec4f,
    up: vec4f,
    // In world space: the light's position with w = 1, or the unit direction to it with
    // w = 0.
    light: vec4f,
    light_color: vec3f,
    // Half the diagonal of the scene's bounding box, in world units.
    scene_radius: f32,
    // The distances along the line of sight between which the scene's bounding sphere lies.
    depth_range: vec2f,
    padding: vec2f,
    // A point in world space is cut away if dot(point, plane) is negative for any.
    clip_planes: array<vec4f, MAX_CLIP_PLANES>,
}

const MAX_CLIP_PLANES: u32 = 6u;

struct ObjectUniform {
    // Depth is 1 near, 0 far.
    clip_from_object: mat4x4f,
    object_from_clip: mat4x4f,
    // For normals: the results have the length of one world unit.
    clip_from_normal: mat4x4f,
    // In object space: the eye with w = 1, or the direction to the viewer with w = 0.
    eye: vec4f,
    // The distance from the eye along the line of sight is dot(position, this).
    distance: vec4f,
    // The object's origin on the screen, from the middle of the tile, y up.
    origin_px: vec2f,
    // -1 if the object is mirrored, else 1.
    mirror: f32,
    // 1 if the eye is outside the object's bounding box, else 0.
    eye_is_outside: u32,
    // Replicated layout at 16 bits: the position of step 0, and units per step.
    center: vec3f,
    step: f32,
    world_from_object: mat4x4f,
    // For normals: the results have the length of one world unit.
    world_from_normal: mat4x4f,
}

@group(0) @binding(0) var<uniform> frame: FrameUniform;
@group(2) @binding(0) var<uniform> object: ObjectUniform;

// The distance from the eye along the line of sight, in world units, at a depth. The background
// lies at the far end of the scene, since perspective has no far plane.
fn distance_of(depth: f32) -> f32 {
    let clip = frame.projection;
    let divisor = depth * clip.z - clip.x;
    if divisor == 0.0 {
        return frame.depth_range.y;
    }
    return (clip.y - depth * clip.w) / divisor;
}

// Pixels per world unit at a distance along the line of sight.
fn px_per_unit_at(distance: f32) -> f32 {
    return frame.px_per_unit / dot(frame.projection.zw, vec2f(distance, 1.0));
}

// False if there are no clip planes: a shader without discard gets early depth tests.
override CLIPS: bool = true;

// Whether a clip plane cuts a point of the world away.
fn is_cut_away(point_in_world: vec3f) -> bool {
    if !CLIPS {
        return false;
    }
    // Unused planes are zero and cut nothing. With a loop bound from the uniform, Mesa's
    // llvmpipe compiles the shader again in every frame.
    for (var plane = 0u; plane < MAX_CLIP_PLANES; plane++) {
        if dot(frame.clip_planes[plane], vec4f(point_in_world, 1.0)) < 0.0 {
            return true;
        }
    }
    return false;
}

// The middle of the tile, in pixels from the middle of the picture, y up. Rust twin:
// Tile::middle_px in crates/strokes/src/view/tile.rs.
fn middle_px() -> vec2f {
    let from_corner = frame.corner_px + 0.5 * (frame.viewport_px - frame.picture_px);
    return vec2f(from_corner.x, -from_corner.y);
}

// The point in world space at a depth and at a place in pixels from the upper left corner
// of the tile.
fn world_of(place_px: vec2f, depth: f32) -> vec3f {
    let across = place_px / frame.viewport_px;
    let clip = vec4f(2.0 * across.x - 1.0, 1.0 - 2.0 * across.y, depth, 1.0);
    let world = frame.world_from_clip * clip;
    return world.xyz / world.w;
}
