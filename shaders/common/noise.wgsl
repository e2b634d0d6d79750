// Smooth noise in space, of any wavelength.
#import <common/mesh.wgsl>

// From -1 to 1. The values lie on lattices whose cells are powers of two, and two lattices
// are blended, so a small change of the wavelength changes the noise only a little.
fn noise_of(position: vec3f, wavelength: f32, seed: u32) -> f32 {
    let level = log2(max(wavelength, 1e-20));
    let octave = floor(level);
    // Half a wavelength from one value to the next.
    let cell = 0.5 * exp2(octave);
    let near = value_noise(position / cell, seed);
    let far = value_noise(position / (2.0 * cell), seed);
    return mix(near, far, smoothstep(0.0, 1.0, level - octave));
}

// Smooth noise from -1 to 1 with one value per cell.
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
