// The Laplacian of the Gaussian of the intensity (NPRView thesis, section 3.2, Equation 3.6);
// zero_crossings.wgsl finds its edges.
#import <common/edges.wgsl>
#import <common/screen.wgsl>

struct Params {
    // Standard deviation of the Gaussian in texels.
    sigma: f32,
}

@group(1) @binding(0) var<uniform> params: Params;
@group(1) @binding(1) var texture: texture_2d<f32>;

const PI: f32 = 3.14159265;

// Equation 3.6.
fn weight(x: f32, y: f32) -> f32 {
    let sigma_2 = params.sigma * params.sigma;
    let part = (x * x + y * y) / (2.0 * sigma_2);
    return -(1.0 - part) * exp(-part) / (PI * sigma_2 * sigma_2);
}

@fragment
fn laplacian_of_gaussian(at: ScreenVarying) -> @location(0) vec4f {
    let size = textureDimensions(texture);
    let texel = texel_at(at.texcoord, size);
    let reach = i32(ceil(4.0 * params.sigma));
    var sum = 0.0;
    var weights = 0.0;
    var values = 0.0;
    for (var dy = -reach; dy <= reach; dy++) {
        for (var dx = -reach; dx <= reach; dx++) {
            let color = textureLoad(texture, within(texel + vec2i(dx, dy), size), 0).rgb;
            let value = dot(color, vec3f(0.3, 0.6, 0.1));
            let by = weight(f32(dx), f32(dy));
            sum += by * value;
            weights += by;
            values += value;
        }
    }
    // The sampled, truncated weights do not sum to zero, but a constant picture must give 0.
    let count = f32((2 * reach + 1) * (2 * reach + 1));
    return vec4f(sum - weights * values / count, 0.0, 0.0, 1.0);
}
