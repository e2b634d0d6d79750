// The integers of a texture as colors; nearby integers get clearly different ones.
#import <common/screen.wgsl>
#import <common/encode.wgsl>

@group(1) @binding(1) var texture: texture_2d<u32>;

@fragment
fn show(at: ScreenVarying) -> @location(0) vec4f {
    let size = vec2f(textureDimensions(texture));
    return vec4f(rgb_of_id(textureLoad(texture, vec2i(at.texcoord * size), 0).r), 1.0);
}
