//! Undirected edges and who uses them, in linear time.
//!
//! Idea: each face side is a directed pair of vertices. Two stable counting
//! sorts, by the larger vertex and then by the smaller, bring the sides of one
//! undirected edge together, in the order of their faces. No hash map, so the
//! edges come out sorted by (min, max) whatever the machine.
//!
//! Rejected: a hash map of pairs, whose order must be mended afterwards; a
//! half-edge structure, which refuses edges of three faces.
//!
//! ```text
//!   sides   (2,0) (0,1) (1,2) (1,0) ...
//!   edges   {0,1}: sides 1, 3    {0,2}: side 0    {1,2}: side 2
//! ```

use crate::index::to_u32;

/// All undirected edges of some faces, with the sides that use each.
#[derive(Debug, Clone)]
pub struct EdgeTable {
    /// The vertices of each edge, smaller first; sorted.
    edges: Vec<[u32; 2]>,
    /// Where each edge's sides begin in `sides`; one entry more than edges.
    first_side: Vec<u32>,
    /// Side indices, edge by edge, ascending within an edge.
    sides: Vec<u32>,
}

impl EdgeTable {
    /// Builds the table from directed sides; a side whose ends are the same
    /// vertex belongs to no edge.
    ///
    /// All vertices must be below `vertex_count`.
    #[must_use]
    pub fn from_sides(vertex_count: usize, sides: &[[u32; 2]]) -> Self {
        let proper: Vec<u32> = (0..to_u32(sides.len()))
            .filter(|&side| sides[side as usize][0] != sides[side as usize][1])
            .collect();
        let larger = |side: u32| sides[side as usize][0].max(sides[side as usize][1]);
        let smaller = |side: u32| sides[side as usize][0].min(sides[side as usize][1]);
        let by_larger = counting_sort(vertex_count, &proper, larger);
        let sorted = counting_sort(vertex_count, &by_larger, smaller);

        let mut edges: Vec<[u32; 2]> = Vec::with_capacity(sorted.len() / 2);
        let mut first_side = Vec::with_capacity(sorted.len() / 2 + 1);
        for (place, &side) in sorted.iter().enumerate() {
            let ends = [smaller(side), larger(side)];
            if edges.last() != Some(&ends) {
                edges.push(ends);
                first_side.push(to_u32(place));
            }
        }
        first_side.push(to_u32(sorted.len()));
        Self { edges, first_side, sides: sorted }
    }

    /// Builds the table of a triangle mesh: side `3 f + k` of the table runs
    /// from corner k to corner k+1 of triangle f.
    #[must_use]
    pub fn from_triangles(vertex_count: usize, triangles: &[[u32; 3]]) -> Self {
        let sides: Vec<[u32; 2]> =
            triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
        Self::from_sides(vertex_count, &sides)
    }

    /// How many undirected edges there are.
    #[must_use]
    pub const fn edge_count(&self) -> usize {
        self.edges.len()
    }

    /// Each edge's vertices, smaller first, with its sides, ascending.
    pub fn iter(&self) -> impl Iterator<Item = ([u32; 2], &[u32])> {
        self.edges
            .iter()
            .zip(self.first_side.windows(2))
            .map(|(&ends, range)| (ends, &self.sides[range[0] as usize..range[1] as usize]))
    }
}

/// Sorts `items` stably by a key below `key_count`.
fn counting_sort(key_count: usize, items: &[u32], key: impl Fn(u32) -> u32) -> Vec<u32> {
    let mut next = vec![0_u32; key_count + 1];
    for &item in items {
        next[key(item) as usize + 1] += 1;
    }
    for slot in 1..next.len() {
        next[slot] += next[slot - 1];
    }
    let mut sorted = vec![0; items.len()];
    for &item in items {
        let place = &mut next[key(item) as usize];
        sorted[*place as usize] = item;
        *place += 1;
    }
    sorted
}

/// Counts of a face set's edges, before anything is repaired.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct EdgeCounts {
    /// Undirected edges.
    pub edges: usize,
    /// Edges with one face.
    pub boundary: usize,
    /// Edges with more than two faces.
    pub non_manifold: usize,
    /// Edges that their two faces traverse in the same direction.
    pub inconsistent: usize,
}

impl EdgeCounts {
    /// Counts the edges of `table`, whose sides are `sides`.
    #[must_use]
    pub fn of(table: &EdgeTable, sides: impl Fn(u32) -> [u32; 2]) -> Self {
        let mut counts = Self { edges: table.edge_count(), ..Self::default() };
        for (_, users) in table.iter() {
            match *users {
                [_] => counts.boundary += 1,
                [a, b] => counts.inconsistent += usize::from(sides(a)[0] == sides(b)[0]),
                _ => counts.non_manifold += 1,
            }
        }
        counts
    }
}

/// The directed side `side` of a triangle list, as [`EdgeTable::from_triangles`]
/// numbers them.
#[must_use]
pub fn triangle_side(triangles: &[[u32; 3]], side: u32) -> [u32; 2] {
    let triangle = triangles[side as usize / 3];
    let corner = side as usize % 3;
    [triangle[corner], triangle[(corner + 1) % 3]]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ```text
    ///   2---3      triangles (0,1,2) and (1,3,2)
    ///   |\  |
    ///   | \ |
    ///   0---1
    /// ```
    #[test]
    fn two_triangles_have_five_edges() {
        let table = EdgeTable::from_triangles(4, &[[0, 1, 2], [1, 3, 2]]);
        let all: Vec<_> = table.iter().map(|(ends, sides)| (ends, sides.to_vec())).collect();
        assert_eq!(
            all,
            [
                ([0, 1], vec![0]),
                ([0, 2], vec![2]),
                ([1, 2], vec![1, 5]),
                ([1, 3], vec![3]),
                ([2, 3], vec![4]),
            ]
        );
    }

    #[test]
    fn counts_tell_apart_what_is_wrong() {
        let triangles = [[0, 1, 2], [0, 1, 3], [4, 5, 6], [4, 5, 7], [5, 4, 8]];
        let table = EdgeTable::from_triangles(9, &triangles);
        let counts = EdgeCounts::of(&table, |side| triangle_side(&triangles, side));
        assert_eq!(
            counts,
            EdgeCounts { edges: 12, boundary: 10, non_manifold: 1, inconsistent: 1 }
        );
    }

    #[test]
    fn a_side_of_one_vertex_is_no_edge() {
        assert_eq!(EdgeTable::from_sides(2, &[[1, 1], [0, 1]]).edge_count(), 1);
    }
}
