// Edges between regions (NPRView thesis, section 3.3.3).
#import <common/edges.wgsl>
#import <common/screen.wgsl>

struct Params {
    edge_color: vec4f,
    background_color: vec4f,
}

@group(1) @binding(0) var<uniform> params: Params;
@group(1) @binding(1) var id_texture: texture_2d<f32>;

@fragment
fn regions(at: ScreenVarying) -> @location(0) vec4f {
    let texel = texel_at(at.texcoord, textureDimensions(id_texture));
    let strength = f32(regions_differ(id_texture, texel));
    return line_color(strength, params.edge_color, params.background_color);
}
