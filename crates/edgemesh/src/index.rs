//! Indices are `u32` everywhere, because that is what the GPU reads.
//!
//! A model with more corners than [`MAX_INDEX`] is refused when it is read, so
//! every later count fits and the one narrowing cast of the crate is here.

/// Marks "no such element" in an index field.
pub const NONE: u32 = u32::MAX;

/// The largest index of a vertex, face, corner or edge: two bits stay free, and
/// sums of two indices fit. (The live list of the GPU packs three bits beside an
/// edge's index in its chunk, which has half as many edges at most.)
pub const MAX_INDEX: usize = (1 << 30) - 1;

/// Narrows an index or count that [`MAX_INDEX`] bounds.
#[must_use]
#[expect(clippy::cast_possible_truncation, reason = "bounded by MAX_INDEX when the model is read")]
pub const fn to_u32(index: usize) -> u32 {
    debug_assert!(index <= u32::MAX as usize, "an index outgrew MAX_INDEX");
    index as u32
}
