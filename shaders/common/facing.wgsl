// Which side of a face the eye is on (McGuire and Hughes, Equation 1); zero counts as
// back. `eye` is in object space: a point with w = 1, or a direction with w = 0.
// Rust twin: crates/edgemesh/src/view/facing.rs.
#import <common/mesh.wgsl>

fn faces_eye(plane: FacePlane, eye: vec4f) -> bool {
    let to_eye = eye.xyz - eye.w * plane.point.xyz;
    return dot(plane.normal.xyz, to_eye) > 0.0;
}

// The same, from the corners of a face. They are rotated so that the smallest comes first,
// so all edges of a face get the same sign.
fn triangle_faces_eye(a: vec3f, b: vec3f, c: vec3f, eye: vec4f) -> bool {
    var first = a;
    var second = b;
    var third = c;
    if is_before(b, a) && !is_before(c, b) {
        first = b;
        second = c;
        third = a;
    } else if is_before(c, a) && is_before(c, b) {
        first = c;
        second = a;
        third = b;
    }
    let normal = cross(even(second - first), even(third - first));
    return dot(normal, even(eye.xyz - eye.w * first)) > 0.0;
}

// Scales a vector so that its largest component is 1: products of tiny or huge vectors
// would leave the range of 32-bit floats.
fn even(vector: vec3f) -> vec3f {
    let largest = max(max(abs(vector.x), abs(vector.y)), abs(vector.z));
    return select(vector / largest, vec3f(0.0), largest <= 0.0);
}

fn is_before(a: vec3f, b: vec3f) -> bool {
    if a.x != b.x {
        return a.x < b.x;
    }
    if a.y != b.y {
        return a.y < b.y;
    }
    return a.z < b.z;
}

// The absolute cosine between a face's normal and the line of sight to its first corner; 0
// for a face without area.
fn facing_cosine(a: vec3f, b: vec3f, c: vec3f, eye: vec4f) -> f32 {
    let normal = cross(even(b - a), even(c - a));
    let to_eye = even(eye.xyz - eye.w * a);
    let size = length(normal) * length(to_eye);
    return select(abs(dot(normal, to_eye)) / size, 0.0, size <= 0.0);
}
