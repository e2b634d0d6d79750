// The surfaces of a scene: the inputs of vertex programs, and those of fragment programs
// that follow the vertex program `surface:surface`.
// Rust twins: SurfaceRange in crates/viewer/src/pass_graph/surface.rs, MaterialUniform
// in material.rs.
#import <common/frame.wgsl>

struct SurfaceRange {
    material: u32,
    // Region ids, counted from 1: different for each object, for each material and for each
    // group of an object.
    object_region: u32,
    material_region: u32,
    group_region: u32,
    // 1 if the model has texture coordinates.
    has_texcoords: u32,
    padding: array<u32, 3>,
}

// The Phong model's colors (NPRView thesis, Equation 4.1).
struct MaterialUniform {
    ambient: vec4f,
    // w is the opacity.
    diffuse: vec4f,
    // w is the shininess.
    specular: vec4f,
}

@group(2) @binding(1) var<storage, read> surface_ranges: array<SurfaceRange>;
@group(2) @binding(2) var<storage, read> materials: array<MaterialUniform>;
@group(2) @binding(3) var base_texture: texture_2d<f32>;
@group(2) @binding(4) var base_sampler: sampler;
// Colors in bytes, red first, one for each vertex or one for all.
@group(2) @binding(5) var<storage, read> vertex_colors: array<u32>;

struct SurfaceVertex {
    @builtin(vertex_index) index: u32,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) texcoord: vec2f,
    @location(3) material_range: u32,
}

struct SurfaceVarying {
    // Invariant, so that a later pass gets the same depth.
    @builtin(position) @invariant position: vec4f,
    @location(0) point_in_world: vec3f,
    @location(1) normal_in_world: vec3f,
    @location(2) texcoord: vec2f,
    @location(3) @interpolate(flat) material_range: u32,
    @location(4) point_in_object: vec3f,
    // With opacity; white if the model has no colors, or if they are not drawn.
    @location(5) color: vec4f,
}

// The surface at a fragment: a point and unit vectors, in world space.
struct Surface {
    point: vec3f,
    // On the visible side.
    normal: vec3f,
    to_eye: vec3f,
    to_light: vec3f,
}

fn surface_varying(vertex: SurfaceVertex) -> SurfaceVarying {
    return SurfaceVarying(
        object.clip_from_object * vec4f(vertex.position, 1.0),
        (object.world_from_object * vec4f(vertex.position, 1.0)).xyz,
        (object.world_from_normal * vec4f(vertex.normal, 0.0)).xyz,
        // Models count from the lower left corner of an image, textures from the upper left.
        vec2f(vertex.texcoord.x, 1.0 - vertex.texcoord.y),
        vertex.material_range,
        vertex.position,
        color_of_vertex(vertex),
    );
}

fn color_of_vertex(vertex: SurfaceVertex) -> vec4f {
    return unpack4x8unorm(vertex_colors[min(vertex.index, arrayLength(&vertex_colors) - 1u)]);
}

// The surface at a fragment, discarded if a clip plane cuts it away. Inner sides are lit like
// outer ones.
fn surface_at(at: SurfaceVarying, is_front: bool) -> Surface {
    cut(at);
    return surface_of(at.point_in_world, side_seen(is_front) * at.normal_in_world);
}

// 1 if the outside of a surface is visible, -1 if its inside is.
fn side_seen(is_front: bool) -> f32 {
    return select(-1.0, 1.0, is_front == (object.mirror > 0.0));
}

fn surface_of(point: vec3f, normal: vec3f) -> Surface {
    let to_eye = frame.eye.xyz - frame.eye.w * point;
    let to_light = frame.light.xyz - frame.light.w * point;
    return Surface(point, unit(normal), unit(to_eye), unit(to_light));
}

// Discards the fragment if a clip plane cuts it away.
fn cut(at: SurfaceVarying) {
    if is_cut_away(at.point_in_world) {
        discard;
    }
}

fn unit(direction: vec3f) -> vec3f {
    let length = length(direction);
    return select(vec3f(0.0), direction / length, length > 0.0);
}
