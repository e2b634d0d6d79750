//! The result of loading.

use std::path::PathBuf;

use crate::edge_mesh::EdgeMesh;
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
}

impl LoadedMesh {
    /// An edge mesh without a model file.
    #[must_use]
    pub const fn new(name: String, mesh: EdgeMesh, report: Report) -> Self {
        Self { name, mesh, report, source: None, rig: None }
    }
}
