// Which edges are features of a view (McGuire and Hughes, Equation 1).
// Rust twins: EdgeFlags in crates/edgemesh/src/record.rs, the rest in
// crates/edgemesh/src/oracle/feature.rs.

const BOUNDARY: u32 = 1u;
const RIDGE: u32 = 2u;
const VALLEY: u32 = 4u;
const MARKED: u32 = 8u;
const MATERIAL: u32 = 16u;
const NON_MANIFOLD: u32 = 32u;
const DIAGONAL: u32 = 64u;
const CLASH: u32 = 128u;
const SOLID: u32 = 256u;
const SMOOTHING: u32 = 512u;
const ALWAYS_DRAWN: u32 = 575u; // all before DIAGONAL, and SMOOTHING

// Line bits: what a view says of an edge. The live list carries the first two
// above the edge's index.
const CONTOUR: u32 = 0x80000000u;
const A_FACES: u32 = 0x40000000u;
const DRAWN: u32 = 0x20000000u;
const EDGE_INDEX_MASK: u32 = 0x3fffffffu;

fn classify_edge(
    flags: u32,
    has_b: bool,
    a_faces: bool,
    b_faces: bool,
    eye_is_outside: bool,
) -> u32 {
    let b_faces_as_seen = b_faces != ((flags & CLASH) != 0u);
    let is_manifold = has_b && (flags & NON_MANIFOLD) == 0u;
    // Contour where exactly one of the two faces looks at the eye.
    let is_contour = is_manifold && a_faces != b_faces_as_seen;
    // The solid itself hides what turns away from an eye outside of it.
    let is_behind_solid = (flags & SOLID) != 0u && eye_is_outside
        && !a_faces && !b_faces_as_seen;
    let is_drawn = is_contour || ((flags & ALWAYS_DRAWN) != 0u && !is_behind_solid);
    return select(0u, CONTOUR, is_contour)
        | select(0u, A_FACES, a_faces)
        | select(0u, DRAWN, is_drawn);
}

// Whether the eye lies outside of the box, and so outside of every solid in it.
fn eye_is_outside(eye: vec4f, box_min: vec3f, box_max: vec3f) -> bool {
    return eye.w == 0.0 || any(eye.xyz < box_min) || any(eye.xyz > box_max);
}
