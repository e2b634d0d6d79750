// Lays the sum of all layers of transparent surfaces over the picture.

@group(0) @binding(1) var layers: texture_2d<f32>;
@group(0) @binding(2) var layers_of_samples: texture_multisampled_2d<f32>;

@fragment
fn layers_of_pixels(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return textureLoad(layers, vec2i(position.xy), 0);
}

@fragment
fn layers_of_each_sample(
    @builtin(position) position: vec4f,
    @builtin(sample_index) sample: u32,
) -> @location(0) vec4f {
    return textureLoad(layers_of_samples, vec2i(position.xy), i32(sample));
}
