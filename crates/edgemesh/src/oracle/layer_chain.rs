//! Links the drawn edges of a layer into chains: contours by [`super::contour_chain`], other edges
//! by the chains of the mesh, as far as the layer has them.
//!
//! An edge of several classes is in the layer of the strongest drawn class. A ridge that is a
//! contour in this view belongs to the chain of the contour and leaves a gap in the chain of
//! ridges: each drawn edge is in exactly one chain.
//!
//! ```text
//!   ridges   a--b--c--d        c is a contour too:
//!   drawn    a--b  |  d        two chains of ridges, and the contour through c
//! ```
//!
//! Linking needs only elements and their successors. A chain without an open end begins at its
//! smallest edge, so that the same view always cuts it at the same place.

use super::contour_chain::{Successor, successor};
use crate::edge_mesh::{EdgeMesh, FaceEdges, StaticLinks};
use crate::index::{NONE, to_u32};
use crate::view::{Line, LineBits};

/// An edge in the direction of its chain.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Element {
    /// Index of the record.
    pub edge: u32,
    /// Whether the chain runs from `v1` of the record to `v0`.
    pub is_reversed: bool,
}

impl Element {
    /// The vertices at its start and its end.
    ///
    /// # Panics
    /// Panics if `mesh` does not have the record.
    #[must_use]
    pub fn ends(self, mesh: &EdgeMesh) -> [u32; 2] {
        let record = &mesh.records[self.edge as usize];
        if self.is_reversed { [record.v1, record.v0] } else { [record.v0, record.v1] }
    }
}

/// A chain of successive edges.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LayerChain {
    /// The edges in the order of the chain; contours have their front faces on the left.
    pub elements: Vec<Element>,
    /// Whether the first element follows the last.
    pub is_closed: bool,
}

/// The input of the chains of a view.
#[derive(Debug, Clone, Copy)]
pub struct LayerLinks<'a> {
    /// The mesh.
    pub mesh: &'a EdgeMesh,
    /// The edges of the faces of `mesh`.
    pub faces: &'a FaceEdges,
    /// The chains of `mesh`.
    pub links: &'a StaticLinks,
    /// Every record in the view, with those hidden by their own solid.
    pub lines: &'a [Line],
    /// Whether contours are drawn; otherwise only the other classes of an edge count.
    pub draws_contours: bool,
}

impl LayerLinks<'_> {
    /// The chains of one layer, in the order of their first edges.
    ///
    /// # Panics
    /// Panics if `lines` does not have an element for each record.
    #[must_use]
    pub fn chains(&self, layer: u32) -> Vec<LayerChain> {
        let count = self.mesh.records.len();
        assert_eq!(self.lines.len(), count, "one line a record");
        let members: Vec<u32> =
            (0..to_u32(count)).filter(|&edge| self.is_in(layer, edge)).collect();
        let mut next = vec![NONE; count];
        let mut is_followed = vec![false; count];
        for &edge in &members {
            if let Some(following) = self.following(edge).filter(|&edge| self.is_in(layer, edge)) {
                next[edge as usize] = following;
                is_followed[following as usize] = true;
            }
        }
        let mut is_chained = vec![false; count];
        let mut walk = |first: u32| {
            let mut elements = Vec::new();
            let mut edge = first;
            while edge != NONE && !std::mem::replace(&mut is_chained[edge as usize], true) {
                elements.push(Element { edge, is_reversed: self.is_reversed(edge) });
                edge = next[edge as usize];
            }
            let is_closed = edge == first;
            (!elements.is_empty()).then_some(LayerChain { elements, is_closed })
        };
        let heads = members.iter().filter(|edge| !is_followed[**edge as usize]);
        // The remaining chains are loops, whose smallest edge comes first.
        let mut chains: Vec<LayerChain> =
            heads.chain(&members).filter_map(|&edge| walk(edge)).collect();
        chains.sort_unstable_by_key(|chain| chain.elements[0].edge);
        chains
    }

    fn is_in(&self, layer: u32, edge: u32) -> bool {
        let line = &self.lines[edge as usize];
        line.bits.contains(LineBits::DRAWN) && line.layer == layer
    }

    fn is_contour(&self, edge: u32) -> bool {
        self.draws_contours && self.lines[edge as usize].bits.contains(LineBits::CONTOUR)
    }

    fn following(&self, edge: u32) -> Option<u32> {
        if self.is_contour(edge) {
            return match successor(self.mesh, self.faces, self.lines, edge) {
                Successor::Edge(following) => Some(following),
                Successor::Boundary | Successor::Cut => None,
            };
        }
        let following = self.links.next[edge as usize];
        (following != NONE && !self.is_contour(following)).then_some(following)
    }

    fn is_reversed(&self, edge: u32) -> bool {
        if self.is_contour(edge) {
            // Face A lies left of v0 to v1.
            return !self.lines[edge as usize].bits.contains(LineBits::A_FACES);
        }
        self.links.is_reversed[edge as usize]
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec4;

    use super::*;
    use crate::build::{BuildOptions, build_edge_mesh};
    use crate::edge_mesh::EdgeFlags;
    use crate::line::{ClassTable, LineClass};
    use crate::model::Model;
    use crate::report::Report;
    use crate::view::classify_lines;

    /// The chains of each class in a layer of its own.
    fn chains_of(
        positions: &[[f32; 3]],
        polygons: &[&[u32]],
        eye: Vec4,
    ) -> (EdgeMesh, impl Fn(LineClass) -> Vec<LayerChain> + use<>) {
        let model = Model::from_polygons(positions, polygons);
        let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default());
        let table = ClassTable { keeps_hidden: 1, ..ClassTable::new(|class| Some(class as u32)) };
        let lines = classify_lines(&mesh, eye, &table, true);
        let (faces, links) = (FaceEdges::of(&mesh), StaticLinks::of(&mesh));
        let of = {
            let mesh = mesh.clone();
            move |class: LineClass| {
                let (mesh, faces, links, lines) = (&mesh, &faces, &links, &lines);
                LayerLinks { mesh, faces, links, lines, draws_contours: true }.chains(class as u32)
            }
        };
        (mesh, of)
    }

    /// A cube's corners, x fastest.
    fn cube() -> Vec<[f32; 3]> {
        (0..8_u8).map(|at| [0, 1, 2].map(|axis| f32::from(at >> axis & 1))).collect()
    }

    const CUBE: [&[u32]; 6] =
        [&[0, 2, 3, 1], &[4, 5, 7, 6], &[0, 1, 5, 4], &[2, 6, 7, 3], &[0, 4, 6, 2], &[1, 3, 7, 5]];

    #[test]
    fn a_cube_from_its_corner_is_one_loop_of_six_and_six_ridges() {
        let (mesh, of) = chains_of(&cube(), &CUBE, Vec4::new(5.0, 4.0, 3.0, 1.0));
        let [contour] = &of(LineClass::Contour)[..] else { panic!("one loop") };
        assert_eq!((contour.elements.len(), contour.is_closed), (6, true));
        let least = contour.elements.iter().map(|element| element.edge).min();
        assert_eq!(least, Some(contour.elements[0].edge), "a stable seed");
        for pair in contour.elements.windows(2) {
            assert_eq!(pair[0].ends(&mesh)[1], pair[1].ends(&mesh)[0]);
        }
        // Ridges turn by a right angle at each corner: no two are one line.
        assert_eq!(of(LineClass::Ridge).len(), 6);
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
        let (_, of) = chains_of(&corners, &tent, Vec4::new(2.0, 0.5, 9.0, 1.0));
        let [contour] = &of(LineClass::Contour)[..] else { panic!("one chain") };
        assert_eq!((contour.elements.len(), contour.is_closed), (2, false));
        assert_eq!(of(LineClass::Ridge), [], "the ridge is the contour");
        // From above it is the ridge, of the same two edges.
        let (_, of) = chains_of(&corners, &tent, Vec4::new(2.0, 9.0, 1.0, 1.0));
        assert_eq!(of(LineClass::Contour), []);
        assert_eq!(of(LineClass::Ridge)[0].elements.len(), 2);
    }

    #[test]
    fn an_edge_of_four_faces_cuts_and_shares_no_link() {
        // Two cubes that touch along an edge.
        let mut corners = cube();
        corners.extend(cube().iter().map(|[x, y, z]| [x + 1.0, y + 1.0, *z]));
        let second = CUBE.map(|side| side.iter().map(|at| at + 8).collect::<Vec<u32>>());
        let polygons: Vec<&[u32]> =
            CUBE.iter().copied().chain(second.iter().map(Vec::as_slice)).collect();
        let (mesh, of) = chains_of(&corners, &polygons, Vec4::new(9.0, 5.0, 7.0, 1.0));
        let chains = of(LineClass::Contour);
        let mut all: Vec<u32> =
            chains.iter().flat_map(|chain| chain.elements.iter().map(|e| e.edge)).collect();
        let count = all.len();
        all.sort_unstable();
        all.dedup();
        assert_eq!((all.len(), count), (12, 12), "six of each cube, none twice");
        let is_split = |vertex: u32| {
            let flags = EdgeFlags::NON_MANIFOLD;
            mesh.records
                .iter()
                .any(|r| [r.v0, r.v1].contains(&vertex) && r.flags().intersects(flags))
        };
        for chain in chains.iter().filter(|chain| !chain.is_closed) {
            let last = chain.elements[chain.elements.len() - 1];
            let open = [chain.elements[0].ends(&mesh)[0], last.ends(&mesh)[1]];
            assert!(open.into_iter().all(is_split), "{open:?}");
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
        let (mesh, of) = chains_of(&corners, &polygons, Vec4::new(3.0, 1.0, 2.0, 1.0));
        let is_clash = |edge: u32| mesh.records[edge as usize].flags().contains(EdgeFlags::CLASH);
        assert!((0..to_u32(mesh.records.len())).any(is_clash), "it cannot be oriented");
        for chain in of(LineClass::Contour) {
            let is_cut = chain.elements.iter().any(|element| is_clash(element.edge));
            assert!(!is_cut || chain.elements.len() == 1, "{chain:?}");
        }
    }
}
