// Edges in normals, depths and region ids, with a color for each kind (NPRView thesis,
// section 3.3.4, Figures 3.16 and 3.19).
#import <common/edges.wgsl>
#import <common/screen.wgsl>

struct Params {
    normal_threshold: f32,
    depth_threshold: f32,
    // 0 if the depth threshold is in radii of the scene, 1 if in world units.
    depth_unit: u32,
    apply_threshold: u32,
    detect_normals: u32,
    detect_depth: u32,
    detect_ids: u32,
    normal_color: vec4f,
    depth_color: vec4f,
    id_color: vec4f,
    // Where several kinds are found.
    edge_color: vec4f,
    background_color: vec4f,
}

@group(1) @binding(0) var<uniform> params: Params;
@group(1) @binding(1) var normal_texture: texture_2d<f32>;
@group(1) @binding(2) var depth_texture: texture_depth_2d;
@group(1) @binding(3) var id_texture: texture_2d<f32>;

fn strengths(texcoord: vec2f) -> vec3f {
    let texel = texel_at(texcoord, textureDimensions(normal_texture));
    let products = dot_products(normal_texture, texel);
    let radius = select(1.0, frame.scene_radius, params.depth_unit == 0u);
    let bend = depth_laplacian(depth_texture, texel) / radius;
    let ids = regions_differ(id_texture, texel);
    var strength = vec3f(vec3<bool>(
        (products.x < params.normal_threshold),
        (bend > params.depth_threshold),
        ids,
    ));
    if params.apply_threshold == 0u {
        strength = vec3f(
            params.normal_threshold * (4.0 - products.y),
            params.depth_threshold * bend,
            f32(ids),
        );
    }
    let wanted = vec3u(params.detect_normals, params.detect_depth, params.detect_ids);
    return clamp(strength, vec3f(0.0), vec3f(1.0)) * vec3f(wanted != vec3u(0u));
}

@fragment
fn combined(at: ScreenVarying) -> @location(0) vec4f {
    let strength = strengths(at.texcoord);
    let kinds = vec3f(strength > vec3f(0.5));
    let count = kinds.x + kinds.y + kinds.z;
    let strongest = max(max(strength.x, strength.y), strength.z);
    var color = params.edge_color;
    if count < 1.5 {
        // One kind or none: the color of the strongest.
        color = select(params.id_color, params.depth_color, strength.y == strongest);
        color = select(color, params.normal_color, strength.x == strongest);
    }
    return line_color(strongest, color, params.background_color);
}
