// Edges as discontinuities of normals (NPRView thesis, section 3.3.1; Card and Mitchell,
// Listing 9).
#import <common/encode.wgsl>
#import <common/screen.wgsl>
#import <common/taps.wgsl>

struct Params {
    threshold: f32,
    apply_threshold: u32,
    edge_color: vec4f,
    background_color: vec4f,
}

@group(1) @binding(0) var<uniform> params: Params;
@group(1) @binding(1) var normal_texture: texture_2d<f32>;

fn normal_at(texel: vec2i) -> vec3f {
    let size = textureDimensions(normal_texture);
    return normal_of_rgb(textureLoad(normal_texture, within(texel, size), 0).rgb);
}

fn line_color(strength: f32) -> vec4f {
    let color = mix(params.background_color, params.edge_color, clamp(strength, 0.0, 1.0));
    return vec4f(color.rgb * color.a, color.a);
}

// Equation 3.7: the least dot product; where it is below the threshold there is an edge.
// Without a threshold, Equation 3.8: how far the dot products are from 4, times it.
@fragment
fn minimum_dot_product(at: ScreenVarying) -> @location(0) vec4f {
    let texel = texel_at(at.texcoord, textureDimensions(normal_texture));
    let center = normal_at(texel);
    var least = 1.0e9;
    var sum = 0.0;
    for (var tap = 0; tap < 4; tap++) {
        let product = dot(center, normal_at(texel + CROSS[tap]));
        least = min(least, product);
        sum += product;
    }
    if params.apply_threshold == 0u {
        return line_color(params.threshold * (4.0 - sum));
    }
    return line_color(f32(least < params.threshold));
}

// Card and Mitchell's five taps: an edge where any product falls below the threshold.
@fragment
fn five_taps(at: ScreenVarying) -> @location(0) vec4f {
    let texel = texel_at(at.texcoord, textureDimensions(normal_texture));
    let center = normal_at(texel);
    var surface = 1.0;
    for (var tap = 0; tap < 4; tap++) {
        let product = dot(center, normal_at(texel + DIAGONALS[tap]));
        // As Listing 9 has it: what is not below the threshold is white.
        surface *= f32(product - params.threshold >= 0.0);
    }
    return line_color(1.0 - surface);
}
