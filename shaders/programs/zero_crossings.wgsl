// Edges where a second derivative crosses zero (NPRView thesis, section 3.2): a neighbor has
// the other sign, and the step is at least the threshold. The texels on both sides are edges.
#import <common/edges.wgsl>
#import <common/screen.wgsl>

struct Params {
    threshold: f32,
    edge_color: vec4f,
    background_color: vec4f,
}

@group(1) @binding(0) var<uniform> params: Params;
@group(1) @binding(1) var texture: texture_2d<f32>;

@fragment
fn zero_crossings(at: ScreenVarying) -> @location(0) vec4f {
    let size = textureDimensions(texture);
    let texel = texel_at(at.texcoord, size);
    let center = textureLoad(texture, texel, 0).r;
    var crosses = false;
    for (var tap = 0; tap < 4; tap++) {
        let other = textureLoad(texture, within(texel + CROSS[tap], size), 0).r;
        crosses |= center * other < 0.0 && abs(center - other) >= params.threshold;
    }
    return line_color(f32(crosses), params.edge_color, params.background_color);
}
