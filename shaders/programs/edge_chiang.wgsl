// Chiang, Hsueh and Liu: the Sobel operator on the normal map and on the depth map, with an
// extra filter that keeps only edges whose depth differs from that of their neighbors
// (section III.C.1).
#import <common/edges.wgsl>
#import <common/screen.wgsl>
#import <common/sobel.wgsl>

struct Params {
    normal_threshold: f32,
    depth_threshold: f32,
    extra_threshold: f32,
    extra_filter: u32,
    // 0 sums the absolute derivatives; 1 sums them with their signs, as printed, which
    // misses edges from bright to dark.
    gradient: u32,
    edge_color: vec4f,
    background_color: vec4f,
}

@group(1) @binding(0) var<uniform> params: Params;
@group(1) @binding(1) var normal_texture: texture_2d<f32>;
@group(1) @binding(2) var depth_texture: texture_depth_2d;

// The depth map: 0 at the near end of the scene's bounding sphere, 1 at its far end.
fn map_depth(texel: vec2i) -> f32 {
    let range = frame.depth_range;
    return (distance_at(depth_texture, texel) - range.x) / (range.y - range.x);
}

fn sum_of(x: f32, y: f32) -> f32 {
    return select(x + y, abs(x) + abs(y), params.gradient == 0u);
}

@fragment
fn chiang(at: ScreenVarying) -> @location(0) vec4f {
    let texel = texel_at(at.texcoord, textureDimensions(normal_texture));
    let normals = sobel(normal_texture, texel);
    var of_normals = -1.0e9;
    for (var channel = 0; channel < 3; channel++) {
        of_normals = max(of_normals, sum_of(normals.x[channel], normals.y[channel]));
    }
    let center = map_depth(texel);
    var along = vec2f(0.0);
    var around = 0.0;
    for (var dy = -1; dy <= 1; dy++) {
        for (var dx = -1; dx <= 1; dx++) {
            let depth = map_depth(texel + vec2i(dx, dy));
            along += vec2f(f32(dx * (2 - abs(dy))), f32(dy * (2 - abs(dx)))) * depth;
            // The paper's I_z: the four nearest neighbors count twice.
            around += f32(3 - abs(dx) - abs(dy)) * abs(depth - center);
        }
    }
    var is_edge = of_normals >= params.normal_threshold
        || sum_of(along.x, along.y) >= params.depth_threshold;
    if params.extra_filter == 1u {
        is_edge &= around >= params.extra_threshold;
    }
    return line_color(f32(is_edge), params.edge_color, params.background_color);
}
