// Gooch light: from cool to warm instead of from dark to bright (Card and Mitchell, Gooch
// Lighting). Follows their formula; Listing 7 swaps alpha and beta.
#import <common/light.wgsl>

struct Params {
    // The share of the diffuse color in the cool color, and in the warm color.
    alpha: f32,
    beta: f32,
    yellow: vec3f,
    blue: vec3f,
    // Factor of the material's highlight.
    highlight: f32,
}

@group(1) @binding(0) var<uniform> params: Params;

@fragment
fn gooch(at: SurfaceVarying, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let texel = textureSample(base_texture, base_sampler, at.texcoord);
    let surface = surface_at(at, is_front);
    let material = material_at(at.material_range, texel, at.color);
    let warm = params.yellow + params.beta * material.diffuse.rgb;
    let cool = params.blue + params.alpha * material.diffuse.rgb;
    let warmth = 0.5 * (1.0 + dot(surface.normal, surface.to_light));
    let glint = specular_factor(surface, material.specular.w) * material.specular.rgb;
    return painted(mix(cool, warm, warmth) + params.highlight * glint, material);
}
