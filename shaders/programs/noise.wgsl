// Random textures: four numbers from 0 to 1 per texel, the same for the same seed.
#import <common/screen.wgsl>

struct Params {
    seed: i32,
}

@group(1) @binding(0) var<uniform> params: Params;

fn hashed(value: u32) -> u32 {
    let state = value * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

@fragment
fn random(at: ScreenVarying) -> @location(0) vec4f {
    let texel = vec2u(at.position.xy);
    var state = hashed(texel.x + hashed(texel.y + hashed(bitcast<u32>(params.seed))));
    var color = vec4f(0.0);
    for (var channel = 0; channel < 4; channel++) {
        color[channel] = f32(state >> 8u) / 16777215.0;
        state = hashed(state);
    }
    return color;
}
