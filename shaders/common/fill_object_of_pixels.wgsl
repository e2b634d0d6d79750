// The object that was filled, in a picture of one sample per pixel.

@group(0) @binding(3) var fill_object: texture_2d<u32>;

fn filled_object(pixel: vec2i) -> u32 {
    return textureLoad(fill_object, pixel, 0).x;
}
