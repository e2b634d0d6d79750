// Region ids of the scene, as colors (NPRView thesis, section 3.3.3).
#import <common/encode.wgsl>
#import <common/surface.wgsl>

struct Params {
    // 0 for objects, 1 for materials, 2 for groups.
    regions: u32,
}

@group(1) @binding(0) var<uniform> params: Params;

fn region_color(material_range: u32) -> vec4f {
    let of_range = surface_ranges[material_range];
    let ids = array(of_range.object_region, of_range.material_region, of_range.group_region);
    return vec4f(rgb_of_id(ids[min(params.regions, 2u)]), 1.0);
}

@fragment
fn ids(at: SurfaceVarying) -> @location(0) vec4f {
    cut(at);
    return region_color(at.material_range);
}
