//! Finds the backs of two-sided surfaces: polygons that another polygon has reversed.
//!
//! Exporters write each face of a sheet twice, once for each side. All edges of such a sheet have
//! four faces, or two that turn by 180 degrees; drawn as the one surface that it is, the sheet has
//! the edges of one side.
//!
//! Idea: a polygon and its back have the same vertices in reversed order. Two bodies that touch
//! along a face have such a pair too, but around it lie the other faces of both: an edge of a pair
//! with two further faces is that of a contact, and its pairs stay. The search begins at edges that
//! a sound mesh does not have, so a sound mesh costs next to nothing.
//!
//! Rejected: comparing planes of overlapping faces, which would take the walls of thin boxes for
//! two sides of one.

use rayon::prelude::*;

use super::components::Sets;
use super::faces::FaceSources;
use crate::edge_mesh::{EdgePart, EdgeTable};
use crate::index::to_u32;
use crate::model::Model;

/// The input of [`repeats`].
#[derive(Debug)]
pub(crate) struct TwoSidedInput<'a> {
    pub(crate) model: &'a Model,
    pub(crate) sources: &'a FaceSources,
    pub(crate) triangles: &'a [[u32; 3]],
    pub(crate) table: &'a EdgeTable,
    /// The vertex of each position of the model.
    pub(crate) welded_from_input: &'a [u32],
}

/// Polygons that repeat an earlier one, ascending.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct Repeats {
    /// In the same order.
    pub(crate) copies: Vec<u32>,
    /// In reversed order, as the back of a sheet.
    pub(crate) backs: Vec<u32>,
}

/// Polygons with the same vertices as an earlier one.
pub(crate) fn repeats(input: &TwoSidedInput) -> Repeats {
    let suspects = input.suspects();
    let mut keyed: Vec<(Vec<u32>, u32, bool)> = suspects
        .into_iter()
        .filter_map(|polygon| {
            let (key, is_reversed) = canonical(input.vertices(polygon).collect())?;
            Some((key, polygon, is_reversed))
        })
        .collect();
    keyed.par_sort_unstable();
    let mut repeats = Repeats::default();
    let mut pairs = Vec::new();
    for same in keyed.chunk_by(|a, b| a.0 == b.0) {
        let (first, others) = (&same[0], &same[1..]);
        for other in others {
            if other.2 == first.2 {
                repeats.copies.push(other.1);
            } else {
                pairs.push([first.1, other.1]);
            }
        }
    }
    repeats.copies.sort_unstable();
    repeats.backs = input.backs(&pairs, &repeats.copies);
    repeats
}

impl TwoSidedInput<'_> {
    fn polygon_of(&self, side: u32) -> u32 {
        to_u32(self.sources.polygon(side as usize / 3))
    }

    fn vertex(&self, corner: usize) -> u32 {
        self.welded_from_input[self.model.corner_positions[corner] as usize]
    }

    fn vertices(&self, polygon: u32) -> impl Iterator<Item = u32> {
        self.model.corner_range(polygon as usize).map(|corner| self.vertex(corner))
    }

    /// Polygons at edges that no sound mesh has, ascending.
    fn suspects(&self) -> Vec<u32> {
        let of_part = |(_, part): (usize, &EdgePart)| {
            let is_suspect = |sides: &[u32]| match *sides {
                [_] => false,
                [a, b] => self.are_opposite(a, b),
                _ => true,
            };
            let sides = part.iter().map(|(_, sides)| sides).filter(|sides| is_suspect(sides));
            sides.flatten().map(|&side| self.polygon_of(side)).collect::<Vec<u32>>()
        };
        let mut suspects: Vec<u32> = self.table.parts().flat_map_iter(of_part).collect();
        suspects.sort_unstable();
        suspects.dedup();
        suspects
    }

    /// Whether the polygons at two sides go on to the same vertices both ways.
    fn are_opposite(&self, a: u32, b: u32) -> bool {
        if self.sources.has_no_diagonals() {
            let apex = |side: u32| self.triangles[side as usize / 3][(side as usize + 2) % 3];
            return apex(a) == apex(b);
        }
        let around = |side: u32| {
            let corners = self.sources.corners(side as usize / 3);
            let [start, end] = [side, side + 1].map(|k| corners[k as usize % 3] as usize);
            let range = self.model.corner_range(self.sources.polygon(side as usize / 3));
            let before = if start == range.start { range.end - 1 } else { start - 1 };
            let behind = if end + 1 == range.end { range.start } else { end + 1 };
            [self.vertex(before), self.vertex(behind)]
        };
        let [before, behind] = around(b);
        !self.sources.is_diagonal(a)
            && !self.sources.is_diagonal(b)
            && around(a) == [behind, before]
    }

    /// The second polygons of the pairs that are no contact of two bodies, ascending.
    fn backs(&self, pairs: &[[u32; 2]], copies: &[u32]) -> Vec<u32> {
        if pairs.is_empty() {
            return Vec::new();
        }
        let mut pair_of: Vec<(u32, u32)> = pairs
            .iter()
            .zip(0..)
            .flat_map(|(pair, index)| pair.map(|face| (face, index)))
            .collect();
        pair_of.sort_unstable();
        let find = |polygon: u32| {
            let at = pair_of.partition_point(|entry| entry.0 < polygon);
            pair_of.get(at).filter(|entry| entry.0 == polygon).map(|entry| entry.1)
        };
        let regions = Sets::new(pairs.len());
        let mut contacts = Vec::new();
        let mut of_edge = Vec::new();
        for (_, sides) in self.table.iter().filter(|(_, sides)| sides.len() > 2) {
            of_edge.clear();
            let mut single_count = 0;
            for polygon in sides.iter().map(|&side| self.polygon_of(side)) {
                match find(polygon) {
                    Some(pair) => of_edge.push(pair),
                    None => single_count += usize::from(copies.binary_search(&polygon).is_err()),
                }
            }
            if single_count >= 2 {
                contacts.extend(of_edge.first());
            }
            if single_count != 1 {
                of_edge.windows(2).for_each(|pair| regions.join(pair[0], pair[1]));
            }
        }
        let mut is_contact = vec![false; pairs.len()];
        for pair in contacts {
            is_contact[regions.root(pair) as usize] = true;
        }
        let is_back = |index: &u32| !is_contact[regions.root(*index) as usize];
        let indices = (0..to_u32(pairs.len())).filter(is_back);
        let mut backs: Vec<u32> = indices.map(|index| pairs[index as usize][1]).collect();
        backs.sort_unstable();
        backs
    }
}

/// The vertices of a polygon from the smallest on, in the direction of its smaller neighbor, and
/// whether that is against the polygon; `None` if it passes a vertex twice.
fn canonical(mut vertices: Vec<u32>) -> Option<(Vec<u32>, bool)> {
    let mut sorted = vertices.clone();
    sorted.sort_unstable();
    if sorted.windows(2).any(|pair| pair[0] == pair[1]) {
        return None;
    }
    let smallest = vertices.iter().enumerate().min_by_key(|&(_, vertex)| vertex);
    let start = smallest.map_or(0, |(at, _)| at);
    vertices.rotate_left(start);
    let is_reversed = vertices.last() < vertices.get(1);
    if is_reversed {
        vertices[1..].reverse();
    }
    Some((vertices, is_reversed))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::Report;

    fn found(positions: &[[f32; 3]], polygons: &[&[u32]]) -> (Vec<u32>, Vec<u32>) {
        let model = Model::from_polygons(positions, polygons);
        let sources = FaceSources::of(&model, &[], &mut Report::default());
        let corner = |corner: u32| model.corner_positions[corner as usize];
        let triangles: Vec<[u32; 3]> =
            (0..sources.len()).map(|face| sources.corners(face).map(corner)).collect();
        let table = EdgeTable::from_triangles(positions.len(), &triangles);
        let welded_from_input: Vec<u32> = (0..to_u32(positions.len())).collect();
        let Repeats { copies, backs } = repeats(&TwoSidedInput {
            model: &model,
            sources: &sources,
            triangles: &triangles,
            table: &table,
            welded_from_input: &welded_from_input,
        });
        (copies, backs)
    }

    /// Two layers of a grid of 3 by 2 vertices, one above the other.
    fn grid() -> Vec<[f32; 3]> {
        let at = |k: u8| [f32::from(k % 3), f32::from(k / 3 % 2), f32::from(k / 6)];
        (0..18).map(at).collect()
    }

    #[test]
    fn both_sides_of_a_sheet_are_found_however_they_are_cut() {
        let quads: [&[u32]; 2] = [&[0, 1, 4, 3], &[1, 2, 5, 4]];
        assert_eq!(found(&grid(), &quads), (vec![], vec![]));
        let both: [&[u32]; 4] = [quads[0], quads[1], &[4, 1, 0, 3], &[1, 4, 5, 2]];
        assert_eq!(found(&grid(), &both), (vec![], vec![2, 3]));
        assert_eq!(found(&grid(), &both[..3]), (vec![], vec![2]), "a part");
        let alone: [&[u32]; 2] = [&[0, 1, 4], &[4, 1, 0]];
        assert_eq!(found(&grid(), &alone), (vec![], vec![1]));
        let again: [&[u32]; 3] = [quads[0], quads[1], &[1, 4, 3, 0]];
        assert_eq!(found(&grid(), &again), (vec![2], vec![]), "a copy");
    }

    /// The walls around one cell of the grid, between its layers.
    fn cell(x: u32, z: u32) -> Vec<Vec<u32>> {
        let [a, b, c, d] = [0, 1, 4, 3].map(|k| k + x + 6 * z);
        let up = |k: u32| k + 6;
        vec![
            vec![a, d, c, b],
            vec![up(a), up(b), up(c), up(d)],
            vec![a, b, up(b), up(a)],
            vec![b, c, up(c), up(b)],
            vec![c, d, up(d), up(c)],
            vec![d, a, up(a), up(d)],
        ]
    }

    #[test]
    fn bodies_that_share_a_face_keep_it() {
        let boxes = [cell(0, 0), cell(1, 0), cell(0, 1)].concat();
        let polygons: Vec<&[u32]> = boxes.iter().map(Vec::as_slice).collect();
        assert_eq!(found(&grid(), &polygons), (vec![], vec![]));
        // A box whose faces are all written twice.
        let walls = cell(0, 0);
        let backs = walls.iter().map(|wall| wall.iter().rev().copied().collect::<Vec<u32>>());
        let both: Vec<Vec<u32>> = walls.iter().cloned().chain(backs).collect();
        let polygons: Vec<&[u32]> = both.iter().map(Vec::as_slice).collect();
        assert_eq!(found(&grid(), &polygons), (vec![], (6..12).collect()));
    }
}
