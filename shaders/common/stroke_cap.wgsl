// Start and finish caps (McGuire and Hughes, Equations 4 and 5).
// Rust twin: crates/edgemesh/src/oracle/stroke_cap.rs.
//
//          m                the gap between two quads is filled by
//        . | .              two triangles that share the side s - m
//   p  /   |   \  p'
//    |_____s_____|
#import <common/stroke_quad.wgsl>

// The paper's j: the triangle is walked backward where outside is -1.
fn cap_corner(outside: f32, i: u32) -> u32 {
    return select(2u - i, i, outside > 0.0);
}

// Corner j of the cap at the end s; the cap follows its quad to `outside`.
fn stroke_cap(s: vec2f, p: vec2f, m: vec2f, outside: f32, reach_px: f32, j: u32) -> vec2f {
    if j == 0u {
        return s;
    }
    if j == 1u {
        return s + p * (outside * reach_px);
    }
    return s + m * (stroke_sign(dot(m, p)) * outside * reach_px);
}
