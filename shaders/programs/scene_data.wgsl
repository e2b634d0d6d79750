// Colors, normals and region ids of the scene in one pass with three targets, which the
// NPRView thesis names as future work (section 3.4). The depth needs no target.
#import <common/encode.wgsl>
#import <common/light.wgsl>
#import <common/screen.wgsl>

struct Params {
    // 0 for objects, 1 for materials, 2 for groups.
    regions: u32,
    // The normal of the background: 0 into the screen (thesis, section 3.3.1), 1 along z
    // (Card and Mitchell), 2 none.
    background: u32,
}

@group(1) @binding(0) var<uniform> params: Params;

struct SceneData {
    @location(0) color: vec4f,
    @location(1) normal: vec4f,
    @location(2) region: vec4f,
}

fn region_color(material_range: u32) -> vec4f {
    let of_range = surface_ranges[material_range];
    let ids = array(of_range.object_region, of_range.material_region, of_range.group_region);
    return vec4f(rgb_of_id(ids[min(params.regions, 2u)]), 1.0);
}

fn background_color() -> vec4f {
    let into_screen = unit(frame.sight.xyz);
    let normals = array(into_screen, vec3f(0.0, 0.0, 1.0), vec3f(0.0));
    return vec4f(rgb_of_normal(normals[min(params.background, 2u)]), 1.0);
}

@fragment
fn scene_data(at: SurfaceVarying, @builtin(front_facing) is_front: bool) -> SceneData {
    let texel = textureSample(base_texture, base_sampler, at.texcoord);
    let surface = surface_at(at, is_front);
    let material = material_at(at.material_range, texel, at.color);
    let lit = diffuse_factor(surface) * material.diffuse.rgb
        + specular_factor(surface, material.specular.w) * material.specular.rgb;
    let color = vec4f(material.ambient.rgb + frame.light_color * lit, 1.0);
    return SceneData(
        color,
        vec4f(rgb_of_normal(surface.normal), 1.0),
        region_color(at.material_range),
    );
}

@fragment
fn background(at: ScreenVarying) -> SceneData {
    return SceneData(vec4f(1.0), background_color(), vec4f(0.0));
}
