// The depth of the fill in a picture of one sample per pixel, reversed: 1 near, 0 far or
// empty.

@group(0) @binding(1) var fill_depth: texture_depth_2d;

fn filled_depths(pixel: vec2i) -> vec4f {
    return vec4f(textureLoad(fill_depth, pixel, 0));
}

fn filled_size() -> vec2u {
    return vec2u(textureDimensions(fill_depth));
}
