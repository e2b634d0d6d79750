//! Makes the winding of every component consistent.
//!
//! Idea: walk from face to face across edges of exactly two faces. A face that traverses the shared
//! edge in the same direction as its neighbor is turned relative to it. At the end the minority of
//! each component is flipped, so that one wrong face does not flip all others. An edge whose faces
//! still clash belongs to a surface that cannot be oriented, such as a Möbius strip; the surface is
//! cut there.
//!
//! Rejected: turning components outward by signed volume. Open surfaces have none, and consistent
//! files should not change.

use crate::edge_mesh::{EdgeTable, triangle_side};
use crate::index::{NONE, to_u32};

/// The result of [`orient`].
#[derive(Debug, Default)]
pub(crate) struct Orientation {
    /// Flipped faces, ascending.
    pub(crate) flipped: Vec<usize>,
    /// Edges (numbers of the table) whose faces clash in any case, ascending.
    pub(crate) clashes: Vec<u32>,
}

/// Flips triangles in place so that their winding agrees across every edge of two faces, if
/// possible. A flip swaps corners 1 and 2.
pub(crate) fn orient(triangles: &mut [[u32; 3]], table: &EdgeTable) -> Orientation {
    let neighbors = neighbors_over_edges(triangles, table);
    let is_turned = turn_the_minority(&neighbors);
    let mut orientation = Orientation::default();
    for (edge, (_, sides)) in table.iter().enumerate() {
        if let [a, b] = *sides {
            let disagrees = neighbors[a as usize].disagrees;
            let turned_apart = is_turned[a as usize / 3] != is_turned[b as usize / 3];
            if disagrees != turned_apart {
                orientation.clashes.push(to_u32(edge));
            }
        }
    }
    for (face, _) in is_turned.iter().enumerate().filter(|(_, turned)| **turned) {
        triangles[face].swap(1, 2);
        orientation.flipped.push(face);
    }
    orientation
}

/// Walks over each component and decides for each face whether it is turned; turns the smaller
/// number of faces.
fn turn_the_minority(neighbors: &[Neighbor]) -> Vec<bool> {
    let face_count = neighbors.len() / 3;
    let mut is_turned = vec![false; face_count];
    let mut is_seen = vec![false; face_count];
    let mut patch = Vec::new();
    for seed in 0..face_count {
        if std::mem::replace(&mut is_seen[seed], true) {
            continue;
        }
        patch.clear();
        patch.push(seed);
        let mut next = 0;
        while let Some(&face) = patch.get(next) {
            next += 1;
            for neighbor in neighbors[3 * face..3 * face + 3].iter().filter(|n| n.face != NONE) {
                let other = neighbor.face as usize;
                if !std::mem::replace(&mut is_seen[other], true) {
                    is_turned[other] = is_turned[face] != neighbor.disagrees;
                    patch.push(other);
                }
            }
        }
        let turned = patch.iter().filter(|&&face| is_turned[face]).count();
        if turned * 2 > patch.len() {
            for &face in &patch {
                is_turned[face] = !is_turned[face];
            }
        }
    }
    is_turned
}

/// The face across a side, if the edge has exactly two faces.
#[derive(Debug, Clone, Copy)]
struct Neighbor {
    /// The face, or [`NONE`].
    face: u32,
    /// Whether both faces traverse the edge in the same direction.
    disagrees: bool,
}

fn neighbors_over_edges(triangles: &[[u32; 3]], table: &EdgeTable) -> Vec<Neighbor> {
    let mut neighbors = vec![Neighbor { face: NONE, disagrees: false }; triangles.len() * 3];
    for (_, sides) in table.iter() {
        if let [a, b] = *sides {
            let disagrees = triangle_side(triangles, a) == triangle_side(triangles, b);
            neighbors[a as usize] = Neighbor { face: b / 3, disagrees };
            neighbors[b as usize] = Neighbor { face: a / 3, disagrees };
        }
    }
    neighbors
}

#[cfg(test)]
mod tests {
    use super::*;

    fn oriented(triangles: &[[u32; 3]], vertex_count: usize) -> (Vec<[u32; 3]>, Orientation) {
        let mut triangles = triangles.to_vec();
        let table = EdgeTable::from_triangles(vertex_count, &triangles);
        let orientation = orient(&mut triangles, &table);
        (triangles, orientation)
    }

    #[test]
    fn the_minority_is_flipped() {
        // A tetrahedron whose last face is turned.
        let (triangles, orientation) = oriented(&[[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 2, 3]], 4);
        assert_eq!(orientation.flipped, [3]);
        assert!(orientation.clashes.is_empty());
        assert_eq!(triangles[3], [0, 3, 2]);
    }

    #[test]
    fn what_agrees_is_left_alone() {
        let (_, orientation) = oriented(&[[0, 1, 2], [1, 3, 2]], 4);
        assert!(orientation.flipped.is_empty());
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
