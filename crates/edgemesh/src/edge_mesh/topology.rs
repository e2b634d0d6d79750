//! Finds the undirected edges of faces and the sides of each edge, in linear time and in parallel.
//!
//! Idea: a side of a face is a directed pair of vertices. A counting sort groups the sides by their
//! smaller vertex; each small group is sorted by larger vertex and by side. Each thread has a range
//! of smaller vertices, so that threads share nothing. The edges are sorted by (min, max), and the
//! sides of an edge by their faces, for any number of threads.
//!
//! Rejected: a hash map of pairs, which needs sorting afterward; a half-edge structure, which
//! cannot store edges of three faces; two counting sorts over all sides, which access memory twice
//! as often.
//!
//! ```text
//!   sides   (2,0) (0,1) (1,2) (1,0) ...
//!   by min  0: (0,1)1 (1,0)3 (2,0)0      1: (1,2)2 ...
//!   edges   {0,1}: sides 1, 3    {0,2}: side 0    {1,2}: side 2
//! ```

use std::ops::Range;

use rayon::prelude::*;

use crate::index::to_u32;

/// The undirected edges of faces, with the sides on each edge.
#[derive(Debug, Clone)]
pub struct EdgeTable {
    /// Parts, ascending by smaller vertex.
    parts: Vec<EdgePart>,
    /// The number of the first edge of each part, and at the end the number of edges.
    first_edges: Vec<usize>,
}

/// The edges of a range of smaller vertices.
#[derive(Debug, Clone, Default)]
pub(crate) struct EdgePart {
    /// The vertices of each edge, smaller first; sorted.
    edges: Vec<[u32; 2]>,
    /// The start of each edge in `sides`, and at the end the number of sides.
    first_side: Vec<u32>,
    /// Side indices, edge by edge, ascending within an edge.
    sides: Vec<u32>,
}

impl EdgePart {
    /// The vertices of each edge, smaller first, with its sides, ascending.
    pub(crate) fn iter(&self) -> impl Iterator<Item = ([u32; 2], &[u32])> {
        self.edges
            .iter()
            .zip(self.first_side.windows(2))
            .map(|(&ends, range)| (ends, &self.sides[range[0] as usize..range[1] as usize]))
    }

    pub(crate) const fn edge_count(&self) -> usize {
        self.edges.len()
    }
}

impl EdgeTable {
    /// Builds the table of directed sides with vertices below `vertex_count`; a side with equal
    /// ends has no edge.
    #[must_use]
    pub(crate) fn from_sides(vertex_count: usize, sides: &[[u32; 2]]) -> Self {
        Self::build(vertex_count, &sides)
    }

    /// Builds the table of a triangle mesh: side `3 f + k` runs from corner k to corner k+1 of
    /// triangle f.
    ///
    /// # Panics
    /// May panic, or leave out sides, if a vertex is not below `vertex_count`.
    #[must_use]
    pub fn from_triangles(vertex_count: usize, triangles: &[[u32; 3]]) -> Self {
        Self::build(vertex_count, &TriangleSides(triangles))
    }

    fn build(vertex_count: usize, sides: &impl Sides) -> Self {
        let ranges = even_ranges(vertex_count, sides);
        let parts: Vec<EdgePart> =
            ranges.into_par_iter().map(|range| edges_of(range, sides)).collect();
        let mut first_edges = vec![0];
        for part in &parts {
            first_edges.push(first_edges[first_edges.len() - 1] + part.edge_count());
        }
        Self { parts, first_edges }
    }

    /// The number of undirected edges.
    #[must_use]
    pub fn edge_count(&self) -> usize {
        self.first_edges.last().copied().unwrap_or_default()
    }

    /// The vertices of each edge, smaller first, with its sides, ascending.
    pub fn iter(&self) -> impl Iterator<Item = ([u32; 2], &[u32])> {
        self.parts.iter().flat_map(EdgePart::iter)
    }

    /// The parts, each with the number of its first edge.
    pub(crate) fn parts(&self) -> impl IndexedParallelIterator<Item = (usize, &EdgePart)> {
        self.parts.par_iter().enumerate().map(|(part, edges)| (self.first_edges[part], edges))
    }

    /// The sides of an edge, by its number.
    pub(crate) fn sides(&self, edge: usize) -> &[u32] {
        let part = self.first_edges.partition_point(|&first| first <= edge) - 1;
        let at = edge - self.first_edges[part];
        let EdgePart { first_side, sides, .. } = &self.parts[part];
        &sides[first_side[at] as usize..first_side[at + 1] as usize]
    }

    /// The number of the edge between two vertices.
    pub(crate) fn find(&self, a: u32, b: u32) -> Option<usize> {
        let ends = [a.min(b), a.max(b)];
        let behind = |part: &EdgePart| part.edges.last().is_none_or(|last| *last < ends);
        let part = self.parts.partition_point(behind);
        let at = self.parts.get(part)?.edges.binary_search(&ends).ok()?;
        Some(self.first_edges[part] + at)
    }
}

/// Directed sides with numbers.
trait Sides: Sync {
    fn count(&self) -> usize;

    /// Calls `visit` with the number, start and end of about every `step`-th side.
    fn each(&self, step: usize, visit: impl FnMut(usize, u32, u32));
}

impl Sides for &[[u32; 2]] {
    fn count(&self) -> usize {
        self.len()
    }

    fn each(&self, step: usize, mut visit: impl FnMut(usize, u32, u32)) {
        for (side, &[a, b]) in self.iter().enumerate().step_by(step) {
            visit(side, a, b);
        }
    }
}

/// The sides of triangles: side 3 f + k runs from corner k to the next corner.
struct TriangleSides<'a>(&'a [[u32; 3]]);

impl Sides for TriangleSides<'_> {
    fn count(&self) -> usize {
        3 * self.0.len()
    }

    /// Visits whole triangles, which saves a division for each side.
    fn each(&self, step: usize, mut visit: impl FnMut(usize, u32, u32)) {
        for (face, &[a, b, c]) in self.0.iter().enumerate().step_by(step.div_ceil(3)) {
            visit(3 * face, a, b);
            visit(3 * face + 1, b, c);
            visit(3 * face + 2, c, a);
        }
    }
}

/// Cuts the vertices into a range for each thread, with about the same number of sides, estimated
/// from a sample.
fn even_ranges(vertex_count: usize, sides: &impl Sides) -> Vec<Range<u32>> {
    const CELLS: usize = 1024;
    const SAMPLES: usize = 1 << 16;
    let threads = rayon::current_num_threads();
    if threads == 1 || sides.count() < SAMPLES {
        return std::iter::once(0..to_u32(vertex_count)).collect();
    }
    let cell = vertex_count.div_ceil(CELLS).max(1);
    let mut counts = [0_usize; CELLS];
    let mut samples = 0;
    sides.each(sides.count() / SAMPLES, |_, a, b| {
        counts[a.min(b) as usize / cell] += 1;
        samples += 1;
    });
    let mut ends = Vec::with_capacity(threads);
    let mut sum = 0;
    for (index, count) in counts.iter().enumerate() {
        sum += count;
        if sum * threads >= (ends.len() + 1) * samples {
            ends.push(vertex_count.min((index + 1) * cell));
        }
    }
    let mut start = 0;
    let mut ranges = Vec::with_capacity(threads);
    for end in ends.into_iter().chain([vertex_count]) {
        if end > start {
            ranges.push(to_u32(start)..to_u32(end));
            start = end;
        }
    }
    ranges
}

/// The edges whose smaller vertex is within `range`.
fn edges_of(range: Range<u32>, sides: &impl Sides) -> EdgePart {
    let vertex_count = range.len();
    // Vertices below the range wrap around to large numbers.
    let own = |a: u32, b: u32| a.min(b).wrapping_sub(range.start) as usize;
    let mut next = vec![0_u32; vertex_count + 1];
    sides.each(1, |_, a, b| {
        let vertex = own(a, b);
        if vertex < vertex_count && a != b {
            next[vertex + 1] += 1;
        }
    });
    for slot in 1..next.len() {
        next[slot] += next[slot - 1];
    }
    // The larger vertex in the upper half, the side in the lower: one sort orders by both.
    let mut keys = vec![0_u64; next[vertex_count] as usize];
    sides.each(1, |side, a, b| {
        let vertex = own(a, b);
        if vertex < vertex_count && a != b {
            let place = &mut next[vertex];
            keys[*place as usize] = u64::from(a.max(b)) << 32 | side as u64;
            *place += 1;
        }
    });
    // `next` now has the end of each vertex, which is the start of the next vertex.
    let mut part = EdgePart {
        edges: Vec::with_capacity(keys.len() / 2 + 1),
        first_side: Vec::with_capacity(keys.len() / 2 + 2),
        sides: Vec::with_capacity(keys.len()),
    };
    let mut start = 0;
    for (smaller, &end) in range.zip(&next) {
        let bucket = &mut keys[start..end as usize];
        bucket.sort_unstable();
        part.push_bucket(smaller, bucket);
        start = end as usize;
    }
    part.first_side.push(to_u32(part.sides.len()));
    part
}

impl EdgePart {
    /// Adds the edges of a smaller vertex from its sorted keys.
    fn push_bucket(&mut self, smaller: u32, keys: &[u64]) {
        let mut last = None;
        for &key in keys {
            let larger = (key >> 32) as u32;
            if last != Some(larger) {
                last = Some(larger);
                self.edges.push([smaller, larger]);
                self.first_side.push(to_u32(self.sides.len()));
            }
            #[expect(clippy::cast_possible_truncation, reason = "the lower half is the side")]
            self.sides.push(key as u32);
        }
    }
}

/// Counts of edges before repairs.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct EdgeCounts {
    /// Undirected edges.
    pub edges: usize,
    /// Edges with one face.
    pub boundary: usize,
    /// Edges with more than two faces.
    pub non_manifold: usize,
    /// Edges whose two faces traverse them in the same direction.
    pub inconsistent: usize,
}

impl EdgeCounts {
    /// Counts the edges of `table`; `sides` returns the vertices of a side.
    #[must_use]
    pub(crate) fn of(table: &EdgeTable, sides: impl Fn(u32) -> [u32; 2] + Sync) -> Self {
        let of_part = |(_, part): (usize, &EdgePart)| {
            let mut counts = Self { edges: part.edge_count(), ..Self::default() };
            for (_, users) in part.iter() {
                match *users {
                    [_] => counts.boundary += 1,
                    [a, b] => counts.inconsistent += usize::from(sides(a)[0] == sides(b)[0]),
                    _ => counts.non_manifold += 1,
                }
            }
            counts
        };
        table.parts().map(of_part).reduce(Self::default, |a, b| a + b)
    }
}

impl std::ops::Add for EdgeCounts {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            edges: self.edges + other.edges,
            boundary: self.boundary + other.boundary,
            non_manifold: self.non_manifold + other.non_manifold,
            inconsistent: self.inconsistent + other.inconsistent,
        }
    }
}

/// The vertices of a side, as [`EdgeTable::from_triangles`] numbers sides.
#[must_use]
pub(crate) fn triangle_side(triangles: &[[u32; 3]], side: u32) -> [u32; 2] {
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

    #[test]
    fn edges_are_found_by_their_ends() {
        let table = EdgeTable::from_triangles(4, &[[0, 1, 2], [1, 3, 2]]);
        assert_eq!(
            (table.find(2, 1), table.find(3, 2), table.find(0, 3)),
            (Some(2), Some(4), None)
        );
        assert_eq!(table.sides(2), [1, 5]);
        assert_eq!(table.find(7, 9), None);
    }

    #[test]
    fn the_number_of_threads_makes_no_difference() {
        // A sheet, large enough to be cut, with its vertices shuffled.
        let at = |x: u32, y: u32| (x + 200 * y) * 7919 % 40_000;
        let triangles: Vec<[u32; 3]> = (0..199 * 199)
            .flat_map(|k| {
                let (x, y) = (k % 199, k / 199);
                let [a, b, c, d] = [at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)];
                [[a, b, c], [b, d, c]]
            })
            .collect();
        let with_threads = |count| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap();
            let table = pool.install(|| EdgeTable::from_triangles(40_000, &triangles));
            table.iter().map(|(ends, sides)| (ends, sides.to_vec())).collect::<Vec<_>>()
        };
        let one = with_threads(1);
        assert_eq!(one.len(), 199 * 200 * 2 + 199 * 199);
        for count in [2, 3, 8] {
            assert_eq!(with_threads(count), one, "{count} threads");
        }
    }
}
