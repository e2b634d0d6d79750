//! The record of each side of each face, for walks from face to face.
//!
//! Twelve bytes for each face. Together with the two faces of each record this equals a half-edge
//! structure, but also allows edges of more than two faces, which are several records.

use crate::edge_mesh::EdgeMesh;
use crate::edge_mesh::record::EdgeRecord;
use crate::edge_mesh::topology::triangle_side;
use crate::index::{NONE, to_u32};

/// The records of the sides of all faces: side k runs from corner k to corner k+1.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct FaceEdges(Vec<[u32; 3]>);

impl FaceEdges {
    /// Builds the table of a mesh.
    #[must_use]
    pub fn of(mesh: &EdgeMesh) -> Self {
        let mut sides = vec![[NONE; 3]; mesh.triangles.len()];
        for (edge, record) in mesh.records.iter().enumerate() {
            for face in [record.face_a, record.face_b].into_iter().filter(|&face| face != NONE) {
                if let Some(side) = side_on(mesh, face, record) {
                    sides[face as usize][side as usize] = to_u32(edge);
                }
            }
        }
        Self(sides)
    }

    /// The records of the sides of `face`; [`NONE`] for a side without a record, and for a face
    /// that does not exist.
    #[must_use]
    pub fn sides(&self, face: u32) -> [u32; 3] {
        self.0.get(face as usize).copied().unwrap_or([NONE; 3])
    }
}

/// The side of `face`, 0 to 2, on the edge of `record`.
#[must_use]
pub(crate) fn side_on(mesh: &EdgeMesh, face: u32, record: &EdgeRecord) -> Option<u32> {
    let ends = [record.v0, record.v1];
    (0..3).find(|side| {
        let [from, to] = triangle_side(&mesh.triangles, 3 * face + side);
        [from, to] == ends || [to, from] == ends
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::{BuildOptions, build_edge_mesh};
    use crate::model::Model;
    use crate::report::Report;

    fn mesh(polygons: &[&[u32]]) -> EdgeMesh {
        let corners = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.], [1., 1., 1.]];
        let model = Model::from_polygons(&corners, polygons);
        build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default())
    }

    #[test]
    fn every_side_finds_a_record_that_names_its_face_and_its_vertices() {
        // Closed; open; and three faces on one edge.
        let closed: [&[u32]; 4] = [&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]];
        for polygons in [&closed[..], &closed[..2], &[&[0, 1, 2], &[1, 0, 3], &[0, 1, 4]]] {
            let mesh = mesh(polygons);
            let table = FaceEdges::of(&mesh);
            for (face, triangle) in mesh.triangles.iter().enumerate() {
                for (side, edge) in table.sides(to_u32(face)).into_iter().enumerate() {
                    let record = mesh.records[edge as usize];
                    assert!([record.face_a, record.face_b].contains(&to_u32(face)));
                    let ends = [triangle[side], triangle[(side + 1) % 3]];
                    assert!(ends.iter().all(|end| [record.v0, record.v1].contains(end)));
                }
            }
        }
    }

    #[test]
    fn a_face_beyond_the_mesh_has_no_sides() {
        let table = FaceEdges::of(&mesh(&[&[0, 1, 2]]));
        assert_eq!(table.sides(7), [NONE; 3]);
    }
}
