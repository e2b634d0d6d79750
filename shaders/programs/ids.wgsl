// Region ids of the scene, as colours (NPRView thesis, section 3.3.3).
#import <common/encode.wgsl>
#import <common/surface.wgsl>

struct Params {
    // Which ids: of objects, materials, or groups.
    regions: u32,
}

@group(1) @binding(0) var<uniform> params: Params;

fn region_color(part: u32) -> vec4f {
    let of_part = surface_parts[part];
    let ids = array(of_part.object_region, of_part.material_region, of_part.group_region);
    return vec4f(rgb_of_id(ids[min(params.regions, 2u)]), 1.0);
}

@fragment
fn ids(at: SurfaceVarying) -> @location(0) vec4f {
    cut(at);
    return region_color(at.part);
}
