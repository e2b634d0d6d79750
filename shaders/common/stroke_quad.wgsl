// The stroke quad and the half quad (McGuire and Hughes, Equations 2 and 3).
// Rust twin: crates/edgemesh/src/oracle/stroke_quad.rs.
//
//   3 ---------------- 2    s + p        half quad, outside = +1:
//   |                  |                 3 ------------- 2
//   s0 ============== s1                 |               |
//   |                  |                 0 ============= 1
//   0 ---------------- 1    s - p
#import <common/spine.wgsl>

// Placements of a stroke relative to its spine.
const CENTERED: u32 = 0u;
const OUTSIDE: u32 = 1u;
const INSIDE: u32 = 2u;
// Contours outside, all other lines centered.
const AUTOMATIC: u32 = 3u;

// The offsets along p of the near side (corners 0 and 1) and of the far side (corners 2
// and 3).
fn quad_offsets(placement: u32, outside: f32, width_px: f32) -> vec2f {
    if placement == CENTERED {
        return vec2f(-0.5, 0.5) * width_px;
    }
    return vec2f(0.0, select(outside, -outside, placement == INSIDE) * width_px);
}

// The paper's sign: -1 for a negative argument and +1 for any other.
fn stroke_sign(value: f32) -> f32 {
    return select(1.0, -1.0, value < 0.0);
}
