//! Which file something stands in: the model's own, or one that it inlines.

use std::path::{Path, PathBuf};

use crate::format::read::error::{ReadError, ReadErrorKind};
use crate::format::read::source::{Source, folder_of};
use crate::report::{Place, Report, WarningCode};

/// A file of the scene.
#[derive(Debug)]
pub(super) struct Origin {
    /// Its name in messages.
    name: String,
    /// The folder that it may inline files from; `None` for a stream.
    folder: Option<PathBuf>,
    /// Whether it is another file than the one that was asked for.
    is_inlined: bool,
}

impl Origin {
    /// The model's own file.
    pub(super) fn of_model(source: &Source) -> Self {
        Self {
            name: source.name.into(),
            folder: source.folder.map(Path::to_owned),
            is_inlined: false,
        }
    }

    /// A file that this one inlines as `url`, which leads to `path`.
    pub(super) fn inlined(&self, url: &str, path: &Path) -> Self {
        Self {
            name: Path::new(&self.name).with_file_name(url).display().to_string(),
            folder: Some(folder_of(path).into()),
            is_inlined: true,
        }
    }

    /// The file as other readers see theirs, without its bytes.
    pub(super) fn source(&self) -> Source<'_> {
        Source { name: &self.name, folder: self.folder.as_deref(), bytes: &[] }
    }

    /// A line of this file, as it stands in a report on the model's own file.
    pub(super) fn place(&self, line: u32) -> Place {
        if self.is_inlined {
            Place::Part(format!("{}:{line}", self.name))
        } else {
            Place::Line(line)
        }
    }

    /// An error in a line of this file.
    pub(super) fn error(
        &self,
        kind: ReadErrorKind,
        line: u32,
        what: impl Into<String>,
    ) -> ReadError {
        self.source().error(kind, Some(Place::Line(line)), what)
    }

    /// Counts a warning about a line of this file.
    pub(super) fn warn(
        &self,
        report: &mut Report,
        code: WarningCode,
        line: u32,
        message: impl FnOnce() -> String,
    ) {
        report.warn(code, Some(self.place(line)), message);
    }
}
