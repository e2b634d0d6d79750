//! Makes the edge records: two faces each, with the classes that no view changes.
//!
//! An edge of more than two faces is split into pairs of neighbours around the
//! edge, so that each record is manifold: going around by dihedral angle, a
//! face that bounds solid matter on its far side is paired with the next one
//! that bounds it on its near side. Two cubes that touch along an edge become
//! two plain edges of a cube.
//!
//! Rejected: refusing such meshes, as half-edge structures do; pairing in file
//! order, which joins faces through one another.
//!
//! ```text
//!        b | c          around the edge (seen along v0 -> v1):
//!    solid | solid      pairs (a, b) and (c, d), each around its own solid
//!      ----e----
//!        a | d
//! ```

use glam::{DVec3, Vec3};

use super::BuildOptions;
use super::corners::UnionFind;
use super::normals::corners_of;
use crate::index::NONE;
use crate::record::{EdgeFlags, EdgeRecord};
use crate::topology::{EdgeTable, triangle_side};

/// What the records are made from.
#[derive(Debug)]
pub(crate) struct RecordInput<'a> {
    pub(crate) positions: &'a [[f32; 3]],
    pub(crate) triangles: &'a [[u32; 3]],
    pub(crate) normals: &'a [Option<DVec3>],
    /// Material index of each face.
    pub(crate) materials: &'a [u32],
    /// Whether each side (3 f + k) is a polygon's diagonal.
    pub(crate) is_diagonal: &'a [bool],
    /// Edges whose two faces clash, ascending.
    pub(crate) clashes: &'a [u32],
}

/// Builds the records of all edges in the order of `table`.
pub(crate) fn build_records(
    input: &RecordInput,
    table: &EdgeTable,
    options: &BuildOptions,
) -> Vec<EdgeRecord> {
    let mut records = Vec::with_capacity(table.edge_count());
    for (edge, (ends, sides)) in table.iter().enumerate() {
        match *sides {
            [only] => records.push(input.single(only, EdgeFlags::BOUNDARY)),
            [a, b] => {
                let clashes = input.clashes.binary_search(&crate::index::to_u32(edge)).is_ok();
                records.push(input.pair(a, b, clashes, options));
            }
            _ => input.split(ends, sides, &mut records),
        }
    }
    records
}

/// Marks the edges of closed components whose faces look outwards.
///
/// A component is closed where each of its edges has two faces that wind the
/// same way, and looks outwards where the volume it encloses is positive.
pub(crate) fn mark_solids(
    positions: &[[f32; 3]],
    triangles: &[[u32; 3]],
    records: &mut [EdgeRecord],
) {
    let opens = EdgeFlags::BOUNDARY | EdgeFlags::NON_MANIFOLD | EdgeFlags::CLASH;
    let mut sets = UnionFind::new(triangles.len());
    for record in records.iter().filter(|record| record.face_b != NONE) {
        sets.join(record.face_a as usize, record.face_b as usize);
    }
    // Six times the volume between each component and the first vertex.
    let origin = positions.first().map_or(DVec3::ZERO, |&first| Vec3::from(first).as_dvec3());
    let mut volumes = vec![0.0; triangles.len()];
    for (face, &triangle) in triangles.iter().enumerate() {
        let [a, b, c] = corners_of(positions, triangle).map(|corner| corner - origin);
        volumes[sets.root(face)] += a.dot(b.cross(c));
    }
    let mut is_closed = vec![true; triangles.len()];
    for record in records.iter().filter(|record| record.flags.intersects(opens)) {
        is_closed[sets.root(record.face_a as usize)] = false;
        if record.face_b != NONE {
            is_closed[sets.root(record.face_b as usize)] = false;
        }
    }
    for record in records {
        let component = sets.root(record.face_a as usize);
        let is_solid = is_closed[component] && volumes[component] > 0.0;
        record.flags.set(EdgeFlags::SOLID, is_solid);
    }
}

/// Whether an edge is nothing but a polygon's diagonal: both of its faces say so.
pub(crate) fn is_diagonal_edge(sides: &[u32], is_diagonal: &[bool]) -> bool {
    matches!(sides, [a, b] if is_diagonal[*a as usize] && is_diagonal[*b as usize])
}

impl RecordInput<'_> {
    fn single(&self, side: u32, flags: EdgeFlags) -> EdgeRecord {
        let [v0, v1] = triangle_side(self.triangles, side);
        EdgeRecord { v0, v1, face_a: side / 3, face_b: NONE, flags }
    }

    /// The record of an edge with two faces; A is the one that runs from the
    /// smaller vertex to the larger.
    fn pair(&self, first: u32, second: u32, clashes: bool, options: &BuildOptions) -> EdgeRecord {
        let [start, end] = triangle_side(self.triangles, first);
        let (a, b) = if start < end || clashes { (first, second) } else { (second, first) };
        let mut record = self.single(a, EdgeFlags::empty());
        record.face_b = b / 3;
        record.flags.set(EdgeFlags::CLASH, clashes);
        if is_diagonal_edge(&[a, b], self.is_diagonal) {
            record.flags |= EdgeFlags::DIAGONAL;
            return record;
        }
        record.flags |= self.crease(&record, b, options);
        let differs =
            self.materials[record.face_a as usize] != self.materials[record.face_b as usize];
        record.flags.set(EdgeFlags::MATERIAL, differs);
        record
    }

    /// Ridge or valley by Equation 1, the thresholds read as angles between
    /// the face normals: `n_A . n_B < cos(threshold)`.
    fn crease(&self, record: &EdgeRecord, side_b: u32, options: &BuildOptions) -> EdgeFlags {
        let (Some(normal_a), Some(mut normal_b)) =
            (self.normals[record.face_a as usize], self.normals[record.face_b as usize])
        else {
            return EdgeFlags::empty();
        };
        if record.flags.contains(EdgeFlags::CLASH) {
            normal_b = -normal_b;
        }
        // (v3 - v2) . n_A has the sign of (v3 - v0) . n_A, since v2 lies in A.
        let apex_b = self.triangles[record.face_b as usize][(side_b as usize + 2) % 3];
        let is_concave = (self.position(apex_b) - self.position(record.v0)).dot(normal_a) > 0.0;
        let cosine = normal_a.dot(normal_b);
        if is_concave && cosine < options.valley_angle_rad.cos() {
            EdgeFlags::VALLEY
        } else if !is_concave && cosine < options.ridge_angle_rad.cos() {
            EdgeFlags::RIDGE
        } else {
            EdgeFlags::empty()
        }
    }

    fn position(&self, vertex: u32) -> DVec3 {
        Vec3::from(self.positions[vertex as usize]).as_dvec3()
    }

    /// Splits the faces of one edge into pairs around solid matter; a face that
    /// finds no partner gets a record of its own.
    fn split(&self, [low, high]: [u32; 2], sides: &[u32], records: &mut Vec<EdgeRecord>) {
        let around = self.sorted_by_angle(low, high, sides);
        let runs_up = |side: u32| triangle_side(self.triangles, side)[0] == low;
        let count = around.len();
        let mut is_paired = vec![false; count];
        for at in 0..count {
            // Angles grow clockwise about the axis, and the normal of a face
            // that runs up is turned the other way: its matter lies at larger
            // angles than the face itself, up to a face that runs down.
            let next = (at + 1) % count;
            if runs_up(around[at]) && !runs_up(around[next]) && !is_paired[next] {
                is_paired[at] = true;
                is_paired[next] = true;
                let mut record = self.single(around[at], EdgeFlags::NON_MANIFOLD);
                record.face_b = around[next] / 3;
                records.push(record);
            }
        }
        for (at, &side) in around.iter().enumerate() {
            if !is_paired[at] {
                records.push(self.single(side, EdgeFlags::NON_MANIFOLD));
            }
        }
    }

    /// The sides of an edge by the angle of their faces around it; equal angles
    /// keep the order of the faces.
    fn sorted_by_angle(&self, low: u32, high: u32, sides: &[u32]) -> Vec<u32> {
        let origin = self.position(low);
        let axis = (self.position(high) - origin).normalize_or_zero();
        let across = axis.any_orthonormal_vector();
        let upright = axis.cross(across);
        let mut keyed: Vec<(f64, u32)> = sides
            .iter()
            .map(|&side| {
                let apex = self.triangles[side as usize / 3][(side as usize + 2) % 3];
                let arm = self.position(apex) - origin;
                // Clockwise about the axis.
                (f64::atan2(-arm.dot(upright), arm.dot(across)), side)
            })
            .collect();
        keyed.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        keyed.into_iter().map(|(_, side)| side).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::build_edge_mesh;
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
        records.iter().find(|record| record.face_b != NONE).unwrap().flags
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
            .filter(|record| record.flags.contains(EdgeFlags::NON_MANIFOLD))
            .map(|record| (record.face_a / 4, record.face_b / 4))
            .collect();
        assert_eq!(split.len(), 2);
        for (solid_a, solid_b) in split {
            assert_eq!(solid_a, solid_b, "each pair belongs to one solid");
        }
    }

    #[test]
    fn closed_and_outward_is_solid() {
        let corners = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]];
        let outward: [&[u32]; 4] = [&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[0, 3, 2]];
        let inward: [&[u32]; 4] = [&[0, 1, 2], &[0, 3, 1], &[1, 3, 2], &[0, 2, 3]];
        let solid_count = |polygons: &[&[u32]]| {
            let records = records_of(&corners, polygons);
            records.iter().filter(|record| record.flags.contains(EdgeFlags::SOLID)).count()
        };
        assert_eq!(solid_count(&outward), 6);
        assert_eq!(solid_count(&inward), 0);
        assert_eq!(solid_count(&outward[..3]), 0, "open");
    }

    #[test]
    fn an_odd_face_gets_a_record_of_its_own() {
        let positions = [[0., 0., 0.], [0., 0., 1.], [1., 0., 0.], [0., 1., 0.], [-1., -1., 0.]];
        let records = records_of(&positions, &[&[0, 1, 2], &[0, 1, 3], &[1, 0, 4]]);
        let split: Vec<_> =
            records.iter().filter(|r| r.flags.contains(EdgeFlags::NON_MANIFOLD)).collect();
        assert_eq!(split.len(), 2);
        assert_eq!(split.iter().filter(|record| record.face_b == NONE).count(), 1);
    }
}
