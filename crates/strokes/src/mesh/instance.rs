//! A mesh in its place.

use std::sync::Arc;

use glam::DMat4;

use crate::mesh::buffers::MeshBuffers;
use crate::mesh::geometry::{Geometry, SurfaceGeometry};

/// A mesh in its place in the scene. Cheap to clone: clones share the buffers.
#[derive(Debug, Clone)]
pub struct MeshInstance {
    mesh: Arc<MeshBuffers>,
    geometry: Arc<Geometry>,
    /// From positions of the mesh to the scene.
    pub world_from_object: DMat4,
}

impl MeshInstance {
    /// An instance of `mesh` without a pose.
    #[must_use]
    pub fn new(mesh: &Arc<MeshBuffers>, world_from_object: DMat4) -> Self {
        Self { mesh: mesh.clone(), geometry: mesh.rest().clone(), world_from_object }
    }

    /// The shared buffers.
    #[must_use]
    pub const fn mesh(&self) -> &Arc<MeshBuffers> {
        &self.mesh
    }

    /// Positions and normals of the surface; `None` without
    /// [`MeshOptions::surface`](crate::MeshOptions::surface).
    #[must_use]
    pub fn surface_geometry(&self) -> Option<&SurfaceGeometry> {
        self.geometry.surface.as_ref()
    }

    pub(crate) const fn geometry(&self) -> &Arc<Geometry> {
        &self.geometry
    }
}
