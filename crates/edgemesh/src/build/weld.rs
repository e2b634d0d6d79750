//! Welds vertices whose positions are exactly equal.
//!
//! Only mesh geometry matters for edges (paper, section 3, footnote 4): a
//! vertex that a file lists twice, for a second normal or texture coordinate,
//! is one vertex here. Positions are compared as numbers, so -0 equals 0.
//!
//! Idea: number each position when it is first met; the numbering depends on
//! the input alone, since the hash table is only asked, never walked.
//!
//! Rejected: sorting all positions, which takes longer and gains nothing;
//! a tolerance by default, which breaks small geometry.

use rustc_hash::FxHashMap;

use crate::index::{NONE, to_u32};

/// The welded positions and where each input position went.
#[derive(Debug)]
pub(crate) struct Weld {
    /// Different positions, in the order of their first use.
    pub(crate) positions: Vec<[f32; 3]>,
    /// For each input position its index in `positions`.
    pub(crate) welded_from_input: Vec<u32>,
}

/// Welds the positions that `used` names, in that order; a position that is
/// never named goes nowhere ([`NONE`]).
pub(crate) fn weld(positions: &[[f32; 3]], used: impl Iterator<Item = u32>) -> Weld {
    let mut index_of =
        FxHashMap::with_capacity_and_hasher(positions.len(), rustc_hash::FxBuildHasher);
    let mut welded = Vec::with_capacity(positions.len());
    let mut welded_from_input = vec![NONE; positions.len()];
    for input in used {
        if welded_from_input[input as usize] != NONE {
            continue;
        }
        let position = positions[input as usize];
        // Adding 0 turns -0 into 0 and leaves every other number alone.
        let key = position.map(|coordinate| (coordinate + 0.0).to_bits());
        welded_from_input[input as usize] = *index_of.entry(key).or_insert_with(|| {
            welded.push(position);
            to_u32(welded.len() - 1)
        });
    }
    Weld { positions: welded, welded_from_input }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_numbers_are_one_vertex_in_order_of_first_use() {
        let positions =
            [[1., 0., 0.], [0., 0., 0.], [1., -0., 0.], [0., 1e-7, 0.], [f32::NAN, 0., 0.]];
        let weld = weld(&positions, [0, 1, 2, 0, 3].into_iter());
        assert_eq!(weld.welded_from_input, [0, 1, 0, 2, NONE]);
        assert_eq!(weld.positions.len(), 3);
    }
}
