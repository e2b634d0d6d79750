// Edges as discontinuities of the eye-space depth (NPRView thesis, section 3.3.2; Card
// and Mitchell, Listing 10), from the depth buffer made linear (Equation 3.11, for the
// projection in use).
#import <common/frame.wgsl>
#import <common/screen.wgsl>
#import <common/taps.wgsl>

struct Params {
    threshold: f32,
    apply_threshold: u32,
    edge_color: vec4f,
    background_color: vec4f,
}

@group(1) @binding(0) var<uniform> params: Params;
@group(1) @binding(1) var depth_texture: texture_depth_2d;

fn distance_at(texel: vec2i) -> f32 {
    let size = textureDimensions(depth_texture);
    return distance_of(textureLoad(depth_texture, within(texel, size), 0));
}

fn line_color(strength: f32) -> vec4f {
    let color = mix(params.background_color, params.edge_color, clamp(strength, 0.0, 1.0));
    return vec4f(color.rgb * color.a, color.a);
}

// Equation 3.12: the largest difference to a neighbour.
@fragment
fn deltas(at: ScreenVarying) -> @location(0) vec4f {
    let texel = texel_at(at.texcoord, textureDimensions(depth_texture));
    let center = distance_at(texel);
    var most = 0.0;
    for (var tap = 0; tap < 4; tap++) {
        most = max(most, abs(center - distance_at(texel + CROSS[tap])));
    }
    if params.apply_threshold == 0u {
        return line_color(params.threshold * most);
    }
    return line_color(f32(most > params.threshold));
}

// Equation 3.13: the size of the Laplacian; without a threshold, times it.
@fragment
fn laplacian(at: ScreenVarying) -> @location(0) vec4f {
    let texel = texel_at(at.texcoord, textureDimensions(depth_texture));
    var sum = -4.0 * distance_at(texel);
    for (var tap = 0; tap < 4; tap++) {
        sum += distance_at(texel + CROSS[tap]);
    }
    if params.apply_threshold == 0u {
        return line_color(params.threshold * abs(sum));
    }
    return line_color(f32(abs(sum) > params.threshold));
}

// Card and Mitchell's five taps on the depth from 0 at the near to 1 at the far plane:
// the sum of the differences.
@fragment
fn five_taps(at: ScreenVarying) -> @location(0) vec4f {
    let texel = texel_at(at.texcoord, textureDimensions(depth_texture));
    let range = distance_of(0.0) - distance_of(1.0);
    let center = distance_at(texel);
    var sum = 0.0;
    for (var tap = 0; tap < 4; tap++) {
        sum += abs(center - distance_at(texel + DIAGONALS[tap])) / range;
    }
    return line_color(f32(sum - params.threshold >= 0.0));
}
