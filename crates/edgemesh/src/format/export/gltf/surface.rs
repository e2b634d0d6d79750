//! The vertices and triangles of a file.
//!
//! A mesh with a fill is written with the vertices of the fill, which have the normals for shading
//! and the texture coordinates and colors; one without is written with its own. The triangles of each material
//! are a primitive, in their order. The vertices of each part of a rig are apart.

use indexmap::{IndexMap, IndexSet};
use rustc_hash::FxBuildHasher;

use super::super::face_runs::face_runs;
use super::super::vertices::Vertices;
use super::faces::PrimitiveFaces;
use crate::edge_mesh::EdgeMesh;
use crate::index::{NONE, to_u32};
use crate::model::{MeshRig, Pose};

/// The vertices and triangles of a file.
#[derive(Debug)]
pub(super) struct Surface {
    /// One, or one for each part of a rig; a part that is not drawn is empty.
    pub(super) parts: Vec<Vertices>,
    /// For each vertex of each part of a rig, the vertex of the rig.
    pub(super) rig_vertices: Vec<Vec<u32>>,
    /// The corners of each triangle of the mesh, as vertices of its part.
    pub(super) corners: Vec<[u32; 3]>,
    pub(super) faces: PrimitiveFaces,
    /// The part and the material, or [`NONE`], of each primitive.
    pub(super) primitives: Vec<(usize, u32)>,
}

impl Surface {
    /// The surface of a mesh.
    pub(super) fn of(mesh: &EdgeMesh) -> Self {
        let mut vertices = match mesh.fill.indices.is_empty() {
            true => Vertices::of(mesh),
            false => Vertices::of_fill(mesh),
        };
        let corners = std::mem::take(&mut vertices.triangles);
        let (faces, primitives) = sort_faces(mesh, |_| 0, &[false]);
        Self { parts: vec![vertices], rig_vertices: Vec::new(), corners, faces, primitives }
    }

    /// The surface of a mesh before its rig poses it.
    pub(super) fn of_rig(mesh: &EdgeMesh, own: &MeshRig) -> Self {
        let rig = &own.rig;
        let pose = rig.rest_pose();
        let is_mirrored: Vec<bool> = rig
            .parts
            .iter()
            .map(|part| rig.is_mirrored(&pose, part.node as usize, part.skin))
            .collect();
        let part_of = |face: usize| rig.part_of(own.corners[face][0]).min(rig.parts.len() - 1);
        let (faces, primitives) = sort_faces(mesh, part_of, &is_mirrored);
        let posed = match mesh.fill.indices.is_empty() {
            true => Vertices::of(mesh),
            false => Vertices::of_fill(mesh),
        };
        let mut parts = vec![UnposedPart::default(); rig.parts.len()];
        let corner = |part: usize, place: (u32, u32), parts: &mut Vec<UnposedPart>| {
            to_u32(parts[part].places.insert_full(place).0)
        };
        let corners = posed.triangles.iter().zip(&own.corners).enumerate();
        let corners = corners.map(|(face, (triangle, vertices))| {
            let part = part_of(face);
            [0, 1, 2].map(|k| corner(part, (triangle[k], vertices[k]), &mut parts))
        });
        let corners = corners.collect();
        let parts = parts.into_iter().enumerate();
        let (parts, rig_vertices) =
            parts.map(|(at, part)| part.vertices(&posed, own, &pose, at)).unzip();
        Self { parts, rig_vertices, corners, faces, primitives }
    }
}

/// The vertices of a part of a rig.
#[derive(Debug, Clone, Default)]
struct UnposedPart {
    /// The vertex in the rest pose, and the vertex of the rig.
    places: IndexSet<(u32, u32), FxBuildHasher>,
}

impl UnposedPart {
    /// The vertices before they are posed, and their vertices of the rig.
    fn vertices(
        self,
        posed: &Vertices,
        own: &MeshRig,
        pose: &Pose,
        part: usize,
    ) -> (Vertices, Vec<u32>) {
        let rig = &own.rig;
        let mut vertices = Vertices::default();
        for &(at, vertex) in &self.places {
            #[expect(clippy::cast_possible_truncation, reason = "positions of glTF have 32 bits")]
            vertices.positions.push(rig.positions[vertex as usize].map(|x| x as f32));
            // The rest pose multiplies normals by the inverse transpose.
            let linear = rig.vertex_transform(pose, &rig.parts[part], vertex).matrix3;
            let normal = glam::Vec3::from(posed.normals[at as usize]).as_dvec3();
            let normal = (linear.transpose() * normal).normalize_or_zero();
            vertices.normals.push(normal.as_vec3().to_array());
            vertices.texcoords.extend(posed.texcoords.get(at as usize));
            vertices.colors.extend(posed.colors.get(at as usize));
        }
        (vertices, self.places.into_iter().map(|(_, vertex)| vertex).collect())
    }
}

/// Sorts triangles by their part and material, in the order of their first use.
fn sort_faces(
    mesh: &EdgeMesh,
    part_of: impl Fn(usize) -> usize,
    is_mirrored: &[bool],
) -> (PrimitiveFaces, Vec<(usize, u32)>) {
    let mut numbers = IndexMap::<(usize, u32), u32, FxBuildHasher>::default();
    let mut of_faces = Vec::with_capacity(mesh.triangles.len());
    for (faces, run) in face_runs(mesh) {
        for face in faces {
            let next = to_u32(numbers.len());
            of_faces.push(*numbers.entry((part_of(face), run.material)).or_insert(next));
        }
    }
    let primitives: Vec<(usize, u32)> = numbers.into_keys().collect();
    let is_mirrored = primitives.iter().map(|&(part, _)| is_mirrored[part]).collect();
    (PrimitiveFaces::new(of_faces.into_iter(), is_mirrored), primitives)
}

/// The ends of the lines without a face.
pub(super) fn line_ends(mesh: &EdgeMesh) -> impl Iterator<Item = u32> {
    let loose = mesh.records.iter().filter(|record| record.face_a == NONE);
    loose.flat_map(|record| [record.v0, record.v1])
}
