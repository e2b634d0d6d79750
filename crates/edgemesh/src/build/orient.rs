//! Makes the winding of every component consistent.
//!
//! Idea: walk from face to face over edges of exactly two faces; a face that
//! traverses the shared edge in the same direction as its neighbour is turned
//! relative to it. When all is walked, the minority of each component is
//! flipped, so that a model with one wrong face loses that one and keeps the
//! rest. An edge whose two faces still clash belongs to a surface that has no
//! two sides, like a Möbius strip; the surface is cut there.
//!
//! Rejected: turning components outwards by their signed volume. An open
//! surface has none, and a file that is consistent is left as it is.

use crate::index::to_u32;
use crate::topology::{EdgeTable, triangle_side};

/// What was found and done.
#[derive(Debug, Default)]
pub(crate) struct Orientation {
    /// Faces that were flipped in place.
    pub(crate) flipped: usize,
    /// Edges (indices of the table) whose faces clash whatever is flipped.
    pub(crate) clashes: Vec<u32>,
}

/// Flips triangles of `triangles` in place until their winding agrees across
/// every edge of two faces, where that is possible. A flip swaps corners 1 and
/// 2 and is told to `on_flip`.
pub(crate) fn orient(
    triangles: &mut [[u32; 3]],
    table: &EdgeTable,
    mut on_flip: impl FnMut(usize),
) -> Orientation {
    let neighbours = neighbours_over_edges(triangles, table);
    let mut is_turned = vec![None; triangles.len()];
    let mut patch = Vec::new();
    for seed in 0..triangles.len() {
        if is_turned[seed].is_some() {
            continue;
        }
        patch.clear();
        patch.push(seed);
        is_turned[seed] = Some(false);
        let mut next = 0;
        while let Some(&face) = patch.get(next) {
            next += 1;
            for &(neighbour, disagrees) in &neighbours[3 * face..3 * face + 3] {
                if let Some(neighbour) = neighbour
                    && is_turned[neighbour].is_none()
                {
                    is_turned[neighbour] = is_turned[face].map(|turned| turned != disagrees);
                    patch.push(neighbour);
                }
            }
        }
        let turned = patch.iter().filter(|&&face| is_turned[face] == Some(true)).count();
        if turned * 2 > patch.len() {
            for &face in &patch {
                is_turned[face] = is_turned[face].map(|turned| !turned);
            }
        }
    }
    let mut orientation = Orientation::default();
    for (face, turned) in is_turned.iter().enumerate() {
        if *turned == Some(true) {
            triangles[face].swap(1, 2);
            orientation.flipped += 1;
            on_flip(face);
        }
    }
    for (edge, (_, sides)) in table.iter().enumerate() {
        if let [a, b] = *sides {
            let disagrees = neighbours[a as usize].1;
            let turned_apart = is_turned[a as usize / 3] != is_turned[b as usize / 3];
            if disagrees != turned_apart {
                orientation.clashes.push(to_u32(edge));
            }
        }
    }
    orientation
}

/// For each side of each face: the face across, where the edge has exactly two,
/// and whether the two traverse the edge in the same direction.
fn neighbours_over_edges(triangles: &[[u32; 3]], table: &EdgeTable) -> Vec<(Option<usize>, bool)> {
    let mut neighbours = vec![(None, false); triangles.len() * 3];
    for (_, sides) in table.iter() {
        if let [a, b] = *sides {
            let disagrees = triangle_side(triangles, a) == triangle_side(triangles, b);
            neighbours[a as usize] = (Some(b as usize / 3), disagrees);
            neighbours[b as usize] = (Some(a as usize / 3), disagrees);
        }
    }
    neighbours
}

#[cfg(test)]
mod tests {
    use super::*;

    fn oriented(triangles: &[[u32; 3]], vertex_count: usize) -> (Vec<[u32; 3]>, Orientation) {
        let mut triangles = triangles.to_vec();
        let table = EdgeTable::from_triangles(vertex_count, &triangles);
        let orientation = orient(&mut triangles, &table, |_| ());
        (triangles, orientation)
    }

    #[test]
    fn the_minority_is_flipped() {
        // A tetrahedron whose last face is turned.
        let (triangles, orientation) = oriented(&[[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 2, 3]], 4);
        assert_eq!(orientation.flipped, 1);
        assert!(orientation.clashes.is_empty());
        assert_eq!(triangles[3], [0, 3, 2]);
    }

    #[test]
    fn what_agrees_is_left_alone() {
        let (_, orientation) = oriented(&[[0, 1, 2], [1, 3, 2]], 4);
        assert_eq!(orientation.flipped, 0);
    }

    #[test]
    fn a_moebius_strip_clashes_at_one_edge() {
        // Five quads around, joined with a half turn.
        let mut triangles = Vec::new();
        for step in 0..5_u32 {
            let (a, b) = (2 * step, 2 * step + 1);
            let (c, d) = if step == 4 { (1, 0) } else { (2 * step + 2, 2 * step + 3) };
            triangles.push([a, b, d]);
            triangles.push([a, d, c]);
        }
        let (triangles, orientation) = oriented(&triangles, 10);
        assert_eq!(orientation.clashes.len(), 1);
        assert_eq!(triangles.len(), 10);
    }
}
