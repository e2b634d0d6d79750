// Card and Mitchell's five taps on the depth, which is stored in the alpha of their normals,
// 0 at the near end of the scene and 1 at its far end (Listing 10): an edge where the sum of
// the differences reaches the threshold. The listing as printed adds only two of the four.
#import <common/edges.wgsl>
#import <common/screen.wgsl>

struct Params {
    threshold: f32,
    edge_color: vec4f,
    background_color: vec4f,
}

@group(1) @binding(0) var<uniform> params: Params;
@group(1) @binding(1) var normal_texture: texture_2d<f32>;

fn depth_at(texel: vec2i) -> f32 {
    return textureLoad(normal_texture, within(texel, textureDimensions(normal_texture)), 0).a;
}

@fragment
fn five_taps(at: ScreenVarying) -> @location(0) vec4f {
    let texel = texel_at(at.texcoord, textureDimensions(normal_texture));
    let center = depth_at(texel);
    var sum = 0.0;
    for (var tap = 0; tap < 4; tap++) {
        sum += abs(center - depth_at(texel + DIAGONALS[tap]));
    }
    let strength = f32(sum - params.threshold >= 0.0);
    return line_color(strength, params.edge_color, params.background_color);
}
