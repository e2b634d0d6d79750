// The stroke quad and the half quad (McGuire and Hughes, Equations 2 and 3).
// Rust twin: crates/edgemesh/src/oracle/stroke_quad.rs.
//
//   3 ---------------- 2    s + p        half quad, outside = +1:
//   |                  |                 3 ------------- 2
//   s0 ============== s1                 |               |
//   |                  |                 0 ============= 1
//   0 ---------------- 1    s - p
#import <common/spine.wgsl>

fn stroke_quad(spine: Spine, half_width_px: f32, i: u32) -> vec2f {
    let s = select(spine.s0, spine.s1, i == 1u || i == 2u);
    let side = select(-1.0, 1.0, i >= 2u);
    return s + spine.p * (half_width_px * side);
}

fn half_quad(spine: Spine, width_px: f32, outside: f32, i: u32) -> vec2f {
    let s = select(spine.s0, spine.s1, i == 1u || i == 2u);
    let reach = select(0.0, outside * width_px, i >= 2u);
    return s + spine.p * reach;
}

// The paper's sign: -1 for a negative argument and +1 for any other.
fn stroke_sign(value: f32) -> f32 {
    return select(1.0, -1.0, value < 0.0);
}
