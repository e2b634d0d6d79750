// Edges between regions (NPRView thesis, section 3.3.3).
#import <common/screen.wgsl>
#import <common/taps.wgsl>

struct Params {
    edge_color: vec4f,
    background_color: vec4f,
}

@group(1) @binding(0) var<uniform> params: Params;
@group(1) @binding(1) var id_texture: texture_2d<f32>;

fn id_at(texel: vec2i) -> vec3f {
    return textureLoad(id_texture, within(texel, textureDimensions(id_texture)), 0).rgb;
}

@fragment
fn regions(at: ScreenVarying) -> @location(0) vec4f {
    let texel = texel_at(at.texcoord, textureDimensions(id_texture));
    let center = id_at(texel);
    var is_edge = false;
    for (var tap = 0; tap < 4; tap++) {
        is_edge |= any(center != id_at(texel + CROSS[tap]));
    }
    let color = select(params.background_color, params.edge_color, is_edge);
    return vec4f(color.rgb * color.a, color.a);
}
