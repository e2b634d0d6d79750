//! Errors of edge mesh files.

use std::fmt;

use crate::report::Place;

/// The kind of a [`FileError`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum FileErrorKind {
    /// Not an edge mesh file.
    Magic,
    /// Written by a newer program, or with an invalid version.
    Version,
    /// The file has too few bytes.
    Truncated,
    /// The file has too many bytes.
    Excess,
    /// The file was damaged after it was written.
    Checksum,
    /// The section table has a fault: a section lies outside the file, is missing, occurs
    /// twice, or has elements of another size.
    Section,
    /// Sections contradict each other, or an index is out of range.
    Inconsistent,
    /// The JSON of section `META` is malformed.
    Meta,
    /// There is not enough memory for the file.
    Size,
    /// The picture of a texture, which would be stored in the file, cannot be read.
    Texture,
}

/// An edge mesh file could not be read or written.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct FileError {
    /// What kind of error it is.
    pub kind: FileErrorKind,
    /// The byte of the file; `None` for the whole file.
    pub place: Option<Place>,
    /// What is wrong, and what to do about it.
    pub what: String,
}

impl FileError {
    pub(super) fn new(kind: FileErrorKind, what: impl Into<String>) -> Self {
        Self { kind, place: None, what: what.into() }
    }

    pub(super) fn at(kind: FileErrorKind, byte: u64, what: impl Into<String>) -> Self {
        Self { kind, place: Some(Place::Byte(byte)), what: what.into() }
    }
}

impl fmt::Display for FileError {
    /// The text that follows the file's name and a colon: `byte 56: ...`.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(Place::Byte(byte)) = self.place {
            write!(formatter, "byte {byte}: ")?;
        }
        formatter.write_str(&self.what)
    }
}

impl std::error::Error for FileError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_place_stands_before_the_message() {
        let error = FileError::at(FileErrorKind::Section, 56, "no such part");
        assert_eq!(format!("a.edgemesh: {error}"), "a.edgemesh: byte 56: no such part");
        assert_eq!(FileError::new(FileErrorKind::Checksum, "damaged").to_string(), "damaged");
    }
}
