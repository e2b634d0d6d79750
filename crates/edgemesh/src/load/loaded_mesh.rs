//! What loading gives.

use std::path::PathBuf;

use crate::edge_mesh::EdgeMesh;
use crate::report::Report;

/// An edge mesh with its name and its report.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct LoadedMesh {
    /// The name of the file in messages.
    pub name: String,
    /// The edge mesh.
    pub mesh: EdgeMesh,
    /// What was repaired or dropped.
    pub report: Report,
    /// The model's file; `None` for standard input and for edge mesh files.
    pub source: Option<ModelSource>,
}

/// The model file of an edge mesh.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct ModelSource {
    /// The file.
    pub path: PathBuf,
    /// For each vertex of the mesh a vertex of the file, counted from 0.
    pub file_vertices: Vec<u32>,
}

impl LoadedMesh {
    /// An edge mesh that comes from no file.
    #[must_use]
    pub const fn new(name: String, mesh: EdgeMesh, report: Report) -> Self {
        Self { name, mesh, report, source: None }
    }
}
