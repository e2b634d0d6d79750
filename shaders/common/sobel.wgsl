// The Sobel operator (NPRView thesis, Figure 3.2; Chiang et al., section III.C).
#import <common/taps.wgsl>

// The gradient of each channel, x to the right and y down.
struct Gradient {
    x: vec4f,
    y: vec4f,
}

fn sobel(image: texture_2d<f32>, texel: vec2i) -> Gradient {
    let size = textureDimensions(image);
    var gradient = Gradient(vec4f(0.0), vec4f(0.0));
    for (var dy = -1; dy <= 1; dy++) {
        for (var dx = -1; dx <= 1; dx++) {
            let value = textureLoad(image, within(texel + vec2i(dx, dy), size), 0);
            gradient.x += f32(dx * (2 - abs(dy))) * value;
            gradient.y += f32(dy * (2 - abs(dx))) * value;
        }
    }
    return gradient;
}
