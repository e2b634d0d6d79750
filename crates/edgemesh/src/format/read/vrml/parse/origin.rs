//! The file of a node: the model's file, or one that it inlines.

use std::path::{Path, PathBuf};

use crate::format::read::error::{ReadError, ReadErrorKind};
use crate::format::read::source::Source;
use crate::format::whole_file::folder_of;
use crate::report::{Place, Report, WarningCode};

/// A file of the scene.
#[derive(Debug)]
pub(crate) struct Origin {
    /// Its name in messages.
    name: String,
    /// The folder from which it may inline files; `None` for a stream.
    folder: Option<PathBuf>,
    /// Whether it is an inlined file.
    is_inlined: bool,
}

impl Origin {
    /// The model's file.
    pub(crate) fn of_model(source: &Source) -> Self {
        Self {
            name: source.name.into(),
            folder: source.folder.map(Path::to_owned),
            is_inlined: false,
        }
    }

    /// A file that this one inlines as `url`, with its path.
    pub(crate) fn inlined(&self, url: &str, path: &Path) -> Self {
        Self {
            name: Path::new(&self.name).with_file_name(url).display().to_string(),
            folder: Some(folder_of(path).into()),
            is_inlined: true,
        }
    }

    /// The file as a [`Source`] without bytes.
    pub(crate) fn source(&self) -> Source<'_> {
        Source { name: &self.name, folder: self.folder.as_deref(), bytes: &[] }
    }

    /// A line of this file, for a report about the model's file.
    pub(crate) fn place(&self, line: u32) -> Place {
        if self.is_inlined {
            Place::Part(format!("{}:{line}", self.name))
        } else {
            Place::Line(line)
        }
    }

    /// An error in a line of this file.
    pub(crate) fn error(
        &self,
        kind: ReadErrorKind,
        line: u32,
        what: impl Into<String>,
    ) -> ReadError {
        self.source().error(kind, Some(Place::Line(line)), what)
    }

    /// Adds a warning about a line of this file.
    pub(crate) fn warn(
        &self,
        report: &mut Report,
        code: WarningCode,
        line: u32,
        message: impl FnOnce() -> String,
    ) {
        report.warn(code, Some(self.place(line)), message);
    }
}
