//! Errors of the readers.

use std::fmt;

use crate::report::{Place, Report, WarningCode, place_in};

/// The kind of a [`ReadError`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ReadErrorKind {
    /// The operating system reported an error.
    Io,
    /// The file has no bytes, or no faces and no lines.
    Empty,
    /// The file is not a model in a supported format or version.
    Format,
    /// More bytes or elements than the limits allow.
    Size,
    /// A face names a vertex that does not exist.
    Index,
    /// A coordinate is not a number.
    Number,
    /// The file ends too early.
    Truncated,
    /// The file breaks a rule of its format.
    Syntax,
    /// A range of bytes leaves the data that it refers to.
    Bounds,
    /// A node or file contains itself.
    Cycle,
    /// The file requires an unsupported extension.
    Extension,
    /// Another file that the model needs is missing or may not be opened.
    Uri,
    /// A bug in a reader.
    Internal,
}

impl ReadErrorKind {
    /// The kind as a lower-case word, such as `truncated`.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Io => "io",
            Self::Empty => "empty",
            Self::Format => "format",
            Self::Size => "size",
            Self::Index => "index",
            Self::Number => "number",
            Self::Truncated => "truncated",
            Self::Syntax => "syntax",
            Self::Bounds => "bounds",
            Self::Cycle => "cycle",
            Self::Extension => "extension",
            Self::Uri => "uri",
            Self::Internal => "internal",
        }
    }
}

/// A model could not be read. Displayed as `model.obj:12: what is wrong`.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct ReadError {
    /// What kind of error it is.
    pub kind: ReadErrorKind,
    /// The path of the file, as the caller or the model gave it.
    pub file: String,
    /// The place in the file; `None` for the whole file.
    pub place: Option<Place>,
    /// What is wrong, and what to do about it.
    pub what: String,
}

impl ReadError {
    /// Turns the error into a warning: only a part of the model was left out.
    pub(super) fn warn_left_out(self, report: &mut Report) {
        let code = match self.kind {
            ReadErrorKind::Uri => WarningCode::Uri,
            _ => WarningCode::Syntax,
        };
        report.warn(code, self.place, || format!("{}; it was left out", self.what));
    }
}

impl fmt::Display for ReadError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}: {}", place_in(&self.file, self.place.as_ref()), self.what)
    }
}

impl std::error::Error for ReadError {}
