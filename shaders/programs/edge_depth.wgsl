// Edges as discontinuities of the eye-space depth (NPRView thesis, section 3.3.2; Card
// and Mitchell, Listing 10).
#import <common/edges.wgsl>
#import <common/screen.wgsl>

struct Params {
    threshold: f32,
    apply_threshold: u32,
    // 0 if the threshold is in radii of the scene, 1 if in world units.
    unit: u32,
    edge_color: vec4f,
    background_color: vec4f,
}

@group(1) @binding(0) var<uniform> params: Params;
@group(1) @binding(1) var depth_texture: texture_depth_2d;

// Without apply_threshold, the threshold is a factor of the intensity.
fn decided(measure: f32) -> vec4f {
    let measured = measure / select(1.0, frame.scene_radius, params.unit == 0u);
    var strength = f32(measured > params.threshold);
    if params.apply_threshold == 0u {
        strength = params.threshold * measured;
    }
    return line_color(strength, params.edge_color, params.background_color);
}

// Equation 3.12.
@fragment
fn deltas(at: ScreenVarying) -> @location(0) vec4f {
    let texel = texel_at(at.texcoord, textureDimensions(depth_texture));
    return decided(depth_delta(depth_texture, texel));
}

// Equation 3.13.
@fragment
fn laplacian(at: ScreenVarying) -> @location(0) vec4f {
    let texel = texel_at(at.texcoord, textureDimensions(depth_texture));
    return decided(depth_laplacian(depth_texture, texel));
}
