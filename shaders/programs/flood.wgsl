// Wide lines at constant cost, by jump flooding (Rong and Tan 2006): every texel finds the
// nearest line texel, looking half as far in every round; wide_lines.wgsl inks it by its
// distance from there.
//
//   seeds --round 0: 32 texels away--> --16--> --8--> ... --1--> nearest --> lines
#import <common/screen.wgsl>
#import <common/taps.wgsl>

struct Params {
    iteration: i32,
    iteration_count: i32,
}

@group(1) @binding(0) var<uniform> params: Params;
@group(1) @binding(1) var texture: texture_2d<f32>;

// The coordinates that stand for no texel.
const NOWHERE: f32 = -1.0;

// Dark texels are seeds: their own coordinates.
@fragment
fn seed(at: ScreenVarying) -> @location(0) vec4f {
    let texel = texel_at(at.texcoord, textureDimensions(texture));
    let color = textureLoad(texture, texel, 0);
    let brightness = dot(color.rgb, vec3f(0.3, 0.6, 0.1)) + 1.0 - color.a;
    return vec4f(select(vec2f(NOWHERE), vec2f(texel), brightness < 0.5), 0.0, 1.0);
}

@fragment
fn nearest(at: ScreenVarying) -> @location(0) vec4f {
    let size = textureDimensions(texture);
    let texel = texel_at(at.texcoord, size);
    let step = 1 << u32(max(params.iteration_count - 1 - params.iteration, 0));
    var found = vec2f(NOWHERE);
    var least = 1.0e18;
    for (var dy = -1; dy <= 1; dy++) {
        for (var dx = -1; dx <= 1; dx++) {
            let other = texel + step * vec2i(dx, dy);
            if any(other < vec2i(0)) || any(other >= vec2i(size)) {
                continue;
            }
            let seed = textureLoad(texture, other, 0).xy;
            let away = seed - vec2f(texel);
            if seed.x > NOWHERE && dot(away, away) < least {
                found = seed;
                least = dot(away, away);
            }
        }
    }
    return vec4f(found, 0.0, 1.0);
}
