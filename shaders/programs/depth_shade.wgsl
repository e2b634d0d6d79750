// Depths as grays: white at the near plane, black at the far plane.
#import <common/screen.wgsl>
#import <common/edges.wgsl>

@group(1) @binding(1) var depth_texture: texture_depth_2d;

@fragment
fn shade(at: ScreenVarying) -> @location(0) vec4f {
    let texel = texel_at(at.texcoord, textureDimensions(depth_texture));
    let depth = textureLoad(depth_texture, texel, 0);
    let near = distance_of(1.0);
    let part = (distance_of(depth) - near) / (distance_of(0.0) - near);
    return vec4f(vec3f(1.0 - part), 1.0);
}
