// Depths of the scene: distances from the eye along the line of sight, in world units.
#import <common/screen.wgsl>
#import <common/surface.wgsl>

@fragment
fn depth(at: SurfaceVarying) -> @location(0) vec4f {
    cut(at);
    return vec4f(dot(frame.sight, vec4f(at.point_in_world, 1.0)), 0.0, 0.0, 1.0);
}

// The background lies at the far end of the scene.
@fragment
fn background(at: ScreenVarying) -> @location(0) vec4f {
    return vec4f(distance_of(0.0), 0.0, 0.0, 1.0);
}
