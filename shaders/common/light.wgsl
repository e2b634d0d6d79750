// The factors of the Phong model (NPRView thesis, Equations 4.1 to 4.5).
#import <common/surface.wgsl>

// Equation 4.2.
fn diffuse_factor(at: Surface) -> f32 {
    return max(dot(at.normal, at.to_light), 0.0);
}

// Equation 4.3.
fn specular_factor(at: Surface, shininess: f32) -> f32 {
    let half_vector = unit(at.to_light + at.to_eye);
    let facing = dot(at.normal, half_vector);
    if dot(at.normal, at.to_light) < 0.0 || facing <= 0.0 {
        return 0.0;
    }
    return pow(facing, max(shininess, 1.0));
}

// Equation 4.5.
fn intensity(color: vec3f) -> f32 {
    return dot(color, vec3f(0.3, 0.6, 0.1));
}

// Whether transparent surfaces are drawn, after all opaque ones.
override BLENDS: bool = false;

// The color of a surface with its opacity, premultiplied; opaque unless transparent surfaces
// are drawn.
fn painted(color: vec3f, material: MaterialUniform) -> vec4f {
    let opacity = select(1.0, clamp(material.diffuse.a, 0.0, 1.0), BLENDS);
    return vec4f(color, 1.0) * opacity;
}

// The material of a range; its diffuse and ambient colors are multiplied by the color of the
// vertices, and by the base texture if the model has texture coordinates.
fn material_at(material_range: u32, texel: vec4f, color: vec4f) -> MaterialUniform {
    let of_range = surface_ranges[material_range];
    var material = materials[of_range.material];
    material.diffuse *= color;
    material.ambient *= vec4f(color.rgb, 1.0);
    if of_range.has_texcoords == 1u {
        material.diffuse *= texel;
        material.ambient *= vec4f(texel.rgb, 1.0);
    }
    return material;
}
