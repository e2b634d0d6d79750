// Transparent surfaces, layer by layer from the eye on (depth peeling: Everitt 2001, Interactive
// Order-Independent Transparency), so that they show through each other in any order.
//
//     eye   glass 1   glass 2   opaque   glass 3
//      o -----|---------|---------#---------|      layers: glass 1, glass 2
//
// A layer is the nearest of what lies behind the layer before. Its depth is drawn first, and
// its color with the program of the pass where the depth is the same. The colors are added up
// under those of the layers before, and then laid over the picture.
#import <common/frame.wgsl>

// The depths of opaque surfaces and of the layer before, in pictures of one and of four samples
// per pixel; reversed: 1 near, 0 far or empty.
@group(0) @binding(1) var opaque_depth: texture_depth_2d;
@group(0) @binding(2) var opaque_depth_of_samples: texture_depth_multisampled_2d;
@group(0) @binding(3) var layer_before: texture_depth_2d;
@group(0) @binding(4) var layer_before_of_samples: texture_depth_multisampled_2d;

// A surface is not behind itself: what is interpolated for a fragment and what is stored in the
// depth can differ in the last bits.
const SAME_DEPTH: f32 = 4.0e-7;

@fragment
fn layer_of_pixels(@builtin(position) position: vec4f) {
    let pixel = vec2i(position.xy);
    let opaque = textureLoad(opaque_depth, pixel, 0);
    let before = textureLoad(layer_before, pixel, 0);
    if !is_in_layer(position, opaque, before) {
        discard;
    }
}

@fragment
fn layer_of_samples(@builtin(position) position: vec4f, @builtin(sample_index) sample: u32) {
    let pixel = vec2i(position.xy);
    let opaque = textureLoad(opaque_depth_of_samples, pixel, i32(sample));
    let before = textureLoad(layer_before_of_samples, pixel, i32(sample));
    if !is_in_layer(position, opaque, before) {
        discard;
    }
}

fn is_in_layer(position: vec4f, opaque: f32, before: f32) -> bool {
    return position.z >= opaque
        && position.z < before * (1.0 - SAME_DEPTH)
        && !is_cut_away(world_of(position.xy, position.z));
}

// The nearest transparent surface, for strokes behind it.
@fragment
fn nearest(@builtin(position) position: vec4f) {
    if is_cut_away(world_of(position.xy, position.z)) {
        discard;
    }
}
