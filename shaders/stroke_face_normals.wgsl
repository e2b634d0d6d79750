// Card and Mitchell's fins as printed (Listing 1), for comparison: every edge is a quad,
// which is pushed out if one face normal points toward the eye and the other away, and
// has no width otherwise.
#import <common/stroke_ink.wgsl>

struct FinVertex {
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) face_a: vec3f,
    @location(3) face_b: vec3f,
}

@vertex
fn stroke_vertices(in: FinVertex) -> Varying {
    let to_eye = object.eye.xyz - object.eye.w * in.position;
    let is_feature = dot(in.face_a, to_eye) * dot(in.face_b, to_eye) < 0.0;
    let clip = object.clip_from_object * vec4f(in.position, 1.0);
    let normal = object.clip_from_normal * vec4f(in.normal, 0.0);
    let height = select(0.0, fin_height(clip, stroke_shape()), is_feature);
    let v = select(0.0, 1.0, all(in.normal == vec3f(0.0)));
    return Varying(clip + normal * height, vec2f(0.0, v), 1.0);
}

@fragment
fn stroke_fragment(in: Varying) -> @location(0) vec4f {
    return cut(in.position, ink(in.uv, in.opacity));
}
