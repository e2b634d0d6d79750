// The depth of the nearest transparent surface in a picture of four samples per pixel,
// reversed: 1 near, 0 far or none.

@group(0) @binding(6) var glass_depth: texture_depth_multisampled_2d;

fn glass_depths(pixel: vec2i) -> vec4f {
    return vec4f(
        textureLoad(glass_depth, pixel, 0),
        textureLoad(glass_depth, pixel, 1),
        textureLoad(glass_depth, pixel, 2),
        textureLoad(glass_depth, pixel, 3),
    );
}

fn glass_depth_at(pixel: vec2i, sample: u32) -> f32 {
    return textureLoad(glass_depth, pixel, i32(sample));
}
