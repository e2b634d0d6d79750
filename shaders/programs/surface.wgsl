// The default vertex program: the scene without deformation.
#import <common/surface.wgsl>

@vertex
fn surface(vertex: SurfaceVertex) -> SurfaceVarying {
    return surface_varying(vertex);
}
