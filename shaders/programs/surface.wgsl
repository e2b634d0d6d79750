// The scene as its model has it.
#import <common/surface.wgsl>

@vertex
fn surface(vertex: SurfaceVertex) -> SurfaceVarying {
    return surface_varying(vertex);
}
