// Smooths the rims of aliased lines, like morphological antialiasing (Reshetov 2009):
// follows each step of a rim to both ends of its run, and gives a texel as much of its
// neighbor as a straight rim through the middles of the steps would cover.
#import <common/screen.wgsl>
#import <common/taps.wgsl>

struct Params {
    // Smaller steps of brightness are not smoothed.
    threshold: f32,
    // The longest distance that a run is followed, in texels.
    reach: i32,
}

@group(1) @binding(0) var<uniform> params: Params;
@group(1) @binding(1) var texture: texture_2d<f32>;

fn texel_of(texel: vec2i) -> vec4f {
    return textureLoad(texture, within(texel, textureDimensions(texture)), 0);
}

fn brightness(texel: vec2i) -> f32 {
    let color = texel_of(texel);
    return dot(color.rgb, vec3f(0.3, 0.6, 0.1)) + 1.0 - color.a;
}

// The number of texels that a rim continues in the direction `along`, and whether its end
// turns toward the texel's own side (1), to the other side (-1), or is out of reach (0).
fn run(texel: vec2i, along: vec2i, across: vec2i, own: f32, other: f32) -> vec2f {
    let middle = 0.5 * (own + other);
    let is_own_brighter = own > other;
    for (var step = 1; step <= params.reach; step++) {
        let near = brightness(texel + step * along) > middle;
        let far = brightness(texel + step * along + across) > middle;
        if near != is_own_brighter {
            return vec2f(f32(step), -1.0);
        }
        if far == is_own_brighter {
            return vec2f(f32(step), 1.0);
        }
    }
    return vec2f(f32(params.reach), 0.0);
}

// The share of the neighbor across one of a texel's four rims.
fn share(texel: vec2i, across: vec2i, own: f32) -> f32 {
    let other = brightness(texel + across);
    if abs(own - other) < params.threshold {
        return 0.0;
    }
    let along = vec2i(across.y, across.x);
    let back = run(texel, -along, across, own, other);
    let forth = run(texel, along, across, own, other);
    let length = back.x + forth.x - 1.0;
    let place = back.x - 0.5;
    // The rim falls from half a texel inside to half a texel outside along the run.
    let start = -0.5 * back.y;
    let end = -0.5 * forth.y;
    let height = mix(start, end, place / length);
    return clamp(height, 0.0, 0.5);
}

@fragment
fn antialias(at: ScreenVarying) -> @location(0) vec4f {
    let texel = texel_at(at.texcoord, textureDimensions(texture));
    let own = brightness(texel);
    var color = texel_of(texel);
    let center = color;
    for (var tap = 0; tap < 4; tap++) {
        let taken = share(texel, CROSS[tap], own);
        color += taken * (texel_of(texel + CROSS[tap]) - center);
    }
    return color;
}
