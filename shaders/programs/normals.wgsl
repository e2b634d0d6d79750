// Normals of the scene in world space, as colors (NPRView thesis, section 3.3.1), and with
// the depth in alpha (Card and Mitchell, Listing 8).
#import <common/encode.wgsl>
#import <common/screen.wgsl>
#import <common/surface.wgsl>

struct Params {
    // The normal of the background: 0 into the screen (thesis), 1 along z (Card and
    // Mitchell), 2 none.
    background: u32,
}

@group(1) @binding(0) var<uniform> params: Params;

@fragment
fn normals(at: SurfaceVarying, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    return vec4f(rgb_of_normal(surface_at(at, is_front).normal), 1.0);
}

@fragment
fn background(at: ScreenVarying) -> @location(0) vec4f {
    let into_screen = unit(frame.sight.xyz);
    let normals = array(into_screen, vec3f(0.0, 0.0, 1.0), vec3f(0.0));
    return vec4f(rgb_of_normal(normals[min(params.background, 2u)]), 1.0);
}

// Listing 8: alpha is the depth, 0 at the near end of the scene's bounding sphere and 1 at its far
// end.
@fragment
fn normals_and_depth(
    at: SurfaceVarying,
    @builtin(front_facing) is_front: bool,
) -> @location(0) vec4f {
    let surface = surface_at(at, is_front);
    let range = frame.depth_range;
    let distance = dot(frame.sight, vec4f(at.point_in_world, 1.0));
    return vec4f(rgb_of_normal(surface.normal), (distance - range.x) / (range.y - range.x));
}
