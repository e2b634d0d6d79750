// The depth of the fill in a picture of four samples per pixel, reversed: 1 near, 0 far or
// empty.

@group(0) @binding(2) var fill_depth: texture_depth_multisampled_2d;

fn filled_depths(pixel: vec2i) -> vec4f {
    return vec4f(
        textureLoad(fill_depth, pixel, 0),
        textureLoad(fill_depth, pixel, 1),
        textureLoad(fill_depth, pixel, 2),
        textureLoad(fill_depth, pixel, 3),
    );
}

fn filled_size() -> vec2u {
    return vec2u(textureDimensions(fill_depth));
}
