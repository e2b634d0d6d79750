//! Why a model could not be read.

use std::fmt;

use crate::report::{Place, place_in};

/// The kind of a [`ReadError`]; its text form is the `code` that scripts see.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReadErrorKind {
    /// The operating system refused.
    Io,
    /// Nothing to draw: no bytes, or no faces and no lines.
    Empty,
    /// Not a model file of a kind that is read.
    Format,
    /// More bytes or elements than are read.
    Size,
    /// A face names a vertex that is not there, or no vertex at all.
    Index,
    /// A coordinate is no number.
    Number,
    /// The file ends before all that it announces.
    Truncated,
    /// The text does not follow the rules of its format.
    Syntax,
    /// A range leaves the data that it is a part of.
    Bounds,
    /// Something contains itself.
    Cycle,
    /// The file requires an extension that is not read.
    Extension,
    /// A part of the model is elsewhere, and is missing or not to be opened.
    Uri,
    /// A fault of ours.
    Internal,
}

impl ReadErrorKind {
    /// The word that scripts see, as [`crate::report::WarningCode::as_str`].
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

/// Why a model could not be read: what is wrong, where, and what to do.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReadError {
    /// The kind.
    pub kind: ReadErrorKind,
    /// The file, as it was named.
    pub file: String,
    /// Where in it; `None` where the file as a whole is meant.
    pub place: Option<Place>,
    /// What is wrong and what to do.
    pub what: String,
}

impl fmt::Display for ReadError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}: {}", place_in(&self.file, self.place.as_ref()), self.what)
    }
}

impl std::error::Error for ReadError {}
