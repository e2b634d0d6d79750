//! Which edge follows which: the half-edges for walks from contour to contour, and the chains of
//! the preprocessor, in twelve bytes per edge.
//!
//! A record is two half-edges, one along face A and one along face B, numbered `2 edge` and
//! `2 edge + 1`. Each names the next half-edge around its face; the other number of its pair is
//! the half-edge across. So a shader turns through the fan of a vertex without reading faces,
//! vertices or positions.
//!
//! ```text
//!         w          2e:      v0 to v1 along face A
//!       /   \        2e + 1:  v1 to v0 along face B
//!      / A   \
//!    v0 --e-- v1     next of 2e is the half-edge of A from v1 to w
//!      \ B   /
//! ```
//!
//! A chunk has the pairs of its own records, followed by those that the fans around its vertices
//! cross, so that no walk leaves it. Run states of all chunks are one buffer
//! (`view/live_lists.rs`), so a walk knows of each edge whether it is a contour.
//!
//! WGSL twin: `shaders/graph/link_elements.wgsl`. Rejected: faces with their three records,
//! which also need the facing bits and planes of all faces around a chunk.

use std::ops::Range;

use edgemesh::edge_mesh::{EdgeFlags, EdgeMesh, FaceEdges, StaticLinks};
use edgemesh::index::{NONE, to_u32};

/// The walk ends at the end of the surface. WGSL twin: the constant of this name.
pub const SURFACE_END: u32 = NONE;

/// The walk ends where the surface has not two consistent sides. WGSL twin: the constant of this
/// name.
pub const SURFACE_CUT: u32 = NONE - 1;

/// Bit of a static link: the chain runs from the record's `v1` to its `v0`. WGSL twin: the
/// constant of this name.
pub const REVERSED: u32 = 1 << 31;

/// Bits of the edge in a static link; all ones if no edge follows.
const EDGE_MASK: u32 = (1 << 29) - 1;

/// Flags of edges that walks do not cross.
const CUTS: EdgeFlags = EdgeFlags::CLASH.union(EdgeFlags::NON_MANIFOLD);

/// The next half-edges of a record's two sides, and the edge that follows in the preprocessor's
/// chain, with [`REVERSED`]; for records of other chunks the third is their index in the mesh.
pub(crate) type LinkWords = [u32; 3];

/// The links of all edges of a mesh.
pub(crate) struct LinkTable(Vec<LinkWords>);

impl LinkTable {
    pub(crate) fn of(mesh: &EdgeMesh) -> Self {
        let faces = FaceEdges::of(mesh);
        let chains = StaticLinks::of(mesh);
        let links = mesh.records.iter().enumerate().map(|(edge, record)| {
            let [next_a, next_b] = [record.face_a, record.face_b]
                .map(|face| next_half_edge(mesh, &faces, to_u32(edge), face));
            let reversed = if chains.is_reversed[edge] { REVERSED } else { 0 };
            [next_a, next_b, (chains.next[edge] & EDGE_MASK) | reversed]
        });
        Self(links.collect())
    }

    /// The links of a chunk with the records `edges`.
    pub(crate) fn chunk(&self, edges: &Range<usize>) -> Vec<LinkWords> {
        if *edges == (0..self.0.len()) {
            return self.0.clone();
        }
        let mut local = LocalEdges { first: edges.start, own: edges.len(), others: Vec::new() };
        let mut place = std::collections::HashMap::new();
        for half_edge in 2 * edges.start..2 * edges.end {
            self.collect_fan(to_u32(half_edge), &mut local, &mut place);
        }
        let renumber = |half_edge: u32| match half_edge {
            SURFACE_END | SURFACE_CUT => half_edge,
            // No walk over this chunk reaches it.
            _ => {
                local.place(half_edge / 2, &place).map_or(SURFACE_CUT, |at| 2 * at + half_edge % 2)
            }
        };
        let own = self.0[edges.clone()]
            .iter()
            .map(|&[next_a, next_b, chain]| [renumber(next_a), renumber(next_b), chain]);
        let others = local.others.iter().map(|&edge| {
            let [next_a, next_b, _] = self.0[edge as usize];
            [renumber(next_a), renumber(next_b), edge]
        });
        own.chain(others).collect()
    }

    /// Adds the edges of other chunks that a walk from `half_edge` turns across.
    fn collect_fan(
        &self,
        half_edge: u32,
        local: &mut LocalEdges,
        place: &mut std::collections::HashMap<u32, u32>,
    ) {
        let mut at = half_edge;
        loop {
            at = self.0[at as usize / 2][at as usize % 2];
            if at >= SURFACE_CUT {
                return;
            }
            let edge = at / 2;
            if !local.is_own(edge) && !place.contains_key(&edge) {
                place.insert(edge, to_u32(local.own + local.others.len()));
                local.others.push(edge);
            }
            at ^= 1;
            if at == half_edge || at == half_edge ^ 1 {
                return;
            }
        }
    }
}

/// The edges of a chunk, and those around them.
struct LocalEdges {
    first: usize,
    own: usize,
    others: Vec<u32>,
}

impl LocalEdges {
    const fn is_own(&self, edge: u32) -> bool {
        let edge = edge as usize;
        self.first <= edge && edge < self.first + self.own
    }

    fn place(&self, edge: u32, place: &std::collections::HashMap<u32, u32>) -> Option<u32> {
        if self.is_own(edge) {
            return Some(edge - to_u32(self.first));
        }
        place.get(&edge).copied()
    }
}

/// The half-edge that follows `edge` around `face`.
fn next_half_edge(mesh: &EdgeMesh, faces: &FaceEdges, edge: u32, face: u32) -> u32 {
    if face == NONE {
        return SURFACE_END;
    }
    if mesh.records[edge as usize].flags().intersects(CUTS) {
        return SURFACE_CUT;
    }
    let sides = faces.sides(face);
    let Some(side) = sides.iter().position(|side| *side == edge) else { return SURFACE_CUT };
    let next = sides[(side + 1) % 3];
    let Some(record) = mesh.records.get(next as usize) else { return SURFACE_CUT };
    if record.flags().intersects(CUTS) {
        return SURFACE_CUT;
    }
    2 * next + u32::from(record.face_a != face)
}

#[cfg(test)]
mod tests {
    use edgemesh::build::{BuildOptions, build_edge_mesh};
    use edgemesh::model::Model;
    use edgemesh::report::Report;

    use super::*;

    fn mesh(polygons: &[&[u32]]) -> EdgeMesh {
        let corners = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.], [1., 1., 1.]];
        let model = Model::from_polygons(&corners, polygons);
        build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default())
    }

    /// Where a half-edge begins and ends.
    fn ends(mesh: &EdgeMesh, half_edge: u32) -> [u32; 2] {
        let record = &mesh.records[half_edge as usize / 2];
        if half_edge.is_multiple_of(2) { [record.v0, record.v1] } else { [record.v1, record.v0] }
    }

    #[test]
    fn half_edges_go_around_their_faces() {
        let closed: [&[u32]; 4] = [&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]];
        let mesh = mesh(&closed);
        let table = LinkTable::of(&mesh);
        for half_edge in 0..2 * to_u32(mesh.records.len()) {
            let next = |at: u32| table.0[at as usize / 2][at as usize % 2];
            assert_eq!(ends(&mesh, half_edge)[1], ends(&mesh, next(half_edge))[0]);
            assert_eq!(next(next(next(half_edge))), half_edge, "three sides");
        }
    }

    #[test]
    fn walks_end_with_the_surface() {
        let mesh = mesh(&[&[0, 1, 2]]);
        let table = LinkTable::of(&mesh);
        for [inside, outside, _] in table.0 {
            assert!(inside < SURFACE_CUT && outside == SURFACE_END);
        }
    }

    #[test]
    fn three_faces_on_an_edge_cut() {
        let mesh = mesh(&[&[0, 1, 2], &[1, 0, 3], &[0, 1, 4]]);
        let table = LinkTable::of(&mesh);
        let is_cut = |edge: u32| mesh.records[edge as usize].flags().intersects(CUTS);
        let cuts = (0..to_u32(mesh.records.len())).filter(|&edge| is_cut(edge)).count();
        assert!(cuts > 0, "an edge of three faces");
        for (edge, [next_a, ..]) in (0..).zip(&table.0) {
            // From the edge itself no walk starts, and none leads over it.
            let leads_on = *next_a < SURFACE_CUT;
            assert!(!(leads_on && (is_cut(edge) || is_cut(*next_a / 2))), "edge {edge}");
        }
        let ends = table.0.iter().filter(|[next_a, ..]| *next_a == SURFACE_CUT).count();
        assert!(ends > cuts, "{ends} half-edges end at {cuts} records");
    }

    #[test]
    fn walks_over_a_chunk_are_those_over_the_mesh() {
        let closed: [&[u32]; 4] = [&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]];
        let mesh = mesh(&closed);
        let table = LinkTable::of(&mesh);
        let edges = 1..3;
        let chunk = table.chunk(&edges);
        let global = |local: u32| {
            if local < 2 { local + 1 } else { chunk[local as usize][2] }
        };
        for half_edge in 2..6_u32 {
            let (mut whole, mut part) = (half_edge, half_edge - 2);
            for _ in 0..3 {
                whole = table.0[whole as usize / 2][whole as usize % 2];
                part = chunk[part as usize / 2][part as usize % 2];
                assert_eq!(2 * global(part / 2) + part % 2, whole);
                (whole, part) = (whole ^ 1, part ^ 1);
            }
        }
    }
}
