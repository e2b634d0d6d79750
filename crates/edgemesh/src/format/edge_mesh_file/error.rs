//! Why an edge mesh file was not read or written.

use std::fmt;

use crate::report::Place;

/// The kind of a [`FileError`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileErrorKind {
    /// Not an edge mesh at all.
    Magic,
    /// Written by a newer program, or of a version that never was.
    Version,
    /// Fewer bytes than the file should have.
    Truncated,
    /// More bytes than the file should have.
    Excess,
    /// Something in the file was changed after it was written.
    Checksum,
    /// The section table is wrong: a section lies outside the file, is missing,
    /// stands twice, or its elements are of another size.
    Section,
    /// Sections contradict each other, or an index leads nowhere.
    Inconsistent,
    /// The JSON of section `META` is not understood.
    Meta,
    /// There is no memory for so large a file.
    Size,
    /// The picture of a texture, which becomes part of the file, cannot be read.
    Texture,
}

/// Why an edge mesh file was not read or written: what is wrong, where, and
/// what to do.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileError {
    /// The kind.
    pub kind: FileErrorKind,
    /// The byte of the file; `None` where the file as a whole is meant.
    pub place: Option<Place>,
    /// What is wrong and what to do.
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
    /// As it stands behind the file's name and a colon: `byte 56: ...`.
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
