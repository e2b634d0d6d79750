// The object that was filled, in a picture without a stencil: always unknown.
#import <common/silhouette.wgsl>

fn filled_object(pixel: vec2i) -> u32 {
    return NO_OBJECT;
}
