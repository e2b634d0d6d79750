//! Indices are `u32` everywhere, because the GPU reads them so.
//!
//! Readers refuse models with more corners than [`MAX_INDEX`], so every later count fits, and
//! [`to_u32`] is the only narrowing cast of indices.

/// The value of an index field without an element.
pub const NONE: u32 = u32::MAX;

/// The largest index of a vertex, face, corner or edge. Two bits stay free, and sums of two indices
/// fit. (The live list of the GPU packs three bits beside the index of an edge within its chunk,
/// which holds at most half as many edges.)
pub const MAX_INDEX: usize = (1 << 30) - 1;

/// The most places of instanced meshes in one file, because each is an object of its own when it is
/// drawn.
pub const MAX_PLACEMENTS: usize = 10_000;

/// Narrows an index or count, at most [`MAX_INDEX`].
///
/// # Panics
/// Panics in debug builds if `index` does not fit; other builds truncate it.
#[must_use]
#[expect(clippy::cast_possible_truncation, reason = "bounded by MAX_INDEX when the model is read")]
pub const fn to_u32(index: usize) -> u32 {
    debug_assert!(index <= u32::MAX as usize, "an index outgrew MAX_INDEX");
    index as u32
}
