// One triangle over a whole target.
#import <common/screen.wgsl>

@vertex
fn screen(@builtin(vertex_index) index: u32) -> ScreenVarying {
    let corner = vec2f(vec2u(index << 1u, index) & vec2u(2u));
    // At the far plane, behind everything: depth is reversed.
    return ScreenVarying(vec4f(2.0 * corner - 1.0, 0.0, 1.0), vec2f(corner.x, 1.0 - corner.y));
}
