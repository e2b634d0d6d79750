//! Finds triangles with the same vertices in the same cyclic order as an earlier triangle. A
//! reversed triangle is not a duplicate: it may be the back of a two-sided sheet.
//!
//! Idea: two such triangles traverse each of their edges in the same direction, which no edge of a
//! sound mesh has. So only faces of such edges are compared, and a sound mesh costs nothing.
//!
//! Rejected: a hash set of all triangles, which takes longer than finding the edges.

use crate::edge_mesh::{EdgeTable, triangle_side};

/// Whether to keep each face; `None` if no face repeats another.
pub(crate) fn keep_first_of_each(triangles: &[[u32; 3]], table: &EdgeTable) -> Option<Vec<bool>> {
    let mut suspects = suspects(triangles, table);
    suspects.sort_unstable();
    suspects.dedup();
    let mut keyed: Vec<([u32; 3], u32)> =
        suspects.into_iter().map(|face| (cyclic(triangles[face as usize]), face)).collect();
    keyed.sort_unstable();
    let mut is_kept = None;
    for pair in keyed.windows(2) {
        if pair[0].0 == pair[1].0 {
            is_kept.get_or_insert_with(|| vec![true; triangles.len()])[pair[1].1 as usize] = false;
        }
    }
    is_kept
}

/// Faces of edges that two faces traverse in the same direction.
fn suspects(triangles: &[[u32; 3]], table: &EdgeTable) -> Vec<u32> {
    let mut suspects = Vec::new();
    for (ends, sides) in table.iter().filter(|(_, sides)| sides.len() > 1) {
        let upwards = sides.iter().filter(|&&side| triangle_side(triangles, side) == ends).count();
        if upwards > 1 || sides.len() - upwards > 1 {
            suspects.extend(sides.iter().map(|side| side / 3));
        }
    }
    suspects
}

/// The triangle with its smallest vertex first.
fn cyclic([a, b, c]: [u32; 3]) -> [u32; 3] {
    match a.min(b).min(c) {
        smallest if smallest == a => [a, b, c],
        smallest if smallest == b => [b, c, a],
        _ => [c, a, b],
    }
}

/// The faces that are not kept, ascending.
pub(crate) fn left_out(is_kept: &[bool]) -> impl Iterator<Item = usize> {
    (0..is_kept.len()).filter(|&face| !is_kept[face])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dropped(triangles: &[[u32; 3]]) -> Vec<usize> {
        let table = EdgeTable::from_triangles(9, triangles);
        let is_kept = keep_first_of_each(triangles, &table);
        is_kept.map_or_else(Vec::new, |is_kept| left_out(&is_kept).collect())
    }

    #[test]
    fn the_first_of_equal_faces_stays() {
        assert_eq!(dropped(&[[0, 1, 2], [1, 3, 2], [2, 0, 1], [1, 2, 0], [3, 2, 1]]), [2, 3, 4]);
    }

    #[test]
    fn a_reversed_twin_and_a_turned_neighbor_stay() {
        assert!(dropped(&[[0, 1, 2], [0, 2, 1], [1, 2, 3]]).is_empty());
        assert!(dropped(&[[0, 1, 2], [5, 6, 7]]).is_empty());
    }
}
