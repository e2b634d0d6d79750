// The scene in the colors of its materials, unlit, with the texture of the pass over them.
#import <common/light.wgsl>

@group(1) @binding(1) var texture: texture_2d<f32>;
@group(1) @binding(2) var texture_sampler: sampler;

@fragment
fn unlit(at: SurfaceVarying) -> @location(0) vec4f {
    let texel = textureSample(base_texture, base_sampler, at.texcoord);
    let laid = textureSample(texture, texture_sampler, at.texcoord);
    cut(at);
    let material = material_at(at.material_range, texel, at.color);
    return painted(material.diffuse.rgb * mix(vec3f(1.0), laid.rgb, laid.a), material);
}
