// Hatching with tonal art maps: six levels in the channels of two textures, blended with
// weights that depend on the light (Card and Mitchell, Listings 4 and 5; Praun et al. 2001).
// Weights are computed per vertex, as there, or per pixel.
//
// If a model has no texture coordinates, the maps are projected along its three axes and
// blended by the direction of the normal.
#import <common/light.wgsl>

struct Params {
    // The light factor of a surface facing the light; 6 uses all levels.
    brightness: f32,
    // Repetitions per unit of the texture coordinates, or per radius of the scene.
    scale: f32,
    // 1 to use the material's color as ink, 0 for ink_color.
    from_material: u32,
    ink_color: vec3f,
    paper_color: vec3f,
}

@group(1) @binding(0) var<uniform> params: Params;
@group(1) @binding(1) var levels_123: texture_2d<f32>;
@group(1) @binding(2) var levels_123_sampler: sampler;
@group(1) @binding(3) var levels_456: texture_2d<f32>;
@group(1) @binding(4) var levels_456_sampler: sampler;

struct HatchingVarying {
    @builtin(position) @invariant position: vec4f,
    @location(0) point_in_world: vec3f,
    @location(1) texcoord: vec2f,
    @location(2) @interpolate(flat) material_range: u32,
    @location(3) point_in_object: vec3f,
    @location(4) normal_in_object: vec3f,
    // Weights of the outside and of the inside; a vertex at a contour needs both.
    @location(5) outside_123: vec3f,
    @location(6) outside_456: vec3f,
    @location(7) inside_123: vec3f,
    @location(8) inside_456: vec3f,
    @location(9) color: vec4f,
}

struct Weights {
    of_123: vec3f,
    of_456: vec3f,
}

// Listing 4: the weight of each level is a tent over the light factor, two wide; in full
// shadow, the darkest level stays.
fn weights_of(light: f32) -> Weights {
    var weights = Weights(
        tent(vec3f(light) - vec3f(5.0, 4.0, 3.0)),
        tent(vec3f(light) - vec3f(2.0, 1.0, 0.0)),
    );
    weights.of_456.z = min(weights.of_456.z + f32(light <= 1.0), 1.0);
    return weights;
}

fn tent(x: vec3f) -> vec3f {
    return max(vec3f(1.0) - abs(x - 1.0), vec3f(0.0));
}

// The tone at a texture coordinate (Listing 5).
fn tone(uv: vec2f, along_x: vec2f, along_y: vec2f, weights: Weights) -> f32 {
    let a = textureSampleGrad(levels_123, levels_123_sampler, uv, along_x, along_y).rgb;
    let b = textureSampleGrad(levels_456, levels_456_sampler, uv, along_x, along_y).rgb;
    let ink = clamp(dot(1.0 - a, weights.of_123), 0.0, 1.0)
        + clamp(dot(1.0 - b, weights.of_456), 0.0, 1.0);
    return 1.0 - clamp(ink, 0.0, 1.0);
}

fn hatched(
    material_range: u32,
    texel: vec4f,
    color: vec4f,
    texcoord: vec2f,
    point: vec3f,
    normal: vec3f,
    weights: Weights,
) -> vec4f {
    let uv = params.scale * texcoord;
    let uv_x = dpdx(uv);
    let uv_y = dpdy(uv);
    let place = params.scale * point / frame.scene_radius;
    let place_x = dpdx(place);
    let place_y = dpdy(place);
    var level = 1.0;
    if surface_ranges[material_range].has_texcoords == 1u {
        level = tone(uv, uv_x, uv_y, weights);
    } else {
        var sides = pow(abs(normal), vec3f(6.0));
        sides /= max(sides.x + sides.y + sides.z, 1.0e-6);
        level = sides.x * tone(place.zy, place_x.zy, place_y.zy, weights)
            + sides.y * tone(place.xz, place_x.xz, place_y.xz, weights)
            + sides.z * tone(place.xy, place_x.xy, place_y.xy, weights);
    }
    let material = material_at(material_range, texel, color);
    let ink = select(params.ink_color, material.diffuse.rgb, params.from_material == 1u);
    return painted(mix(ink, params.paper_color, level), material);
}

@vertex
fn hatching_vertex(vertex: SurfaceVertex) -> HatchingVarying {
    let at = surface_varying(vertex);
    let surface = surface_of(at.point_in_world, at.normal_in_world);
    let light = params.brightness * dot(surface.normal, surface.to_light);
    let outside = weights_of(max(light, 0.0));
    let inside = weights_of(max(-light, 0.0));
    return HatchingVarying(
        at.position,
        at.point_in_world,
        at.texcoord,
        at.material_range,
        vertex.position,
        vertex.normal,
        outside.of_123,
        outside.of_456,
        inside.of_123,
        inside.of_456,
        at.color,
    );
}

@fragment
fn per_vertex(at: HatchingVarying, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let texel = textureSample(base_texture, base_sampler, at.texcoord);
    let is_outside = side_seen(is_front) > 0.0;
    let weights = Weights(
        select(at.inside_123, at.outside_123, is_outside),
        select(at.inside_456, at.outside_456, is_outside),
    );
    let color = hatched(
        at.material_range,
        texel,
        at.color,
        at.texcoord,
        at.point_in_object,
        unit(at.normal_in_object),
        weights,
    );
    if is_cut_away(at.point_in_world) {
        discard;
    }
    return color;
}

@fragment
fn per_pixel(at: SurfaceVarying, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let texel = textureSample(base_texture, base_sampler, at.texcoord);
    // The normal of the face, not that of its shading.
    let normal = unit(cross(dpdx(at.point_in_object), dpdy(at.point_in_object)));
    let surface = surface_of(at.point_in_world, side_seen(is_front) * at.normal_in_world);
    let weights = weights_of(params.brightness * diffuse_factor(surface));
    let color = hatched(
        at.material_range,
        texel,
        at.color,
        at.texcoord,
        at.point_in_object,
        normal,
        weights,
    );
    cut(at);
    return color;
}
