//! The faces of a mesh and their sources in the model.
//!
//! A model of triangles needs no list: triangle k is polygon k, with the corners 3k to 3k+2. Lists
//! are made only if polygons are cut, triangles dropped, or faces flipped.

use super::triangulate::{PolygonTriangle, triangulate};
use crate::index::to_u32;
use crate::model::Model;
use crate::report::{Place, Report};

/// The source of each face.
#[derive(Debug, Default)]
pub(crate) struct FaceSources {
    /// The triangles of all polygons; `None` if all polygons are triangles.
    cut: Option<Vec<PolygonTriangle>>,
    /// The triangle of each face; `None` if no triangle was dropped.
    kept: Option<Vec<u32>>,
    /// Whether each face was flipped; empty if no face was.
    is_turned: Vec<bool>,
    face_count: usize,
}

impl FaceSources {
    /// Cuts the polygons of `model`; those of `jointed`, ascending, have corners on their sides.
    pub(crate) fn of(model: &Model, jointed: &[u32], report: &mut Report) -> Self {
        let cut = (!model.is_triangles()).then(|| triangulate(model, jointed, report));
        let face_count = cut.as_ref().map_or(model.polygon_count(), Vec::len);
        Self { cut, kept: None, is_turned: Vec::new(), face_count }
    }

    pub(crate) const fn len(&self) -> usize {
        self.face_count
    }

    fn triangle(&self, face: usize) -> PolygonTriangle {
        let index = self.kept.as_ref().map_or(face, |kept| kept[face] as usize);
        match &self.cut {
            Some(cut) => cut[index],
            None => PolygonTriangle {
                corners: [0, 1, 2].map(|corner| to_u32(3 * index + corner)),
                polygon: to_u32(index),
                diagonals: 0,
            },
        }
    }

    /// Whether a face is wound against its polygon.
    pub(crate) fn is_turned(&self, face: usize) -> bool {
        self.is_turned.get(face).copied().unwrap_or(false)
    }

    /// The corners of a face as indices of the model's corners.
    pub(crate) fn corners(&self, face: usize) -> [u32; 3] {
        let [a, b, c] = self.triangle(face).corners;
        if self.is_turned(face) { [a, c, b] } else { [a, b, c] }
    }

    /// The polygon of a face.
    pub(crate) fn polygon(&self, face: usize) -> usize {
        self.triangle(face).polygon as usize
    }

    /// The place of a face in the file.
    pub(crate) fn place(&self, model: &Model, face: usize) -> Place {
        model.polygon_place(self.polygon(face))
    }

    /// Whether no side is a diagonal, because all polygons are triangles.
    pub(crate) const fn has_no_diagonals(&self) -> bool {
        self.cut.is_none()
    }

    /// Whether side `3 f + k` is a diagonal of its polygon.
    pub(crate) fn is_diagonal(&self, side: u32) -> bool {
        if self.cut.is_none() {
            return false;
        }
        let (face, corner) = (side as usize / 3, side % 3);
        // A flip swaps corners 1 and 2, and so sides 0 and 2.
        let corner = if self.is_turned(face) { 2 - corner } else { corner };
        self.triangle(face).diagonals & (1 << corner) != 0
    }

    /// Whether an edge is a diagonal for both of its faces.
    pub(crate) fn is_diagonal_edge(&self, sides: &[u32]) -> bool {
        matches!(*sides, [a, b] if self.is_diagonal(a) && self.is_diagonal(b))
    }

    /// Drops the faces that are not kept.
    pub(crate) fn keep(&mut self, is_kept: &[bool]) {
        debug_assert!(self.is_turned.is_empty(), "faces are turned after others were dropped");
        let index = |face: usize| self.kept.as_ref().map_or(to_u32(face), |kept| kept[face]);
        let kept: Vec<u32> =
            (0..self.face_count).filter(|&face| is_kept[face]).map(index).collect();
        self.face_count = kept.len();
        self.kept = Some(kept);
    }

    /// Flips a face by swapping its corners 1 and 2.
    pub(crate) fn turn(&mut self, face: usize) {
        self.is_turned.resize(self.face_count, false);
        self.is_turned[face] = !self.is_turned[face];
    }
}

/// Drops the items that are not kept.
pub(crate) fn keep_items<T>(items: &mut Vec<T>, is_kept: &[bool]) {
    let mut kept = is_kept.iter();
    items.retain(|_| kept.next() == Some(&true));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_stand_for_themselves_until_some_are_dropped() {
        let model = Model::from_polygons(&[[0.0; 3]; 4], &[&[0, 1, 2], &[1, 2, 3], &[2, 3, 0]]);
        let mut sources = FaceSources::of(&model, &[], &mut Report::default());
        assert_eq!((sources.corners(1), sources.polygon(1)), ([3, 4, 5], 1));
        sources.keep(&[true, false, true]);
        assert_eq!((sources.len(), sources.corners(1), sources.polygon(1)), (2, [6, 7, 8], 2));
        sources.turn(1);
        assert_eq!((sources.corners(0), sources.corners(1)), ([0, 1, 2], [6, 8, 7]));
        assert!(sources.has_no_diagonals() && !sources.is_diagonal(4));
    }

    #[test]
    fn the_diagonal_of_a_quad_moves_when_its_triangle_turns() {
        let square = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
        let model = Model::from_polygons(&square, &[&[0, 1, 2, 3]]);
        let mut sources = FaceSources::of(&model, &[], &mut Report::default());
        let diagonals = |sources: &FaceSources| {
            (0..6).filter(|&side| sources.is_diagonal(side)).collect::<Vec<_>>()
        };
        assert_eq!(diagonals(&sources), [2, 3]);
        assert!(sources.is_diagonal_edge(&[2, 3]) && !sources.is_diagonal_edge(&[0, 3]));
        sources.turn(0);
        assert_eq!(sources.corners(0), [0, 2, 1]);
        assert_eq!(diagonals(&sources), [0, 3]);
    }
}
