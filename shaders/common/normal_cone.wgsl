// Whether all faces of a cluster face the eye, or all face away (Johnson and Cohen 2001).
// Rust twin: crates/edgemesh/src/edge_mesh/normal_cone.rs.

struct NormalCone {
    // A sphere around the points of the faces, in object space.
    center: vec3f,
    radius: f32,
    // A cone around their normals; without one, the cosine of its half angle is 0 or less.
    axis: vec3f,
    cosine: f32,
}

const MIXED: u32 = 0u;
const ALL_FACE: u32 = 1u;
const ALL_AWAY: u32 = 2u;

const CONE_MARGIN: f32 = 1e-4;

fn cone_facing(cone: NormalCone, eye: vec4f) -> u32 {
    if cone.cosine <= 0.0 {
        return MIXED;
    }
    let to_eye = eye.xyz - eye.w * cone.center;
    let distance = length(to_eye);
    let along = dot(cone.axis, to_eye);
    let across = sqrt(max(distance * distance - along * along, 0.0));
    let sine = sqrt(max(1.0 - cone.cosine * cone.cosine, 0.0));
    let reach = abs(eye.w) * cone.radius;
    // Rounding must not decide.
    let bound = reach + CONE_MARGIN * (distance + reach);
    if along * cone.cosine - across * sine > bound {
        return ALL_FACE;
    }
    if along * cone.cosine + across * sine < -bound {
        return ALL_AWAY;
    }
    return MIXED;
}
