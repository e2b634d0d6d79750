//! Links the contours of a view into chains, edge to edge, each in exactly one.
//!
//! Idea: a contour has its front face on the left. At its end the surface is a fan
//! of faces; turning through the front ones, from this contour's own, the first
//! contour met is the next of the chain. That one is found from no other, so links
//! are one to one whatever the number of contours at a vertex; and the outside is
//! on the same side all along. A chain ends only where the surface does.
//!
//! ```text
//!        \ front /             c: the contour that arrives
//!     e1  \     /  e2          e1: the first edge on the way around, no contour
//!          \   /               e2: the next one, a contour: c goes on with it
//!   front   \ /   back
//!  ----c---->o
//!   back
//! ```
//!
//! Where the winding of two faces clashes, or an edge has more than two faces,
//! there is no left and right to keep to: the chain is cut there.
//!
//! It is how a half-edge structure walks the rim of a region, here of the front
//! faces. Rejected: joining the edges that meet at a vertex where they are just two;
//! on rough meshes four and more meet at many vertices.

use super::feature::{Line, LineBits};
use crate::edge_mesh::EdgeMesh;
use crate::face_edges::FaceEdges;
use crate::index::{NONE, to_u32};
use crate::record::EdgeFlags;

/// What follows a contour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Successor {
    /// The contour on this record.
    Edge(u32),
    /// Nothing: the surface ends here.
    Boundary,
    /// Nothing: here the surface has no two sides.
    Cut,
}

/// Contours in the order of their line, the front faces on its left.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ContourChain {
    /// Indices of records. A loop begins with its smallest.
    pub edges: Vec<u32>,
    /// Whether the last is followed by the first.
    pub is_closed: bool,
}

/// Edges that chains neither contain nor turn across.
const CUTS: EdgeFlags = EdgeFlags::CLASH.union(EdgeFlags::NON_MANIFOLD);

/// The vertices of a contour in the direction of its chain: its front face lies
/// left of it.
#[must_use]
pub fn contour_ends(mesh: &EdgeMesh, edge: u32, bits: LineBits) -> [u32; 2] {
    let record = &mesh.records[edge as usize];
    if bits.contains(LineBits::A_FACES) { [record.v0, record.v1] } else { [record.v1, record.v0] }
}

/// What follows the contour on record `edge`; `lines` says what the view makes of
/// every record.
///
/// # Panics
/// Where there is no such record or line.
#[must_use]
pub fn successor(mesh: &EdgeMesh, faces: &FaceEdges, lines: &[Line], edge: u32) -> Successor {
    let record = &mesh.records[edge as usize];
    if record.flags.intersects(CUTS) {
        return Successor::Cut;
    }
    let a_faces = lines[edge as usize].bits.contains(LineBits::A_FACES);
    let mut face = if a_faces { record.face_a } else { record.face_b };
    let mut at = edge;
    // A fan has no more faces than the mesh.
    for _ in 0..mesh.triangles.len() {
        let sides = faces.sides(face);
        let Some(side) = sides.iter().position(|side| *side == at) else { return Successor::Cut };
        at = sides[(side + 1) % 3];
        if at == NONE || mesh.records[at as usize].flags.intersects(CUTS) {
            return Successor::Cut;
        }
        if lines[at as usize].bits.contains(LineBits::CONTOUR) {
            return Successor::Edge(at);
        }
        let across = &mesh.records[at as usize];
        face = if across.face_a == face { across.face_b } else { across.face_a };
        if face == NONE {
            return Successor::Boundary;
        }
    }
    Successor::Cut
}

/// All chains of contours of a view, in the order of their first edges.
///
/// # Panics
/// Where there is not one line a record.
#[must_use]
pub fn contour_chains(mesh: &EdgeMesh, faces: &FaceEdges, lines: &[Line]) -> Vec<ContourChain> {
    assert_eq!(lines.len(), mesh.records.len(), "one line a record");
    let is_contour = |edge: &u32| lines[*edge as usize].bits.contains(LineBits::CONTOUR);
    let contours: Vec<u32> = (0..to_u32(lines.len())).filter(is_contour).collect();
    let mut next = vec![NONE; lines.len()];
    let mut is_followed = vec![false; lines.len()];
    for &edge in &contours {
        if let Successor::Edge(following) = successor(mesh, faces, lines, edge) {
            next[edge as usize] = following;
            is_followed[following as usize] = true;
        }
    }
    let mut is_chained = vec![false; lines.len()];
    let mut walk = |first: u32| {
        let mut chain = ContourChain { edges: Vec::new(), is_closed: false };
        let mut edge = first;
        while edge != NONE && !is_chained[edge as usize] {
            is_chained[edge as usize] = true;
            chain.edges.push(edge);
            edge = next[edge as usize];
        }
        chain.is_closed = edge == first;
        (!chain.edges.is_empty()).then_some(chain)
    };
    let heads = contours.iter().filter(|edge| !is_followed[**edge as usize]);
    // Then what is left are loops, met first at their smallest edge.
    let mut chains: Vec<ContourChain> =
        heads.chain(&contours).filter_map(|&edge| walk(edge)).collect();
    chains.sort_unstable_by_key(|chain| chain.edges[0]);
    chains
}

#[cfg(test)]
mod tests {
    use glam::Vec4;

    use super::*;
    use crate::build::{BuildOptions, build_edge_mesh};
    use crate::model::Model;
    use crate::oracle::classify_lines;
    use crate::oracle::feature::ClassTable;
    use crate::report::Report;

    fn chains_of(
        positions: &[[f32; 3]],
        polygons: &[&[u32]],
        eye: Vec4,
    ) -> (EdgeMesh, Vec<ContourChain>) {
        let model = Model::from_polygons(positions, polygons);
        let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default());
        let words = crate::edge_word::edge_words(&mesh);
        let lines = classify_lines(&mesh, &words, eye, &ClassTable::all_in_one(), true);
        let chains = contour_chains(&mesh, &FaceEdges::of(&mesh), &lines);
        (mesh, chains)
    }

    /// A cube's corners, x fastest.
    fn cube() -> Vec<[f32; 3]> {
        (0..8_u8).map(|at| [0, 1, 2].map(|axis| f32::from(at >> axis & 1))).collect()
    }

    const CUBE: [&[u32]; 6] =
        [&[0, 2, 3, 1], &[4, 5, 7, 6], &[0, 1, 5, 4], &[2, 6, 7, 3], &[0, 4, 6, 2], &[1, 3, 7, 5]];

    #[test]
    fn a_cube_from_its_corner_is_one_loop_of_six() {
        let (_, chains) = chains_of(&cube(), &CUBE, Vec4::new(5.0, 4.0, 3.0, 1.0));
        assert_eq!(chains.len(), 1);
        assert_eq!((chains[0].edges.len(), chains[0].is_closed), (6, true));
        assert_eq!(chains[0].edges.iter().min(), Some(&chains[0].edges[0]), "a stable seed");
    }

    #[test]
    fn chains_of_an_open_surface_end_at_its_rim() {
        // A tent without ends, seen from a side: its ridge is a contour.
        let corners = [
            [0., 0., 0.],
            [4., 0., 0.],
            [0., 2., 1.],
            [2., 2., 1.],
            [4., 2., 1.],
            [0., 0., 2.],
            [4., 0., 2.],
        ];
        let tent: [&[u32]; 2] = [&[1, 0, 2, 3, 4], &[5, 6, 4, 3, 2]];
        let (mesh, chains) = chains_of(&corners, &tent, Vec4::new(2.0, 0.5, 9.0, 1.0));
        assert_eq!(chains.len(), 1);
        assert_eq!((chains[0].edges.len(), chains[0].is_closed), (2, false));
        let ends = chains[0].edges.iter().map(|&edge| {
            let record = &mesh.records[edge as usize];
            [record.v0, record.v1]
        });
        let ends: Vec<[u32; 2]> = ends.collect();
        let shared = ends[0].iter().filter(|vertex| ends[1].contains(vertex)).count();
        assert_eq!(shared, 1, "they meet in the middle");
    }

    #[test]
    fn an_edge_of_four_faces_cuts_and_shares_no_link() {
        // Two cubes that touch along an edge.
        let mut corners = cube();
        corners.extend(cube().iter().map(|[x, y, z]| [x + 1.0, y + 1.0, *z]));
        let second = CUBE.map(|side| side.iter().map(|at| at + 8).collect::<Vec<u32>>());
        let polygons: Vec<&[u32]> =
            CUBE.iter().copied().chain(second.iter().map(Vec::as_slice)).collect();
        let (mesh, chains) = chains_of(&corners, &polygons, Vec4::new(9.0, 5.0, 7.0, 1.0));
        let mut all: Vec<u32> = chains.iter().flat_map(|chain| chain.edges.clone()).collect();
        let count = all.len();
        all.sort_unstable();
        all.dedup();
        assert_eq!((all.len(), count), (12, 12), "six of each cube, none twice");
        let is_split = |vertex: &u32| {
            let records = mesh.records.iter().filter(|r| [r.v0, r.v1].contains(vertex));
            records.into_iter().any(|record| record.flags.intersects(CUTS))
        };
        for chain in chains.iter().filter(|chain| !chain.is_closed) {
            let [first, last] = [chain.edges[0], chain.edges[chain.edges.len() - 1]]
                .map(|edge| mesh.records[edge as usize]);
            for record in [first, last] {
                assert!([record.v0, record.v1].iter().any(is_split), "{record:?}");
            }
        }
    }

    #[test]
    fn a_surface_without_sides_is_cut() {
        // A Möbius band of six squares.
        let around = |at: u32| {
            let angle = f64::from(at) / 6.0 * std::f64::consts::TAU;
            let half = angle / 2.0;
            [-0.4, 0.4].map(|out: f64| {
                let radius = 1.0 + out * half.cos();
                #[expect(clippy::cast_possible_truncation, reason = "a test")]
                [radius * angle.cos(), radius * angle.sin(), out * half.sin()].map(|x| x as f32)
            })
        };
        let corners: Vec<[f32; 3]> = (0..6).flat_map(around).collect();
        let polygons: Vec<[u32; 4]> = (0..6_u32)
            .map(|at| {
                let [a, b] = [2 * at, 2 * at + 1];
                let [c, d] = if at == 5 { [1, 0] } else { [2 * at + 2, 2 * at + 3] };
                [a, b, d, c]
            })
            .collect();
        let polygons: Vec<&[u32]> = polygons.iter().map(|polygon| &polygon[..]).collect();
        let (mesh, chains) = chains_of(&corners, &polygons, Vec4::new(3.0, 1.0, 2.0, 1.0));
        let clashes =
            mesh.records.iter().filter(|record| record.flags.contains(EdgeFlags::CLASH)).count();
        assert!(clashes > 0, "it cannot be oriented");
        for chain in &chains {
            let has_cut =
                chain.edges.iter().any(|&edge| mesh.records[edge as usize].flags.intersects(CUTS));
            assert!(!has_cut || chain.edges.len() == 1, "{chain:?}");
        }
    }
}
