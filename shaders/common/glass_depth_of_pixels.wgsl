// The depth of the nearest transparent surface in a picture of one sample per pixel, reversed:
// 1 near, 0 far or none.

@group(0) @binding(5) var glass_depth: texture_depth_2d;

fn glass_depths(pixel: vec2i) -> vec4f {
    return vec4f(textureLoad(glass_depth, pixel, 0));
}

fn glass_depth_at(pixel: vec2i, sample: u32) -> f32 {
    return textureLoad(glass_depth, pixel, 0);
}
