// The depth that was filled, in a picture of one sample a pixel; reversed: 1 near, 0
// far and where nothing was filled.

@group(0) @binding(1) var fill_depth: texture_depth_2d;

fn filled_depths(pixel: vec2i) -> vec4f {
    return vec4f(textureLoad(fill_depth, pixel, 0));
}

fn filled_size() -> vec2u {
    return vec2u(textureDimensions(fill_depth));
}
