// Copies a texture, sampling the nearest texel.
#import <common/screen.wgsl>

@group(1) @binding(1) var texture: texture_2d<f32>;

@fragment
fn copy(at: ScreenVarying) -> @location(0) vec4f {
    let size = vec2f(textureDimensions(texture));
    return textureLoad(texture, vec2i(at.texcoord * size), 0);
}
