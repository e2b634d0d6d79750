//! Makes the edge records, with two faces each and the classes that no view changes.
//!
//! An edge of more than two faces is split into pairs of neighbors around it, so that each record
//! is manifold: in the order of dihedral angles, a face with solid matter on its far side is paired
//! with the next face that has it on its near side. Two cubes that touch along an edge become two
//! edges of a cube.
//!
//! Such an edge is a feature only if one of its pairs is, or a face has no partner. Two bodies that
//! share a face in all its triangles have four faces at each of its edges, and their pairs go on
//! smoothly.
//!
//! Rejected: refusing such meshes, as half-edge structures do; pairs in file order, which join
//! faces through one another.
//!
//! ```text
//!        b | c          around the edge (seen along v0 -> v1):
//!    solid | solid      pairs (a, b) and (c, d), each around its own solid
//!      ----e----
//!        a | d
//! ```

use std::sync::atomic::{AtomicU32, Ordering};

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::FaceAttributes;
use super::creases::CreaseNormals;
use super::faces::FaceSources;
use super::marks::{Marks, STATED_CLASSES};
use crate::edge_mesh::{EdgeFlags, EdgePart, EdgeRecord, EdgeTable, triangle_side};
use crate::index::{NONE, to_u32};

/// Faces whose directions around an edge differ by less than this angle, in radians, touch.
const TOUCHING_RAD: f64 = 1e-4;

/// The input of the records.
#[derive(Debug)]
pub(crate) struct RecordInput<'a> {
    pub(crate) positions: &'a [[f32; 3]],
    pub(crate) triangles: &'a [[u32; 3]],
    pub(crate) normals: &'a CreaseNormals<'a>,
    pub(crate) sources: &'a FaceSources,
    pub(crate) attributes: &'a FaceAttributes,
    pub(crate) marks: &'a Marks,
    /// Edges whose two faces clash, ascending.
    pub(crate) clashes: &'a [u32],
    /// Whether any edge may have more than two faces.
    pub(crate) has_split_edges: bool,
    /// The least steps of ridges and valleys.
    pub(crate) crease_steps: [u32; 2],
}

/// The records, and the sides that they join.
#[derive(Debug)]
pub(crate) struct RecordTable {
    /// Records in the order of the edges of the table.
    pub(crate) records: Vec<EdgeRecord>,
    /// For each side, the side of the other face of its record; [`NONE`] at boundaries and where
    /// the winding clashes.
    pub(crate) twins: Vec<AtomicU32>,
    /// Edges of more than two faces.
    pub(crate) split_edges: usize,
}

/// Builds the records of all edges in the order of `table`.
pub(crate) fn build_records(input: &RecordInput, table: &EdgeTable) -> RecordTable {
    let twins: Vec<AtomicU32> =
        (0..input.triangles.len() * 3).into_par_iter().map(|_| AtomicU32::new(NONE)).collect();
    // Edges of more than two faces are rare; only splitting them tells the number of records.
    let splits = input.split_edges(table, &twins);
    let count = table.edge_count() + splits.iter().map(|s| s.records.len() - 1).sum::<usize>();
    // Zeroed memory, which the threads touch first.
    let mut records: Vec<EdgeRecord> = bytemuck::zeroed_vec(count);
    let targets = targets(table, &splits, &mut records);
    table.parts().zip(targets).for_each(|((first_edge, part), (records, splits))| {
        input.fill_part(first_edge, part, splits, records, &twins);
    });
    RecordTable { records, twins, split_edges: splits.len() }
}

/// An edge of more than two faces, split into pairs.
struct SplitEdge {
    edge: usize,
    records: Vec<EdgeRecord>,
}

/// Cuts the lists of records and split edges into those of each part.
fn targets<'a>(
    table: &EdgeTable,
    mut splits: &'a [SplitEdge],
    mut records: &'a mut [EdgeRecord],
) -> Vec<(&'a mut [EdgeRecord], &'a [SplitEdge])> {
    let sizes: Vec<(usize, usize)> =
        table.parts().map(|(first, part)| (first + part.edge_count(), part.edge_count())).collect();
    let mut targets = Vec::with_capacity(sizes.len());
    for (end, edges) in sizes {
        let (own, behind) = splits.split_at(splits.partition_point(|split| split.edge < end));
        let extra: usize = own.iter().map(|split| split.records.len() - 1).sum();
        let (target, rest) = records.split_at_mut(edges + extra);
        targets.push((target, own));
        (splits, records) = (behind, rest);
    }
    targets
}

impl RecordInput<'_> {
    fn split_edges(&self, table: &EdgeTable, twins: &[AtomicU32]) -> Vec<SplitEdge> {
        if !self.has_split_edges {
            return Vec::new();
        }
        let of_part = |(first, part): (usize, &EdgePart)| {
            part.iter()
                .enumerate()
                .filter(|(_, (_, sides))| sides.len() > 2)
                .map(|(at, (ends, sides))| {
                    let edge = first + at;
                    let mut records = Vec::new();
                    let stated = self.marks.stated_classes(edge);
                    self.split(ends, sides, stated, twins, &mut records);
                    let marked = self.marks.is_marked(edge);
                    for record in &mut records {
                        record.word.set(EdgeFlags::MARKED, marked);
                    }
                    SplitEdge { edge, records }
                })
                .collect::<Vec<_>>()
        };
        table.parts().flat_map_iter(of_part).collect()
    }

    fn fill_part(
        &self,
        first_edge: usize,
        part: &EdgePart,
        splits: &[SplitEdge],
        records: &mut [EdgeRecord],
        twins: &[AtomicU32],
    ) {
        let mut splits = splits.iter();
        let mut at = 0;
        for (local, (_, sides)) in part.iter().enumerate() {
            let edge = first_edge + local;
            match *sides {
                [only] => records[at] = self.single(only, EdgeFlags::BOUNDARY),
                [a, b] => records[at] = self.pair(edge, a, b, twins),
                _ => {
                    let split = splits.next().map_or(&[][..], |split| &split.records);
                    records[at..at + split.len()].copy_from_slice(split);
                    at += split.len();
                    continue;
                }
            }
            if self.marks.is_marked(edge) {
                records[at].word.insert(EdgeFlags::MARKED);
            }
            at += 1;
        }
    }

    fn single(&self, side: u32, flags: EdgeFlags) -> EdgeRecord {
        let [v0, v1] = triangle_side(self.triangles, side);
        EdgeRecord { v0, v1, face_a: side / 3, face_b: NONE, word: flags.into() }
    }

    /// The record of an edge with two faces; face A traverses it from the smaller vertex to the
    /// larger one.
    fn pair(&self, edge: usize, first: u32, second: u32, twins: &[AtomicU32]) -> EdgeRecord {
        let [start, end] = triangle_side(self.triangles, first);
        let clashes = self.clashes.binary_search(&to_u32(edge)).is_ok();
        let (a, b) = if start < end || clashes { (first, second) } else { (second, first) };
        let mut record = self.joined(a, b, clashes);
        if !clashes {
            join(twins, a, b);
        }
        if self.sources.is_diagonal_edge(&[a, b]) || self.marks.is_suppressed(edge) {
            record.word = (record.flags() & EdgeFlags::CLASH | EdgeFlags::DIAGONAL).into();
            return record;
        }
        if let Some(classes) = self.marks.stated_classes(edge) {
            record.word.set(STATED_CLASSES, false);
            record.word.insert(classes & STATED_CLASSES);
        }
        record
    }

    /// The record of the faces of sides `a` and `b`, with all its classes.
    fn joined(&self, a: u32, b: u32, clashes: bool) -> EdgeRecord {
        let mut record = self.single(a, EdgeFlags::empty());
        record.face_b = b / 3;
        let direction = self.position(record.v1) - self.position(record.v0);
        record.word = self.normals.word([a / 3, b / 3], direction, clashes);
        let [ridge_steps, valley_steps] = self.crease_steps;
        record.word.insert(record.word.creases(ridge_steps, valley_steps));
        record.word.insert(self.attributes.borders(record.face_a, record.face_b));
        record.word.set(EdgeFlags::CLASH, clashes);
        record
    }

    fn position(&self, vertex: u32) -> DVec3 {
        Vec3::from(self.positions[vertex as usize]).as_dvec3()
    }

    /// Splits the faces of an edge into pairs around solid matter; a face without a partner gets a
    /// separate record. Classes that the model states concern all pairs alike.
    fn split(
        &self,
        [low, high]: [u32; 2],
        sides: &[u32],
        stated: Option<EdgeFlags>,
        twins: &[AtomicU32],
        records: &mut Vec<EdgeRecord>,
    ) {
        let around = self.sorted_by_angle(low, high, sides);
        let runs_up = |side: u32| triangle_side(self.triangles, side)[0] == low;
        let count = around.len();
        let mut is_paired = vec![false; count];
        for at in 0..count {
            // Angles grow clockwise about the axis, and the normal of a face that runs up points
            // the other way: its matter lies at larger angles, up to a face that runs down.
            let next = (at + 1) % count;
            if runs_up(around[at]) && !runs_up(around[next]) && !is_paired[next] {
                is_paired[at] = true;
                is_paired[next] = true;
                join(twins, around[at], around[next]);
                let mut record = self.joined(around[at], around[next], false);
                if stated.unwrap_or(record.flags()).intersects(EdgeFlags::ALWAYS_DRAWN) {
                    // A feature, whose class belongs to one pair only.
                    record.word = EdgeFlags::NON_MANIFOLD.into();
                } else {
                    record.word.set(EdgeFlags::ALWAYS_DRAWN, false);
                    record.word.insert(EdgeFlags::PAIRED);
                }
                records.push(record);
            }
        }
        for (at, &side) in around.iter().enumerate() {
            if !is_paired[at] {
                records.push(self.single(side, EdgeFlags::NON_MANIFOLD));
            }
        }
    }

    /// The sides of an edge, sorted by the direction of their faces around it, then by face.
    ///
    /// Faces in one direction touch: those with their matter before them come first, so that there
    /// is none between them. That holds for two bodies in contact and for both sides of a sheet.
    fn sorted_by_angle(&self, low: u32, high: u32, sides: &[u32]) -> Vec<u32> {
        let origin = self.position(low);
        let axis = (self.position(high) - origin).normalize_or_zero();
        let arm = |side: u32| {
            let apex = self.triangles[side as usize / 3][(side as usize + 2) % 3];
            let arm = self.position(apex) - origin;
            arm - axis * arm.dot(axis)
        };
        // Angles from a face have no jump at a face that touches it.
        let across = sides.first().map_or(DVec3::X, |&side| arm(side)).normalize_or(DVec3::X);
        let upright = axis.cross(across);
        let clockwise = |side: u32| {
            let arm = arm(side);
            let angle = f64::atan2(-arm.dot(upright), arm.dot(across));
            if angle < -TOUCHING_RAD { angle + std::f64::consts::TAU } else { angle }
        };
        let mut keyed: Vec<(f64, u32)> =
            sides.iter().map(|&side| (clockwise(side), side)).collect();
        keyed.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let runs_up = |side: u32| triangle_side(self.triangles, side)[0] == low;
        for touching in keyed.chunk_by_mut(|a, b| b.0 - a.0 < TOUCHING_RAD) {
            touching.sort_by_key(|&(_, side)| (runs_up(side), side));
        }
        keyed.into_iter().map(|(_, side)| side).collect()
    }
}

/// Makes two sides each other's twins.
fn join(twins: &[AtomicU32], a: u32, b: u32) {
    twins[a as usize].store(b, Ordering::Relaxed);
    twins[b as usize].store(a, Ordering::Relaxed);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::{BuildOptions, build_edge_mesh};
    use crate::model::Model;
    use crate::report::Report;

    fn records_of(positions: &[[f32; 3]], polygons: &[&[u32]]) -> Vec<EdgeRecord> {
        let model = Model::from_polygons(positions, polygons);
        build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default()).records
    }

    /// Two triangles folded along 0-1, the second one's apex up or down.
    fn fold(apex_z: f32) -> EdgeFlags {
        let positions = [[0., 0., 0.], [0., 1., 0.], [-1., 0., 0.], [1., 0., apex_z]];
        // The normal of the first face is +z.
        let records = records_of(&positions, &[&[0, 1, 2], &[0, 3, 1]]);
        records.iter().find(|record| record.face_b != NONE).unwrap().flags()
    }

    #[test]
    fn up_is_a_valley_down_is_a_ridge_flat_is_neither() {
        assert_eq!(fold(1.0), EdgeFlags::VALLEY);
        assert_eq!(fold(-1.0), EdgeFlags::RIDGE);
        assert_eq!(fold(0.0), EdgeFlags::empty());
        // 30 degrees: tan is 0.577.
        assert_eq!(fold(-0.57), EdgeFlags::empty());
        assert_eq!(fold(-0.58), EdgeFlags::RIDGE);
    }

    /// Two tetrahedra that share the edge 0-1 and nothing else.
    #[test]
    fn two_solids_on_one_edge_become_two_pairs() {
        let positions = [
            [0., 0., 0.],
            [0., 0., 1.],
            [1., 0.2, 0.],
            [1., -0.2, 0.],
            [-1., 0.2, 0.],
            [-1., -0.2, 0.],
        ];
        let solid = |a: u32, b: u32| [[0, 1, a], [1, 0, b], [0, a, b], [1, b, a]];
        let faces: Vec<[u32; 3]> = [solid(2, 3), solid(5, 4)].concat();
        let polygons: Vec<&[u32]> = faces.iter().map(<[u32; 3]>::as_slice).collect();
        let records = records_of(&positions, &polygons);
        let split: Vec<_> = records
            .iter()
            .filter(|record| record.flags().contains(EdgeFlags::NON_MANIFOLD))
            .map(|record| (record.face_a / 4, record.face_b / 4))
            .collect();
        assert_eq!(split.len(), 2);
        for (solid_a, solid_b) in split {
            assert_eq!(solid_a, solid_b, "each pair belongs to one solid");
        }
    }

    #[test]
    fn an_odd_face_gets_a_record_of_its_own() {
        let positions = [[0., 0., 0.], [0., 0., 1.], [1., 0., 0.], [0., 1., 0.], [-1., -1., 0.]];
        let records = records_of(&positions, &[&[0, 1, 2], &[0, 1, 3], &[1, 0, 4]]);
        let split: Vec<_> =
            records.iter().filter(|r| r.flags().contains(EdgeFlags::NON_MANIFOLD)).collect();
        assert_eq!(split.len(), 2);
        assert_eq!(split.iter().filter(|record| record.face_b == NONE).count(), 1);
    }
}
