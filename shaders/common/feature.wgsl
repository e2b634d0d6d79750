// Which edges are features of a view (McGuire and Hughes, Equation 1).
// Rust twins: EdgeFlags in crates/edgemesh/src/edge_mesh/edge_flags.rs, the crease angle in
// edge_word.rs beside it, all else in crates/edgemesh/src/view/feature.rs.
#import <common/line_class.wgsl>

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
const GROOVE: u32 = 1024u;
const PAIRED: u32 = 2048u;

const CREASE_SHIFT: u32 = 12u;
const CREASE_STEPS: u32 = 0x1ffffu;
const CONCAVE: u32 = 0x20000000u;
// In the 16-bit layout a step is this many, and a word has 24 bits.
const STEPS_PER_STEP_16: u32 = 16u;
const CREASE_SHIFT_16: u32 = 10u;
const CONCAVE_16: u32 = 0x800000u;

// Line bits: the state of an edge in a view. The live list stores the first three above
// the edge's index.
const CONTOUR: u32 = 0x80000000u;
const A_FACES: u32 = 0x40000000u;
const BEHIND_SOLID: u32 = 0x20000000u;
const DRAWN: u32 = 0x10000000u;
const EDGE_INDEX_MASK: u32 = 0x1fffffffu;

struct EdgeFaces {
    has_b: bool,
    a_faces: bool,
    b_faces: bool,
}

struct Line {
    bits: u32,
    layer: u32,
}

// The classes of an edge that do not depend on the view, one bit each.
fn static_classes(word: u32, table: ClassTable) -> u32 {
    let steps = (word >> CREASE_SHIFT) & CREASE_STEPS;
    let is_concave = (word & CONCAVE) != 0u;
    let is_ridge = select(
        !is_concave && steps >= table.ridge_steps,
        (word & RIDGE) != 0u,
        table.ridge_steps == 0u,
    );
    let is_valley = select(
        is_concave && steps >= table.valley_steps,
        (word & VALLEY) != 0u,
        table.valley_steps == 0u,
    );
    return (u32((word & MARKED) != 0u) << CLASS_MARKED)
        | (u32((word & (BOUNDARY | NON_MANIFOLD)) != 0u) << CLASS_BOUNDARY)
        | (u32((word & MATERIAL) != 0u) << CLASS_MATERIAL)
        | (u32((word & SMOOTHING) != 0u) << CLASS_SMOOTHING)
        | (u32(is_ridge) << CLASS_RIDGE)
        | (u32(is_valley) << CLASS_VALLEY);
}

// The edge word with the least angle that 24 bits can stand for. Rust twin:
// EdgeWord::from_24_bits.
fn word_of_24_bits(bits: u32) -> u32 {
    let steps = ((bits & (CONCAVE_16 - 1u)) >> CREASE_SHIFT_16) * STEPS_PER_STEP_16;
    let least = max(steps, STEPS_PER_STEP_16 - 1u) - (STEPS_PER_STEP_16 - 1u);
    let creases = RIDGE | VALLEY;
    let ends = BOUNDARY | NON_MANIFOLD;
    var flags = bits & ((1u << CREASE_SHIFT_16) - 1u) & ~DIAGONAL;
    if (flags & creases) == creases {
        flags = (flags & ~creases) | DIAGONAL;
    }
    if (flags & ends) == ends {
        flags = (flags & ~ends) | PAIRED;
    }
    return flags
        | select(0u, GROOVE, (bits & DIAGONAL) != 0u)
        | (least << CREASE_SHIFT)
        | select(0u, CONCAVE, (bits & CONCAVE_16) != 0u);
}

fn classify_edge(word: u32, faces: EdgeFaces, table: ClassTable, eye_is_outside: bool) -> Line {
    let b_faces = faces.b_faces != ((word & CLASH) != 0u);
    let is_manifold = faces.has_b && (word & NON_MANIFOLD) == 0u;
    // A contour has exactly one face toward the eye.
    let is_contour = is_manifold && faces.a_faces != b_faces;
    let classes = (static_classes(word, table) | (u32(is_contour) << CLASS_CONTOUR)) & table.drawn;
    // A solid hides its edges that face away from an eye outside it, and the contours in
    // its grooves.
    let is_turned_away = !faces.a_faces && !b_faces;
    let is_behind = eye_is_outside && (word & SOLID) != 0u
        && (is_turned_away || (is_contour && (word & GROOVE) != 0u));
    let is_drawn = classes != 0u && (!is_behind || table.keeps_hidden != 0u);
    let bits = select(0u, CONTOUR, is_contour)
        | select(0u, A_FACES, faces.a_faces)
        | select(0u, BEHIND_SOLID, is_behind)
        | select(0u, DRAWN, is_drawn);
    let layer = select(NO_LAYER, layer_of_class(table, countTrailingZeros(classes)), is_drawn);
    return Line(bits, layer);
}
