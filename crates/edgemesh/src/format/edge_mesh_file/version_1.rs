//! Files of version 1, whose edge records have classes but no crease angles.
//!
//! The angles are computed from the positions, as the programs of that version did. The replicated
//! layouts of such files have them in another place, and are left out.

use std::borrow::Cow;
use std::ops::RangeInclusive;

use glam::{DVec3, Vec3};

use super::stored::StoredMesh;
use crate::edge_mesh::{EdgeFlags, EdgeRecord, EdgeWord, corners_of, face_normal};
use crate::index::NONE;

/// The angles of a groove.
const GROOVE_DEGREES: RangeInclusive<f64> = 1.0..=150.0;

/// The mesh of a file of version 1, whose indices are in range, as one of this version.
pub(super) fn with_crease_angles(mut mesh: StoredMesh) -> StoredMesh {
    let word = |record: &EdgeRecord| EdgeRecord { word: word_of(&mesh, record), ..*record };
    let records: Vec<EdgeRecord> = mesh.records.iter().map(word).collect();
    mesh.records = Cow::Owned(records);
    mesh.replicated_f32 = None;
    mesh.replicated_i16 = None;
    mesh
}

fn word_of(mesh: &StoredMesh, record: &EdgeRecord) -> EdgeWord {
    let flags = record.flags();
    if record.face_b == NONE || flags.intersects(EdgeFlags::NON_MANIFOLD | EdgeFlags::DIAGONAL) {
        return flags.into();
    }
    let normal =
        |face: u32| face_normal(corners_of(&mesh.positions, mesh.triangles[face as usize]));
    let [normal_a, mut normal_b] = [record.face_a, record.face_b].map(normal);
    if flags.contains(EdgeFlags::CLASH) {
        normal_b = -normal_b;
    }
    if normal_a == DVec3::ZERO || normal_b == DVec3::ZERO {
        return flags.into();
    }
    let turn = normal_a.cross(normal_b);
    let angle_rad = turn.length().atan2(normal_a.dot(normal_b));
    let [start, end] =
        [record.v0, record.v1].map(|vertex| Vec3::from(mesh.positions[vertex as usize]).as_dvec3());
    let is_concave = turn.dot(end - start) < 0.0;
    let is_groove = is_concave && GROOVE_DEGREES.contains(&angle_rad.to_degrees());
    let mut word = EdgeWord::new(flags, angle_rad, is_concave);
    word.set(EdgeFlags::GROOVE, is_groove && flags.contains(EdgeFlags::SOLID));
    word
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::{BuildOptions, build_edge_mesh};
    use crate::model::Model;
    use crate::report::Report;

    #[test]
    fn the_angles_are_those_of_the_builder() {
        // A roof of 60 degrees over a floor, and a face across a diagonal.
        let positions =
            [[0., 0., 0.], [2., 0., 0.], [2., 1., 1.], [0., 1., 1.], [1., -1., 1.], [1., 3., 0.5]];
        let model = Model::from_polygons(&positions, &[&[0, 1, 2, 3], &[1, 0, 4], &[3, 2, 5]]);
        let mut report = Report::default();
        let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut report);
        let mut old = StoredMesh::of(&mesh, "", &report);
        old.records.to_mut().iter_mut().for_each(|record| record.word = record.flags().into());
        let found = with_crease_angles(old).records.into_owned();
        for (found, expected) in found.iter().zip(&mesh.records) {
            assert_eq!(
                (found.flags(), found.word.is_concave()),
                (expected.flags(), expected.word.is_concave())
            );
            let steps = found.word.crease_steps().abs_diff(expected.word.crease_steps());
            assert!(steps <= 1, "{found:?} {expected:?}");
        }
        assert!(found.iter().any(|record| record.word.crease_steps() > 720));
    }
}
