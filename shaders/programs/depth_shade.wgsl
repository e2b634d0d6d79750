// Depths as grays: white at the near end of the scene's bounding sphere, black at its far end.
#import <common/screen.wgsl>
#import <common/edges.wgsl>

@group(1) @binding(1) var depth_texture: texture_depth_2d;

@fragment
fn shade(at: ScreenVarying) -> @location(0) vec4f {
    let texel = texel_at(at.texcoord, textureDimensions(depth_texture));
    let depth = textureLoad(depth_texture, texel, 0);
    let range = frame.depth_range;
    let part = (distance_of(depth) - range.x) / (range.y - range.x);
    return vec4f(vec3f(1.0 - part), 1.0);
}
