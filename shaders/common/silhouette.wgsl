// The stencil value of pixels without an object. Rust twin: the constant of this name in
// crates/strokes/src/draw/silhouette.rs.
const NO_OBJECT: u32 = 255u;
