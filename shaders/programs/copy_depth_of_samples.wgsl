// Copies the depth of a picture of several samples per pixel: the first sample's.

@group(1) @binding(0) var depth: texture_depth_multisampled_2d;

@fragment
fn copy_depth(@builtin(position) position: vec4f) -> @builtin(frag_depth) f32 {
    return textureLoad(depth, vec2i(position.xy), 0);
}
