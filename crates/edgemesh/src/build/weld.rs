//! Welds vertices at the same position.
//!
//! Only the geometry matters for edges (paper, section 3, footnote 4): a vertex that a file lists
//! twice, for a second normal or texture coordinate, is one vertex here. Positions are compared as
//! numbers, so -0 equals 0.
//!
//! Idea: the first of equal positions in the file represents all, and welded vertices are numbered
//! in the order of the file. Positions are distributed to threads by hash, so that equal ones meet
//! in one thread; the result depends neither on the hash nor on the threads.
//!
//! With a tolerance, a vertex is welded to the nearest earlier representative within the tolerance,
//! found in a grid of cells as wide as the tolerance. A vertex moves by at most the tolerance,
//! however many neighbors it has.
//!
//! Rejected: sorting all positions, which takes longer; a tolerance by default, which breaks small
//! geometry; rounding to a grid, which separates neighbors on two sides of a grid line.

use std::hash::{BuildHasher, RandomState};
use std::sync::atomic::{AtomicU32, Ordering};

use glam::Vec3;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use crate::index::{NONE, to_u32};

/// The vertices that become one.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub enum Welding {
    /// Vertices at exactly the same position.
    #[default]
    Exact,
    /// Vertices at most this far apart, in units of the file.
    Within(f64),
    /// No vertices: those of the file are kept.
    Off,
}

/// The welded positions, and the welded vertex of each input position.
#[derive(Debug)]
pub(crate) struct Weld {
    /// Different positions, in the order of the file.
    pub(crate) positions: Vec<[f32; 3]>,
    /// For each input position, its index in `positions`, or [`NONE`] if it is unused.
    pub(crate) welded_from_input: Vec<u32>,
    /// The number of vertices that a tolerance moved.
    pub(crate) moved: usize,
    pub(crate) first_moved: Option<usize>,
}

impl Weld {
    /// The first input position of each of `count` welded vertices, or [`NONE`].
    pub(crate) fn first_inputs(&self, count: usize) -> Vec<u32> {
        let mut inputs = vec![NONE; count];
        for (input, &welded) in self.welded_from_input.iter().enumerate().rev() {
            // Unused positions have no welded vertex.
            if let Some(first) = inputs.get_mut(welded as usize) {
                *first = to_u32(input);
            }
        }
        inputs
    }
}

/// Welds used positions. A tolerance is in the units of `positions`.
pub(crate) fn weld(positions: &[[f32; 3]], is_used: &[bool], welding: Welding) -> Weld {
    let standing = match welding {
        Welding::Off => (0..to_u32(positions.len())).collect(),
        Welding::Exact => exact(positions, is_used),
        Welding::Within(tolerance) if tolerance <= 0.0 => exact(positions, is_used),
        Welding::Within(tolerance) => within(positions, is_used, tolerance),
    };
    number(positions, is_used, standing)
}

/// Numbers the representatives.
fn number(positions: &[[f32; 3]], is_used: &[bool], standing: Vec<u32>) -> Weld {
    let mut welded = Vec::with_capacity(positions.len());
    let mut moved = 0;
    let mut first_moved = None;
    let mut welded_from_input = standing;
    for input in 0..positions.len() {
        let stands = welded_from_input[input];
        welded_from_input[input] = if !is_used[input] {
            NONE
        } else if stands as usize == input {
            welded.push(positions[input]);
            to_u32(welded.len() - 1)
        } else {
            // Already numbered, because a representative comes first.
            let target = welded_from_input[stands as usize];
            if welded[target as usize] != positions[input] {
                moved += 1;
                first_moved = first_moved.or(Some(input));
            }
            target
        };
    }
    Weld { positions: welded, welded_from_input, moved, first_moved }
}

/// The bits of a position; adding 0 turns -0 into 0 and keeps every other number.
fn bits_of(position: [f32; 3]) -> [u32; 3] {
    position.map(|coordinate| (coordinate + 0.0).to_bits())
}

/// For each used vertex, the first vertex at the same position.
fn exact(positions: &[[f32; 3]], is_used: &[bool]) -> Vec<u32> {
    // A new seed in each run, so that no file can provoke collisions.
    let seed = RandomState::new().hash_one(0);
    let hashes: Vec<u32> = positions.par_iter().map(|&p| hash(bits_of(p), seed)).collect();
    let standing: Vec<AtomicU32> = (0..to_u32(positions.len())).map(AtomicU32::new).collect();
    let parts = to_u32(rayon::current_num_threads().clamp(1, 64));
    (0..parts).into_par_iter().for_each(|part| {
        let mine = |&vertex: &u32| {
            is_used[vertex as usize] && part_of(hashes[vertex as usize], parts) == part
        };
        let vertices = || (0..to_u32(positions.len())).filter(mine);
        let mut table = Table::new(vertices().count());
        for vertex in vertices() {
            let same = |&other: &u32| {
                bits_of(positions[other as usize]) == bits_of(positions[vertex as usize])
            };
            let first = table.find_or_insert(hashes[vertex as usize], vertex, same);
            standing[vertex as usize].store(first, Ordering::Relaxed);
        }
    });
    standing.into_iter().map(AtomicU32::into_inner).collect()
}

/// The thread of a hash, from its upper bits; the table uses the lower bits.
const fn part_of(hash: u32, parts: u32) -> u32 {
    ((hash >> 16) * parts) >> 16
}

/// Three rounds of multiply and fold.
#[expect(clippy::cast_possible_truncation, reason = "half of the product is what is wanted")]
fn hash(bits: [u32; 3], seed: u64) -> u32 {
    let fold = |state: u64, word: u32| {
        let product = (state ^ u64::from(word)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        product ^ (product >> 32)
    };
    let state = bits.into_iter().fold(seed, fold);
    (fold(state, 0x5bd1_e995) >> 16) as u32
}

/// A table of vertices with open addressing.
struct Table {
    slots: Vec<u32>,
}

impl Table {
    fn new(count: usize) -> Self {
        Self { slots: vec![NONE; (2 * count).next_power_of_two()] }
    }

    fn find_or_insert(&mut self, hash: u32, vertex: u32, same: impl Fn(&u32) -> bool) -> u32 {
        let mask = self.slots.len() - 1;
        let mut at = hash as usize & mask;
        loop {
            let slot = &mut self.slots[at];
            if *slot == NONE {
                *slot = vertex;
                return vertex;
            }
            if same(slot) {
                return *slot;
            }
            at = (at + 1) & mask;
        }
    }
}

/// For each used vertex, the nearest earlier representative within `tolerance`, or the vertex.
fn within(positions: &[[f32; 3]], is_used: &[bool], tolerance: f64) -> Vec<u32> {
    let cell_of = |point: Vec3| (point.as_dvec3() / tolerance).floor();
    let mut standing: Vec<u32> = (0..to_u32(positions.len())).collect();
    // The last representative of each cell, and the previous one in the cell.
    let mut last_in_cell: FxHashMap<[u64; 3], u32> = FxHashMap::default();
    let mut before = vec![NONE; positions.len()];
    for vertex in (0..positions.len()).filter(|&vertex| is_used[vertex]) {
        let point = Vec3::from(positions[vertex]);
        let cell = cell_of(point);
        let mut best = (tolerance * tolerance, NONE);
        for neighbor in 0..27_u32 {
            let step = [neighbor % 3, neighbor / 3 % 3, neighbor / 9].map(|s| f64::from(s) - 1.0);
            let key = (cell + glam::DVec3::from(step)).to_array().map(cell_key);
            let mut other = last_in_cell.get(&key).copied().unwrap_or(NONE);
            while other != NONE {
                let offset = Vec3::from(positions[other as usize]).as_dvec3() - point.as_dvec3();
                let found = (offset.length_squared(), other);
                if found < best || (found.0 <= best.0 && best.1 == NONE) {
                    best = found;
                }
                other = before[other as usize];
            }
        }
        if best.1 == NONE {
            let key = cell.to_array().map(cell_key);
            let last = last_in_cell.insert(key, to_u32(vertex));
            before[vertex] = last.unwrap_or(NONE);
        } else {
            standing[vertex] = best.1;
        }
    }
    standing
}

/// A whole number as a key; -0 is 0.
fn cell_key(cell: f64) -> u64 {
    (cell + 0.0).to_bits()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_numbers_are_one_vertex_in_the_files_order() {
        let positions =
            [[1., 0., 0.], [0., 0., 0.], [1., -0., 0.], [0., 1e-7, 0.], [f32::NAN, 0., 0.]];
        let used = [true, true, true, true, false];
        let welded = weld(&positions, &used, Welding::Exact);
        assert_eq!(welded.welded_from_input, [0, 1, 0, 2, NONE]);
        assert_eq!((welded.positions.len(), welded.moved), (3, 0));
        let kept = weld(&positions, &used, Welding::Off);
        assert_eq!(kept.welded_from_input, [0, 1, 2, 3, NONE]);
    }

    #[test]
    fn many_vertices_weld_as_one_by_one() {
        let mut seen = FxHashMap::default();
        let positions: Vec<[f32; 3]> =
            (0..5000_u16).map(|k| [f32::from(k % 37), f32::from(k % 11), -0.0]).collect();
        let expected: Vec<u32> = positions
            .iter()
            .map(|&p| {
                let next = to_u32(seen.len());
                *seen.entry(bits_of(p)).or_insert(next)
            })
            .collect();
        assert_eq!(weld(&positions, &[true; 5000], Welding::Exact).welded_from_input, expected);
    }

    #[test]
    fn a_tolerance_reaches_over_cells_and_does_not_drift() {
        let positions =
            [[0.99, 0., 0.], [1.01, 0., 0.], [1.05, 0., 0.], [1.1, 0., 0.], [5., 0., 0.]];
        let welded = weld(&positions, &[true; 5], Welding::Within(0.07));
        assert_eq!(welded.welded_from_input, [0, 0, 0, 1, 2]);
        assert_eq!((welded.positions.len(), welded.moved, welded.first_moved), (3, 2, Some(1)));
        let none = weld(&positions, &[true; 5], Welding::Within(0.0));
        assert_eq!(none.positions.len(), 5);
    }
}
