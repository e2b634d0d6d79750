// The wobble and jitter of linked strokes, as from an unsteady hand.
//
// The noise belongs to the object: a place on it always pushes lines the same way, so they
// do not swim when the view moves. Its wavelength is that on the screen, within an octave;
// two octaves are blended, so that nothing jumps when the object comes nearer. The same
// seed gives the same lines.
#import <common/path.wgsl>
#import <common/noise.wgsl>

// The offset of a point from its path, in pixels to the left.
fn wobble_at(place: vec2f, depth: f32, set_index: u32) -> f32 {
    let style = link_styles[set_index];
    if style.wobble_px == 0.0 && style.jitter_px == 0.0 {
        return 0.0;
    }
    let clip = vec4f(place / (0.5 * frame.viewport_px), depth, 1.0);
    let moved = object.object_from_clip * clip;
    let position = moved.xyz / moved.w;
    // Pixels per object unit there.
    let m = object.clip_from_object;
    let clip_w = 1.0 / moved.w;
    // Up in the whole picture: the shift of a tile is proportional to w.
    let up_px = 0.5 * frame.viewport_px.y * vec3f(m[0].y, m[1].y, m[2].y)
        + middle_px().y * vec3f(m[0].w, m[1].w, m[2].w);
    let px_per_unit = length(up_px) / max(clip_w, 1e-6);
    let seed = u32(style.seed);
    return style.wobble_px * noise_of(position, style.wobble_length_px / px_per_unit, seed)
        + style.jitter_px * noise_of(position, JITTER_LENGTH_PX / px_per_unit, seed + 1u);
}

// The wavelength of the jitter: about two steps of a path.
const JITTER_LENGTH_PX: f32 = 10.0;
