// Paper: a texture that repeats over the picture, times a color.
#import <common/screen.wgsl>
#import <common/surface.wgsl>

struct Params {
    paper_color: vec3f,
    // Strength of the grain, 0 to 1.
    grain: f32,
    // Pixels of the picture per texel.
    paper_scale: f32,
}

@group(1) @binding(0) var<uniform> params: Params;
@group(1) @binding(1) var paper: texture_2d<f32>;
@group(1) @binding(2) var paper_sampler: sampler;

fn paper_at(pixel: vec2f) -> vec4f {
    let texels = vec2f(textureDimensions(paper));
    let uv = pixel / (texels * max(params.paper_scale, 1.0e-3));
    let texel = textureSampleLevel(paper, paper_sampler, uv, 0.0).rgb;
    return vec4f(params.paper_color * mix(vec3f(1.0), texel, params.grain), 1.0);
}

// Over the whole picture.
@fragment
fn sheet(at: ScreenVarying) -> @location(0) vec4f {
    return paper_at(at.position.xy + frame.corner_px);
}

// On the surfaces of the scene.
@fragment
fn surface(at: SurfaceVarying) -> @location(0) vec4f {
    cut(at);
    return paper_at(at.position.xy + frame.corner_px);
}
