// The most layers and stroke sets of one object. Rust twins: the constants of these names
// in crates/strokes/src/style/drawing_style.rs.

const MAX_LAYERS: u32 = 7u;
const MAX_STROKE_SETS: u32 = 16u;
