//! The welded triangles of a model, and their repairs: copies and backs are dropped, and every
//! component is wound one way, outward if it has an outside.
//!
//! A sound mesh is not changed and costs next to nothing, because every fault has edges that a
//! sound mesh does not have.

use rayon::prelude::*;

use super::faces::{FaceSources, keep_items};
use super::two_sided::{TwoSidedInput, repeats};
use super::{duplicates, orient};
use crate::edge_mesh::{EdgeCounts, EdgeTable, MeshCounts, triangle_side};
use crate::model::Model;
use crate::report::{RepairKind, Report, WarningCode};

/// Welded triangles, their sources and their edges.
#[derive(Debug)]
pub(crate) struct Faces<'a> {
    pub(crate) model: &'a Model,
    /// The vertex of each position of the model.
    pub(crate) welded_from_input: &'a [u32],
    pub(crate) vertex_count: usize,
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) sources: FaceSources,
    pub(crate) table: EdgeTable,
    /// Edges (numbers of the table) whose two faces clash, ascending.
    pub(crate) clashes: Vec<u32>,
}

impl Faces<'_> {
    /// Drops faces that repeat others, and makes the winding of each component consistent.
    pub(crate) fn repair(&mut self, counts: &mut MeshCounts, report: &mut Report) {
        let EdgeCounts { non_manifold, mut inconsistent, .. } = counts.edges;
        if non_manifold + inconsistent > 0
            && let Some(is_kept) = duplicates::keep_first_of_each(&self.triangles, &self.table)
        {
            self.drop_copies(&is_kept, counts, report);
            inconsistent = self.inconsistent_edges();
        }
        if self.drop_repeated_polygons(counts, report) {
            inconsistent = self.inconsistent_edges();
        }
        if inconsistent > 0 {
            self.repair_winding(report);
        }
    }

    fn inconsistent_edges(&self) -> usize {
        EdgeCounts::of(&self.table, |side| triangle_side(&self.triangles, side)).inconsistent
    }

    /// Drops the polygons that repeat others in the same order, or reversed as the backs of sheets;
    /// returns whether there were any.
    fn drop_repeated_polygons(&mut self, counts: &mut MeshCounts, report: &mut Report) -> bool {
        let repeats = repeats(&TwoSidedInput {
            model: self.model,
            sources: &self.sources,
            triangles: &self.triangles,
            table: &self.table,
            welded_from_input: self.welded_from_input,
        });
        if !repeats.copies.is_empty() {
            self.drop_copies(&self.without(&repeats.copies), counts, report);
        }
        if !repeats.backs.is_empty() {
            let is_kept = self.without(&repeats.backs);
            let first = duplicates::left_out(&is_kept).next();
            let place = first.map(|face| self.sources.place(self.model, face));
            let count = duplicates::left_out(&is_kept).count();
            report.repair(RepairKind::TwoSidedFaces, count, place);
            self.keep(&is_kept);
        }
        !repeats.copies.is_empty() || !repeats.backs.is_empty()
    }

    /// Whether each face belongs to none of `polygons`, ascending.
    fn without(&self, polygons: &[u32]) -> Vec<bool> {
        let is_kept = |face: usize| {
            let polygon = self.sources.polygon(face);
            polygons.binary_search_by(|&other| (other as usize).cmp(&polygon)).is_err()
        };
        (0..self.triangles.len()).map(is_kept).collect()
    }

    fn drop_copies(&mut self, is_kept: &[bool], counts: &mut MeshCounts, report: &mut Report) {
        let count = duplicates::left_out(is_kept).count();
        counts.duplicate_triangles += count;
        let first = duplicates::left_out(is_kept).next();
        let place = first.map(|face| self.sources.place(self.model, face));
        report.warn_many(WarningCode::Duplicate, count, place, || {
            "a face that repeats another was dropped".into()
        });
        self.keep(is_kept);
    }

    fn keep(&mut self, is_kept: &[bool]) {
        keep_items(&mut self.triangles, is_kept);
        self.sources.keep(is_kept);
        self.count_edges();
    }

    /// Finds the edges again, after a change of the triangles.
    fn count_edges(&mut self) {
        self.table = EdgeTable::from_triangles(self.vertex_count, &self.triangles);
    }

    /// Flips the minority of faces in every component with inconsistent winding.
    fn repair_winding(&mut self, report: &mut Report) {
        let orientation = orient::orient(&mut self.triangles, &self.table);
        let place = orientation.flipped.first().map(|&face| self.sources.place(self.model, face));
        report.repair(RepairKind::FlippedFaces, orientation.flipped.len(), place);
        if let Some(&edge) = orientation.clashes.first() {
            let last = self.table.sides(edge as usize).last();
            let place = last.map(|&side| self.sources.place(self.model, side as usize / 3));
            report.warn_many(WarningCode::Orientation, orientation.clashes.len(), place, || {
                "the surface cannot be oriented; it was cut along edges whose faces clash".into()
            });
        }
        if !orientation.flipped.is_empty() {
            for &face in &orientation.flipped {
                self.sources.turn(face);
            }
            // A flip renumbers the sides of a triangle; the edges stay the same.
            self.count_edges();
        }
        self.clashes = orientation.clashes;
    }

    /// Flips the faces of components that are inside out.
    pub(crate) fn turn(
        &mut self,
        is_inside_out: impl Fn(usize) -> bool + Sync,
        report: &mut Report,
    ) {
        let turned: Vec<usize> =
            (0..self.triangles.len()).into_par_iter().filter(|&face| is_inside_out(face)).collect();
        let place = turned.first().map(|&face| self.sources.place(self.model, face));
        report.repair(RepairKind::InsideOutFaces, turned.len(), place);
        for face in turned {
            self.triangles[face].swap(1, 2);
            self.sources.turn(face);
        }
        self.count_edges();
    }
}
