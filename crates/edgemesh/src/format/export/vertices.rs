//! The vertices and triangles of files whose vertices have all attributes.
//!
//! They are those of the fill, which has a vertex for each normal, texture coordinate and color at a
//! place, or those of the mesh.

use crate::edge_mesh::EdgeMesh;
use crate::index::{NONE, to_u32};

/// Vertices with their attributes, and triangles.
#[derive(Debug, Default)]
pub(super) struct Vertices {
    pub(super) positions: Vec<[f32; 3]>,
    /// Unit vectors, or zero.
    pub(super) normals: Vec<[f32; 3]>,
    /// From the lower left corner of a picture; empty if the mesh has none.
    pub(super) texcoords: Vec<[f32; 2]>,
    /// Display values, coded as sRGB, with opacity; empty if the mesh has none.
    pub(super) colors: Vec<[u8; 4]>,
    /// In the order of the mesh.
    pub(super) triangles: Vec<[u32; 3]>,
    /// A vertex at the position of each vertex of the mesh; empty if the vertices are the same.
    of_mesh: Vec<u32>,
}

impl Vertices {
    /// The vertices of the fill if it has texture coordinates or colors, otherwise those of the
    /// mesh.
    pub(super) fn of(mesh: &EdgeMesh) -> Self {
        let has_texcoords = mesh.fill.runs.iter().any(|run| run.has_texcoords == 1);
        match has_texcoords || !mesh.fill.colors.is_empty() {
            true => Self::of_fill(mesh),
            false => Self {
                positions: mesh.positions.clone(),
                normals: mesh.vertex_normals.clone(),
                triangles: mesh.triangles.clone(),
                ..Self::default()
            },
        }
    }

    /// The vertices of the fill, and those of the mesh that no triangle has.
    pub(super) fn of_fill(mesh: &EdgeMesh) -> Self {
        let fill = &mesh.fill;
        let has_texcoords = fill.runs.iter().any(|run| run.has_texcoords == 1);
        let textured = fill.vertices.iter().filter(|_| has_texcoords);
        let mut vertices = Self {
            positions: fill.vertices.iter().map(|vertex| vertex.position).collect(),
            normals: fill.vertices.iter().map(|vertex| vertex.normal).collect(),
            texcoords: textured.map(|vertex| vertex.texcoord).collect(),
            colors: fill.colors.clone(),
            triangles: fill.indices.as_chunks().0.to_vec(),
            of_mesh: vec![NONE; mesh.positions.len()],
        };
        for (triangle, corners) in mesh.triangles.iter().zip(&vertices.triangles) {
            for (&vertex, &corner) in triangle.iter().zip(corners) {
                vertices.of_mesh[vertex as usize] = corner;
            }
        }
        vertices.add_missing(mesh);
        vertices
    }

    /// Adds the vertices of the mesh that no triangle has: the ends of lines.
    fn add_missing(&mut self, mesh: &EdgeMesh) {
        for (vertex, stored) in self.of_mesh.iter_mut().enumerate() {
            if *stored == NONE {
                *stored = to_u32(self.positions.len());
                self.positions.push(mesh.positions[vertex]);
                self.normals.push(mesh.vertex_normals[vertex]);
                if !self.texcoords.is_empty() {
                    self.texcoords.push([0.0; 2]);
                }
                if !self.colors.is_empty() {
                    self.colors.push([u8::MAX; 4]);
                }
            }
        }
    }

    /// A vertex at the position of a vertex of the mesh.
    pub(super) fn stored(&self, vertex: u32) -> u32 {
        self.of_mesh.get(vertex as usize).copied().unwrap_or(vertex)
    }
}
