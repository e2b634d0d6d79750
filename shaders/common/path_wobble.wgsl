// How an unsteady hand leaves the line.
//
// The noise belongs to the object: a place on it always pushes a line that passes there
// the same way, so lines do not swim when the view moves. Its wavelength is that of the
// screen to within an octave; two octaves are blended, so that nothing jumps when the
// object comes nearer. The same seed gives the same lines.
#import <common/path.wgsl>

// How far a point of a path lies beside it, in pixels to the left.
fn wobble_at(place: vec2f, depth: f32, draw: u32) -> f32 {
    let style = paths[draw];
    if style.wobble_px == 0.0 && style.jitter_px == 0.0 {
        return 0.0;
    }
    let clip = vec4f(place / (0.5 * frame.viewport_px), depth, 1.0);
    let moved = object.object_from_clip * clip;
    let position = moved.xyz / moved.w;
    // Pixels that a unit of the object has there.
    let m = object.clip_from_object;
    let clip_w = 1.0 / moved.w;
    let px_per_unit =
        length(vec3f(m[0].y, m[1].y, m[2].y)) * 0.5 * frame.viewport_px.y / max(clip_w, 1e-6);
    let seed = u32(style.seed);
    return style.wobble_px * noise_of(position, style.wobble_length_px / px_per_unit, seed)
        + style.jitter_px * noise_of(position, JITTER_LENGTH_PX / px_per_unit, seed + 1u);
}

// A hand trembles at this wavelength: two steps of a path.
const JITTER_LENGTH_PX: f32 = 10.0;

fn noise_of(position: vec3f, wavelength: f32, seed: u32) -> f32 {
    let level = log2(max(wavelength, 1e-20));
    let octave = floor(level);
    // Half a wavelength from one value to the next.
    let cell = 0.5 * exp2(octave);
    let near = value_noise(position / cell, seed);
    let far = value_noise(position / (2.0 * cell), seed);
    return mix(near, far, smoothstep(0.0, 1.0, level - octave));
}

// Smooth noise from -1 to 1 with one value a cell.
fn value_noise(position: vec3f, seed: u32) -> f32 {
    let cell = floor(position);
    let t = smoothstep(vec3f(0.0), vec3f(1.0), position - cell);
    let corner = bitcast<vec3u>(vec3i(clamp(cell, vec3f(-1e9), vec3f(1e9))));
    var values = array<f32, 8>();
    for (var k = 0u; k < 8u; k++) {
        values[k] = value_of(corner + vec3u(k & 1u, (k >> 1u) & 1u, k >> 2u), seed);
    }
    let low = mix(
        mix(values[0], values[1], t.x), mix(values[2], values[3], t.x), t.y,
    );
    let high = mix(
        mix(values[4], values[5], t.x), mix(values[6], values[7], t.x), t.y,
    );
    return mix(low, high, t.z);
}

fn value_of(corner: vec3u, seed: u32) -> f32 {
    let bits = pcg(pcg(pcg(corner.x + seed) ^ corner.y) ^ corner.z);
    return f32(bits >> 8u) / 8388608.0 - 1.0;
}
