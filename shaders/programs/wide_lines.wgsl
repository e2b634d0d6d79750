// Lines of any width, from the nearest line texels that flood.wgsl found. Detected lines are
// two texels wide, one texel on each side of a boundary, so a width of 2 reproduces them.
#import <common/edges.wgsl>
#import <common/screen.wgsl>

struct Params {
    width: f32,
    edge_color: vec4f,
    background_color: vec4f,
}

@group(1) @binding(0) var<uniform> params: Params;
@group(1) @binding(1) var texture: texture_2d<f32>;

@fragment
fn wide_lines(at: ScreenVarying) -> @location(0) vec4f {
    let texel = texel_at(at.texcoord, textureDimensions(texture));
    let seed = textureLoad(texture, texel, 0).xy;
    let distance = length(seed - vec2f(texel));
    // Ink falls off from half a texel inside the rim to half a texel outside it.
    let inked = clamp(0.5 * params.width - distance, 0.0, 1.0);
    let strength = select(inked, 0.0, seed.x < 0.0);
    return line_color(strength, params.edge_color, params.background_color);
}
