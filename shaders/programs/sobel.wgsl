// Edges as maxima of the first derivative: the Sobel operator (NPRView thesis, section
// 3.2, Equations 3.1 to 3.3).
#import <common/edges.wgsl>
#import <common/screen.wgsl>
#import <common/sobel.wgsl>

struct Params {
    threshold: f32,
    // 0 for Equation 3.1, 1 for the faster Equation 3.2.
    magnitude: u32,
    // 0 for the intensity of colors, 1 for the channel with the largest gradient.
    channels: u32,
    // 0 for lines, 1 for intensities, 2 for the orientation as a hue.
    show: u32,
    edge_color: vec4f,
    background_color: vec4f,
}

@group(1) @binding(0) var<uniform> params: Params;
@group(1) @binding(1) var texture: texture_2d<f32>;

fn size_of(x: f32, y: f32) -> f32 {
    return select(abs(x) + abs(y), sqrt(x * x + y * y), params.magnitude == 0u);
}

// The gradient: x, y, magnitude, and orientation in radians.
fn gradient_at(texcoord: vec2f) -> vec4f {
    let texel = texel_at(texcoord, textureDimensions(texture));
    let gradient = sobel(texture, texel);
    // The weights of Equation 4.5.
    let weights = vec3f(0.3, 0.6, 0.1);
    var along = vec2f(dot(gradient.x.rgb, weights), dot(gradient.y.rgb, weights));
    if params.channels == 1u {
        along = vec2f(gradient.x.r, gradient.y.r);
        for (var channel = 1; channel < 3; channel++) {
            let other = vec2f(gradient.x[channel], gradient.y[channel]);
            if size_of(other.x, other.y) > size_of(along.x, along.y) {
                along = other;
            }
        }
    }
    return vec4f(along, size_of(along.x, along.y), atan2(along.y, along.x));
}

// The gradient itself, for passes that read it.
@fragment
fn gradient(at: ScreenVarying) -> @location(0) vec4f {
    return gradient_at(at.texcoord);
}

@fragment
fn edges(at: ScreenVarying) -> @location(0) vec4f {
    let gradient = gradient_at(at.texcoord);
    if params.show == 2u {
        // The hue makes one turn with the orientation.
        let turn = gradient.w + vec3f(0.0, 2.0943951, -2.0943951);
        let hue = 0.5 + 0.5 * cos(turn);
        return vec4f(hue * clamp(gradient.z * params.threshold, 0.0, 1.0), 1.0);
    }
    var strength = f32(gradient.z >= params.threshold);
    if params.show == 1u {
        strength = params.threshold * gradient.z;
    }
    return line_color(strength, params.edge_color, params.background_color);
}
