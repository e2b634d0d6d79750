// A texture times an opacity, to be blended over a target.
#import <common/screen.wgsl>

struct Params {
    opacity: f32,
}

@group(1) @binding(0) var<uniform> params: Params;
@group(1) @binding(1) var texture: texture_2d<f32>;
@group(1) @binding(2) var texture_sampler: sampler;

@fragment
fn composite(at: ScreenVarying) -> @location(0) vec4f {
    return textureSampleLevel(texture, texture_sampler, at.texcoord, 0.0) * params.opacity;
}
