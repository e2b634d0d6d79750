//! A mesh in its place.

use std::sync::Arc;

use glam::DMat4;

use crate::mesh::buffers::MeshBuffers;
use crate::mesh::geometry::Geometry;

/// A mesh in its place in the scene. Cheap to clone: clones share the mesh on the GPU.
#[derive(Debug, Clone)]
pub struct MeshInstance {
    mesh: Arc<MeshBuffers>,
    geometry: Arc<Geometry>,
    /// Takes positions of the mesh to the scene.
    pub world_from_object: DMat4,
}

impl MeshInstance {
    /// An instance of `mesh`, at rest.
    #[must_use]
    pub fn new(mesh: &Arc<MeshBuffers>, world_from_object: DMat4) -> Self {
        Self { mesh: mesh.clone(), geometry: mesh.rest().clone(), world_from_object }
    }

    /// The mesh.
    #[must_use]
    pub const fn mesh(&self) -> &Arc<MeshBuffers> {
        &self.mesh
    }

    /// Its positions and normals.
    #[must_use]
    pub const fn geometry(&self) -> &Arc<Geometry> {
        &self.geometry
    }
}
