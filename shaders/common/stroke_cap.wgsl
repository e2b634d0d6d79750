// Start and finish caps (McGuire and Hughes, Equations 4 and 5), and half disks in their
// place (section 6).
// Rust twin: crates/edgemesh/src/oracle/stroke_cap.rs.
//
//          m                two triangles that share the side s - m
//        . | .              fill the gap between two quads
//   p  /   |   \  p'
//    |_____s_____|
#import <common/stroke_quad.wgsl>

// Triangles of a half disk.
const DISK_STEPS: u32 = 8u;

// The paper's j: the corners are reversed if outside is -1.
fn cap_corner(outside: f32, i: u32) -> u32 {
    return select(2u - i, i, outside > 0.0);
}

// Corner j of the cap at the end s, on the side `outside`.
fn stroke_cap(s: vec2f, p: vec2f, m: vec2f, outside: f32, reach_px: f32, j: u32) -> vec2f {
    if j == 0u {
        return s;
    }
    if j == 1u {
        return s + p * (outside * reach_px);
    }
    return s + m * (stroke_sign(dot(m, p)) * outside * reach_px);
}

// Whether there is a gap to fill: whether m, turned to the side `outside`, leans beyond the
// end of the quad. `forward` is +1 at the finish, -1 at the start.
fn cap_fills_gap(p: vec2f, m: vec2f, outside: f32, forward: f32) -> bool {
    let beyond = vec2f(p.y, -p.x) * forward;
    return dot(m, beyond) * stroke_sign(dot(m, p)) * outside > 0.0;
}

// Vertex k of the half disk, from the end of the spine; vertices run from the left rim (p)
// around the end to the right rim. `left_px` and `right_px` are the widths of the quad on
// each side; a half quad has a quarter disk.
fn half_disk(p: vec2f, forward: f32, left_px: f32, right_px: f32, k: u32) -> vec2f {
    let angle = 3.14159265 * f32(k) / f32(DISK_STEPS);
    let beyond = vec2f(p.y, -p.x) * forward;
    let reach_px = select(right_px, left_px, 2u * k < DISK_STEPS);
    // The middle vertex belongs to both sides, and takes the larger radius, so that a
    // quarter disk is complete.
    let radius_px = select(reach_px, max(left_px, right_px), 2u * k == DISK_STEPS);
    return (p * cos(angle) + beyond * sin(angle)) * radius_px;
}
