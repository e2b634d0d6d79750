// How many layers and draws of strokes one object can have. Rust twins: the constants
// of these names in crates/strokes/src/look.rs.

const MAX_LAYERS: u32 = 7u;
const MAX_DRAWS: u32 = 16u;
