// Line classes, and the table that assigns them to layers.
// Rust twins: LineClass and ClassTable in crates/edgemesh/src/line/class.rs.

const LINE_CLASS_COUNT: u32 = 7u;
const MAX_LINE_CLASSES: u32 = 32u;

// The number of each class, strongest first: LineClass::Contour and so on.
const CLASS_CONTOUR: u32 = 0u;
const CLASS_MARKED: u32 = 1u;
const CLASS_BOUNDARY: u32 = 2u;
const CLASS_MATERIAL: u32 = 3u;
const CLASS_SMOOTHING: u32 = 4u;
const CLASS_RIDGE: u32 = 5u;
const CLASS_VALLEY: u32 = 6u;

// The layer of a class that is not drawn.
const NO_LAYER: u32 = 255u;

struct ClassTable {
    // Eight bits per class, class 0 lowest in the first word.
    layers: array<vec4u, MAX_LINE_CLASSES / 16u>,
    // One bit per class.
    drawn: u32,
    // Thresholds in steps of 1/45 degree; 0 for the creases of the mesh.
    ridge_steps: u32,
    valley_steps: u32,
    // 1 if edges hidden by their own solid are kept.
    keeps_hidden: u32,
}

// Rust twin: ClassTable::layer.
fn layer_of_class(table: ClassTable, class_index: u32) -> u32 {
    let word = (class_index / 4u) % (MAX_LINE_CLASSES / 4u);
    let words = table.layers[word / 4u];
    return (words[word % 4u] >> (8u * (class_index % 4u))) & 0xffu;
}
