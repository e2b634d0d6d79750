// The object that was filled, in a picture of four samples per pixel: the first sample's.

@group(0) @binding(4) var fill_object: texture_multisampled_2d<u32>;

fn filled_object(pixel: vec2i) -> u32 {
    return textureLoad(fill_object, pixel, 0).x;
}
