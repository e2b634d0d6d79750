// Which side of a face the eye is on (McGuire and Hughes, Equation 1); zero
// counts as back. Rust twin: crates/edgemesh/src/oracle/facing.rs.
#import <common/mesh.wgsl>

fn faces_eye(plane: FacePlane, eye: vec4f) -> bool {
    let to_eye = eye.xyz - eye.w * plane.point.xyz;
    return dot(plane.normal.xyz, to_eye) > 0.0;
}
