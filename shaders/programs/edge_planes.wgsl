// Edges where a neighbor leaves the plane through a texel: a depth detector that needs no
// tuning, since a plane has no edges, however steep (compare Figure 3.11 of the NPRView
// thesis). Distances are in pixels at the depth of the texel.
#import <common/edges.wgsl>
#import <common/screen.wgsl>

struct Params {
    threshold: f32,
    apply_threshold: u32,
    edge_color: vec4f,
    background_color: vec4f,
}

@group(1) @binding(0) var<uniform> params: Params;
@group(1) @binding(1) var depth_texture: texture_depth_2d;
@group(1) @binding(2) var normal_texture: texture_2d<f32>;

@fragment
fn planes(at: ScreenVarying) -> @location(0) vec4f {
    let texel = texel_at(at.texcoord, textureDimensions(depth_texture));
    let distance_px = plane_distance_px(depth_texture, normal_texture, texel);
    var strength = f32(distance_px > params.threshold);
    if params.apply_threshold == 0u {
        strength = distance_px / max(params.threshold, 1.0e-6);
    }
    return line_color(strength, params.edge_color, params.background_color);
}
