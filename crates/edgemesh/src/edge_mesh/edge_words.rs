//! Computes the [`EdgeWord`] of every edge of a mesh from the positions of its faces.

use glam::DVec3;
use rayon::prelude::*;

use crate::edge_mesh::EdgeMesh;
use crate::edge_mesh::edge_flags::EdgeFlags;
use crate::edge_mesh::edge_word::EdgeWord;
use crate::edge_mesh::face_normal::{corners_of, face_normal};
use crate::edge_mesh::record::EdgeRecord;
use crate::index::NONE;

/// The words of all records of a mesh, in order.
#[must_use]
pub fn edge_words(mesh: &EdgeMesh) -> Vec<EdgeWord> {
    mesh.records.par_iter().with_min_len(1 << 12).map(|record| edge_word(mesh, record)).collect()
}

fn edge_word(mesh: &EdgeMesh, record: &EdgeRecord) -> EdgeWord {
    let never = EdgeFlags::NON_MANIFOLD | EdgeFlags::DIAGONAL;
    if record.face_b == NONE || record.face_a == NONE || record.flags.intersects(never) {
        return record.flags.into();
    }
    // From positions, because faces without area have the planes of their neighbors.
    let [normal_a, mut normal_b] = [record.face_a, record.face_b]
        .map(|face| face_normal(corners_of(&mesh.positions, mesh.triangles[face as usize])));
    if normal_a == DVec3::ZERO || normal_b == DVec3::ZERO {
        return record.flags.into();
    }
    if record.flags.contains(EdgeFlags::CLASH) {
        normal_b = -normal_b;
    }
    // The arc cosine is imprecise near 0.
    let angle_rad = normal_a.cross(normal_b).length().atan2(normal_a.dot(normal_b));
    let point = |vertex: u32| glam::Vec3::from(mesh.positions[vertex as usize]).as_dvec3();
    let across = point(mesh.apex(record.face_b, record)) - point(record.v0);
    EdgeWord::new(record.flags, angle_rad, across.dot(normal_a) > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::{BuildOptions, build_edge_mesh};
    use crate::edge_mesh::edge_word::STEPS_PER_DEGREE;
    use crate::model::Model;
    use crate::report::Report;

    /// Two triangles folded along 0-1, the second one's apex up or down.
    fn fold(apex_z: f32) -> EdgeWord {
        let positions = [[0., 0., 0.], [0., 1., 0.], [-1., 0., 0.], [1., 0., apex_z]];
        let model = Model::from_polygons(&positions, &[&[0, 1, 2], &[0, 3, 1]]);
        let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default());
        let inner = mesh.records.iter().position(|record| record.face_b != NONE).unwrap();
        edge_words(&mesh)[inner]
    }

    #[test]
    fn a_fold_keeps_its_angle_and_its_side() {
        for (apex_z, degrees, is_concave) in [(1.0, 45, true), (-1.0, 45, false), (0.0, 0, false)] {
            let word = fold(apex_z);
            assert_eq!(word.crease_steps(), degrees * STEPS_PER_DEGREE);
            assert_eq!(word.is_concave(), is_concave);
        }
    }
}
