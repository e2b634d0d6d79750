// The numbers of a texture as colors: `low` is black, `high` is white.
#import <common/screen.wgsl>

struct Params {
    low: f32,
    high: f32,
    // Numbers per texel; one gives a gray.
    number_count: i32,
}

@group(1) @binding(0) var<uniform> params: Params;
@group(1) @binding(1) var texture: texture_2d<f32>;

@fragment
fn show(at: ScreenVarying) -> @location(0) vec4f {
    let size = vec2f(textureDimensions(texture));
    let texel = textureLoad(texture, vec2i(at.texcoord * size), 0);
    let span = params.high - params.low;
    // An empty range shows numbers from `low` on as white.
    let shown = select(
        (texel.rgb - params.low) / span,
        step(vec3f(params.low), texel.rgb),
        abs(span) < 1e-30,
    );
    return vec4f(select(shown, shown.rrr, params.number_count == 1), 1.0);
}
