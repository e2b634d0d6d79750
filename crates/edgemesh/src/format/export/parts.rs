//! What glTF alone has beside a mesh.

use crate::edge_mesh::InstancedMesh;
use crate::model::MeshRig;

/// What glTF alone has beside a mesh.
#[derive(Debug, Clone, Copy, Default)]
pub struct Parts<'a> {
    /// Skins and morph targets.
    pub rig: Option<&'a MeshRig>,
    /// Meshes in several places, in the frame of the mesh. For other formats they are loaded as
    /// copies in the mesh.
    pub instanced: &'a [InstancedMesh],
}
