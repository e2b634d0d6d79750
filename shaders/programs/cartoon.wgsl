// Cartoon light in bands, computed without a texture (Card and Mitchell, Cartoon Lighting
// Model). The specular band lies where N.H is large, as in their text; Listing 3 as printed
// compares N.L twice.
#import <common/light.wgsl>

struct Params {
    // N.L above which a surface is lit.
    falloff: f32,
    // N.H above which it shows the highlight.
    specular_falloff: f32,
    has_specular: u32,
    // Bands on the lit side.
    band_count: i32,
    // 1 to multiply the colors by those of the material.
    from_material: u32,
    dark: vec3f,
    average: vec3f,
    // The color of the last of several bands.
    light: vec3f,
    bright: vec3f,
    // Width of the borders between bands, in pixels.
    smoothness: f32,
}

@group(1) @binding(0) var<uniform> params: Params;

// The color of the band for a cosine N.L.
fn band(facing: f32) -> vec3f {
    if facing <= params.falloff {
        return params.dark;
    }
    let bands = f32(max(params.band_count, 1));
    let lit = (facing - params.falloff) / (1.0 - params.falloff);
    let number = min(floor(lit * bands), bands - 1.0);
    return mix(params.average, params.light, number / max(bands - 1.0, 1.0));
}

@fragment
fn cartoon(at: SurfaceVarying, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let texel = textureSample(base_texture, base_sampler, at.texcoord);
    let surface = surface_at(at, is_front);
    let material = material_at(at.material_range, texel, at.color);
    let facing = dot(surface.normal, surface.to_light);
    let glint = dot(surface.normal, unit(surface.to_light + surface.to_eye));
    let reach = params.smoothness * vec2f(fwidth(facing), fwidth(glint));
    // The mean over the pixel, so that borders of bands are as smooth as those of surfaces.
    var lit = vec3f(0.0);
    var highlight = 0.0;
    for (var tap = 0; tap < 4; tap++) {
        let away = (f32(tap) - 1.5) / 4.0;
        lit += 0.25 * band(facing + away * reach.x);
        highlight += 0.25 * f32(glint + away * reach.y > params.specular_falloff);
    }
    let is_own = params.from_material == 1u;
    let own = select(vec3f(1.0), material.diffuse.rgb, is_own);
    // The stronger the material's specular color, the whiter the highlight.
    let white = mix(own, vec3f(1.0), clamp(intensity(material.specular.rgb), 0.0, 1.0));
    let bright = params.bright * select(vec3f(1.0), white, is_own);
    let color = mix(lit * own, bright, highlight * f32(params.has_specular));
    return painted(color * frame.light_color, material);
}
