// Dilation and erosion of dark lines (Card and Mitchell, Thickening Outlines with
// Morphology): the darkest or the brightest texel in the neighborhood.
#import <common/screen.wgsl>
#import <common/taps.wgsl>

struct Params {
    // 0 for eight neighbors, 1 for four.
    shape: u32,
}

@group(1) @binding(0) var<uniform> params: Params;
@group(1) @binding(1) var texture: texture_2d<f32>;

// The brightness of a premultiplied color on white paper.
fn brightness(color: vec4f) -> f32 {
    return dot(color.rgb, vec3f(0.3, 0.6, 0.1)) + 1.0 - color.a;
}

fn extreme(texcoord: vec2f, sign: f32) -> vec4f {
    let size = textureDimensions(texture);
    let texel = texel_at(texcoord, size);
    var found = textureLoad(texture, texel, 0);
    for (var dy = -1; dy <= 1; dy++) {
        for (var dx = -1; dx <= 1; dx++) {
            if params.shape == 1u && dx != 0 && dy != 0 {
                continue;
            }
            let other = textureLoad(texture, within(texel + vec2i(dx, dy), size), 0);
            if sign * brightness(other) > sign * brightness(found) {
                found = other;
            }
        }
    }
    return found;
}

@fragment
fn dilate(at: ScreenVarying) -> @location(0) vec4f {
    return extreme(at.texcoord, -1.0);
}

@fragment
fn erode(at: ScreenVarying) -> @location(0) vec4f {
    return extreme(at.texcoord, 1.0);
}
