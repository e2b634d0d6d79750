//! The result of loading.

use std::path::PathBuf;

use crate::edge_mesh::{Bounds, EdgeMesh, InstancedMesh, MeshCounts, bounds_with, counts_with};
use crate::model::MeshRig;
use crate::report::Report;

/// An edge mesh with its name and its report.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct LoadedMesh {
    /// The name of the input in messages.
    pub name: String,
    /// The edge mesh.
    pub mesh: EdgeMesh,
    /// Large meshes that the model has in several places, if
    /// [`LoadOptions::with_instances`](super::LoadOptions::with_instances) asks for them; otherwise
    /// `mesh` has copies.
    pub instanced: Vec<InstancedMesh>,
    /// Warnings and repairs.
    pub report: Report,
    /// The model file; `None` for standard input, [`DEMO`](super::DEMO) and edge mesh files.
    pub source: Option<ModelSource>,
    /// Skins and morph targets, if [`LoadOptions::with_rig`](super::LoadOptions::with_rig) asks for
    /// them and the model has any.
    pub rig: Option<MeshRig>,
}

/// The model file that an edge mesh was built from.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct ModelSource {
    /// Its path.
    pub path: PathBuf,
    /// For each vertex of the mesh, the first vertex of the file at its position, counted from 0.
    pub file_vertices: Vec<u32>,
    /// The same for each of [`LoadedMesh::instanced`].
    pub instanced_vertices: Vec<Vec<u32>>,
}

impl ModelSource {
    /// The source of a mesh without instances.
    #[must_use]
    pub const fn new(path: PathBuf, file_vertices: Vec<u32>) -> Self {
        Self { path, file_vertices, instanced_vertices: Vec::new() }
    }
}

impl LoadedMesh {
    /// An edge mesh without a model file.
    #[must_use]
    pub const fn new(name: String, mesh: EdgeMesh, report: Report) -> Self {
        Self { name, mesh, instanced: Vec::new(), report, source: None, rig: None }
    }

    /// The box around the mesh and all instances.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        bounds_with(&self.mesh, &self.instanced)
    }

    /// The counts of the mesh and all instances.
    #[must_use]
    pub fn counts(&self) -> MeshCounts {
        counts_with(&self.mesh, &self.instanced)
    }
}
