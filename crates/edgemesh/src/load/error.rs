//! Why an input could not be loaded.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

use super::marks::MarksError;
use crate::format::edge_mesh_file::FileError;
use crate::format::read::ReadError;
use crate::report::Report;

/// Why an input could not be loaded.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LoadError {
    /// A model cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// An edge mesh file cannot be read.
    #[error("{file}: {reason}")]
    EdgeMeshFile {
        /// The file.
        file: String,
        /// What is wrong with it.
        reason: FileError,
    },
    /// The operating system does not hand out an edge mesh file.
    #[error("{}: cannot be read: {reason}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the operating system said.
        reason: io::Error,
    },
    /// A file of marks cannot be read.
    #[error(transparent)]
    Marks(#[from] MarksError),
    /// Standard input was named without a format: a stream's format is not detected.
    #[error("the format of standard input is not detected; give it")]
    FormatNeeded,
    /// Welding or marks were asked for an edge mesh.
    #[error("{file}: an edge mesh is welded already; welding and marks are for models")]
    ModelsOnly {
        /// The edge mesh.
        file: String,
    },
    /// There are warnings, and [`LoadOptions::is_strict`](super::LoadOptions::is_strict)
    /// makes them errors. The text has a line for each kind of warning.
    #[error("{}", report.warning_lines(file, "").join("\n"))]
    Warnings {
        /// The file.
        file: String,
        /// The warnings.
        report: Report,
    },
    /// The [`Progress`](super::Progress) ended the work.
    #[error("it was canceled")]
    Canceled,
}
