//! Errors of loading.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

use super::marks::MarksError;
use crate::format::edge_mesh_file::FileError;
use crate::format::read::ReadError;
use crate::report::Report;

/// An input could not be loaded.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The model cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The edge mesh file is damaged or of an unsupported version.
    #[error("{file}: {reason}")]
    EdgeMeshFile {
        /// The file.
        file: String,
        /// The defect.
        reason: FileError,
    },
    /// The operating system cannot read the edge mesh file.
    #[error("{}: cannot be read: {reason}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The error of the operating system.
        reason: io::Error,
    },
    /// The file of marks cannot be read.
    #[error(transparent)]
    Marks(#[from] MarksError),
    /// Standard input needs [`LoadOptions::format`](super::LoadOptions::format), because the format
    /// of a stream is not detected.
    #[error("standard input needs a format, because the format of a stream is not detected")]
    FormatNeeded,
    /// The copies of instanced meshes are too many for one mesh.
    #[error(
        "{file}: too large: its instances have {elements} vertices and corners; the limit of one \
         mesh is {limit}: split the scene"
    )]
    TooManyCopies {
        /// The model or the edge mesh.
        file: String,
        /// Vertices and corners of the mesh with all copies.
        elements: usize,
        /// The most of one mesh.
        limit: usize,
    },
    /// The options ask for welding or marks, but the input is an edge mesh.
    #[error("{file}: welding and marks apply to models only; an edge mesh is already welded")]
    ModelsOnly {
        /// The edge mesh.
        file: String,
    },
    /// There are warnings, which [`LoadOptions::is_strict`](super::LoadOptions::is_strict) turns
    /// into errors. The message has a line for each kind of warning.
    #[error("{}", report.warning_lines(file, "").join("\n"))]
    Warnings {
        /// The file.
        file: String,
        /// The warnings.
        report: Report,
    },
    /// [`Progress::begin`](super::Progress::begin) canceled the work.
    #[error("canceled")]
    Canceled,
}
