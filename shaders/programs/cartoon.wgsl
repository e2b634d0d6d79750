// Banded cartoon light, worked out without a texture (Card and Mitchell, Cartoon Lighting
// Model). As their text has it the specular band is where N.H is large; Listing 3 as
// printed asks N.L twice.
#import <common/light.wgsl>

struct Params {
    // N.L from which a surface is lit.
    falloff: f32,
    // N.H from which it has its highlight.
    specular_falloff: f32,
    has_specular: u32,
    // How many bands there are where it is lit.
    band_count: i32,
    // The colors times those of the material, or alone.
    from_material: u32,
    dark: vec3f,
    average: vec3f,
    // Of the last of several bands.
    light: vec3f,
    bright: vec3f,
    // Over how many pixels the borders of bands go.
    smoothness: f32,
}

@group(1) @binding(0) var<uniform> params: Params;

// The band of an intensity, one of band_count above the falloff.
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
    let material = material_at(at.material_range, texel);
    let facing = dot(surface.normal, surface.to_light);
    let glint = dot(surface.normal, unit(surface.to_light + surface.to_eye));
    let reach = params.smoothness * vec2f(fwidth(facing), fwidth(glint));
    // The mean over what a pixel covers, so that borders are as smooth as those of
    // surfaces.
    var lit = vec3f(0.0);
    var highlight = 0.0;
    for (var tap = 0; tap < 4; tap++) {
        let away = (f32(tap) - 1.5) / 4.0;
        lit += 0.25 * band(facing + away * reach.x);
        highlight += 0.25 * f32(glint + away * reach.y > params.specular_falloff);
    }
    let is_own = params.from_material == 1u;
    let own = select(vec3f(1.0), material.diffuse.rgb, is_own);
    // A highlight is as white as the material's specular color is strong.
    let white = mix(own, vec3f(1.0), clamp(intensity(material.specular.rgb), 0.0, 1.0));
    let bright = params.bright * select(vec3f(1.0), white, is_own);
    let color = mix(lit * own, bright, highlight * f32(params.has_specular));
    return vec4f(color * frame.light_color, 1.0);
}
