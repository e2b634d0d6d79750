// The cartoon shader of the NPRView thesis (section 4.2): the intensity of the light, looked
// up in a toon map, per pixel or per vertex.
#import <common/light.wgsl>

struct Params {
    // Factor of the ambient color.
    ambient: f32,
    // Width of the borders between steps, in pixels.
    smoothness: f32,
}

@group(1) @binding(0) var<uniform> params: Params;
@group(1) @binding(1) var toon_map: texture_2d<f32>;
@group(1) @binding(2) var toon_map_sampler: sampler;

struct ToonVarying {
    @builtin(position) @invariant position: vec4f,
    @location(0) point_in_world: vec3f,
    @location(1) texcoord: vec2f,
    @location(2) @interpolate(flat) material_range: u32,
    // Of the outside and of the inside; a vertex at a contour needs both.
    @location(3) intensities: vec2f,
    @location(4) color: vec4f,
}

// Equation 4.4.
fn light_intensity(surface: Surface, material: MaterialUniform) -> f32 {
    return diffuse_factor(surface)
        + specular_factor(surface, material.specular.w) * intensity(material.specular.rgb);
}

// The map at an intensity, clamped to its outermost texels.
fn looked_up(light: f32) -> vec3f {
    let half_texel = 0.5 / f32(textureDimensions(toon_map).x);
    let place = clamp(light, half_texel, 1.0 - half_texel);
    return textureSampleLevel(toon_map, toon_map_sampler, vec2f(place, 0.5), 0.0).rgb;
}

// Equation 4.6, with the mean of the map over the pixel, so that the borders between steps
// are as smooth as those of surfaces.
fn stepped(light: f32, light_a_pixel: f32, material: MaterialUniform) -> vec4f {
    var step = vec3f(0.0);
    for (var tap = 0; tap < 4; tap++) {
        step += 0.25 * looked_up(light + params.smoothness * light_a_pixel * (f32(tap) - 1.5) / 4.0);
    }
    let color = params.ambient * material.ambient.rgb
        + frame.light_color * step * material.diffuse.rgb;
    return painted(color, material);
}

@fragment
fn per_pixel(at: SurfaceVarying, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let texel = textureSample(base_texture, base_sampler, at.texcoord);
    // Not fwidth of the light: outside the triangle, the neighbors' material is undefined.
    let point_x = dpdx(at.point_in_world);
    let point_y = dpdy(at.point_in_world);
    let normal_x = dpdx(at.normal_in_world);
    let normal_y = dpdy(at.normal_in_world);
    let surface = surface_at(at, is_front);
    let side = side_seen(is_front);
    let right = surface_of(at.point_in_world + point_x, side * (at.normal_in_world + normal_x));
    let below = surface_of(at.point_in_world + point_y, side * (at.normal_in_world + normal_y));
    let material = material_at(at.material_range, texel, at.color);
    let light = light_intensity(surface, material);
    let light_a_pixel = abs(light_intensity(right, material) - light)
        + abs(light_intensity(below, material) - light);
    return stepped(light, light_a_pixel, material);
}

@vertex
fn toon_vertex(vertex: SurfaceVertex) -> ToonVarying {
    let at = surface_varying(vertex);
    let material = materials[surface_ranges[at.material_range].material];
    let outside = surface_of(at.point_in_world, at.normal_in_world);
    let inside = surface_of(at.point_in_world, -at.normal_in_world);
    let intensities = vec2f(light_intensity(outside, material), light_intensity(inside, material));
    return ToonVarying(
        at.position,
        at.point_in_world,
        at.texcoord,
        at.material_range,
        intensities,
        at.color,
    );
}

@fragment
fn per_vertex(at: ToonVarying, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let texel = textureSample(base_texture, base_sampler, at.texcoord);
    let a_pixel = fwidth(at.intensities);
    if is_cut_away(at.point_in_world) {
        discard;
    }
    let is_outside = side_seen(is_front) > 0.0;
    let light = select(at.intensities.y, at.intensities.x, is_outside);
    let light_a_pixel = select(a_pixel.y, a_pixel.x, is_outside);
    let material = material_at(at.material_range, texel, at.color);
    return stepped(light, light_a_pixel, material);
}
