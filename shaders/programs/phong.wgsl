// The Phong model, with a light that does not fade with distance (NPRView thesis,
// Equation 4.1).
#import <common/light.wgsl>

@fragment
fn phong(at: SurfaceVarying, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let texel = textureSample(base_texture, base_sampler, at.texcoord);
    let surface = surface_at(at, is_front);
    let material = material_at(at.material_range, texel, at.color);
    let lit = diffuse_factor(surface) * material.diffuse.rgb
        + specular_factor(surface, material.specular.w) * material.specular.rgb;
    return painted(material.ambient.rgb + frame.light_color * lit, material);
}
