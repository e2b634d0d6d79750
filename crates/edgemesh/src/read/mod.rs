//! Reads model files; every reader stands behind the checks of this module.
//!
//! Before a parser sees a byte: the path must lead to a file, the file must not
//! be empty or too large, and its first bytes must not be those of something
//! else. Errors name the file, the line where there is one, and what to do.

mod mtl;
mod obj;
mod obj_screen;

use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::model::Model;
use crate::report::Report;

/// The largest file that is read: 4 GiB. A model of [`crate::index::MAX_INDEX`]
/// corners needs more than that as text, so nothing sound is lost.
pub const MAX_FILE_BYTES: u64 = 4 << 30;

/// How much of a file is read before its kind is judged.
const SNIFF_BYTES: u64 = 64 << 10;

/// Why a model could not be read.
#[derive(Debug, Error)]
pub enum ReadError {
    /// The operating system refused.
    #[error("{}: cannot be read: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The path names a folder.
    #[error("{}: is a folder; name a model file in it", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
    },
    /// Nothing to draw: no bytes, or no faces.
    #[error("{}: {what}", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
        /// What is missing, and what was there instead.
        what: String,
    },
    /// Not a model file of a kind that is read.
    #[error("{}: is not an OBJ file but {found}", path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// What it is, and what to do.
        found: String,
    },
    /// Larger than [`MAX_FILE_BYTES`], or more corners than indices can name.
    #[error("{}: too large: {what}", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// What was counted, and the limit.
        what: String,
    },
    /// A face names a vertex that is not there, or no vertex at all.
    #[error("{}:{line}: {what}", path.display())]
    Index {
        /// The file.
        path: PathBuf,
        /// The line, counted from 1.
        line: u32,
        /// What is wrong.
        what: String,
    },
    /// A coordinate is no number.
    #[error("{}:{line}: {what}", path.display())]
    Number {
        /// The file.
        path: PathBuf,
        /// The line, counted from 1.
        line: u32,
        /// What is wrong.
        what: String,
    },
    /// The parser refused what the checks let through: a fault of ours.
    #[error("{}: internal error in the OBJ reader ({what}); please report it with the file", path.display())]
    Internal {
        /// The file.
        path: PathBuf,
        /// What the parser said.
        what: String,
    },
}

impl ReadError {
    /// The word that scripts see, as [`crate::report::WarningCode::as_str`].
    #[must_use]
    pub const fn code(&self) -> &'static str {
        match self {
            Self::Io { .. } | Self::Folder { .. } => "io",
            Self::Empty { .. } => "empty",
            Self::Format { .. } => "format",
            Self::TooLarge { .. } => "size",
            Self::Index { .. } => "index",
            Self::Number { .. } => "number",
            Self::Internal { .. } => "internal",
        }
    }
}

/// Reads the OBJ file at `path`, with what had to be dropped in the [`Report`].
///
/// Material libraries are read where they lie in the model's folder or below.
///
/// # Errors
/// [`ReadError`], when nothing sound can be made of the file.
pub fn read_model(path: &Path) -> Result<(Model, Report), ReadError> {
    let bytes = read_bytes(path)?;
    obj::read_obj(path, &bytes)
}

fn read_bytes(path: &Path) -> Result<Vec<u8>, ReadError> {
    let io_error = |source| ReadError::Io { path: path.into(), source };
    let mut file = File::open(path).map_err(io_error)?;
    let metadata = file.metadata().map_err(io_error)?;
    if metadata.is_dir() {
        return Err(ReadError::Folder { path: path.into() });
    }
    if metadata.len() > MAX_FILE_BYTES {
        let what = format!("{} bytes, at most {MAX_FILE_BYTES} are read", metadata.len());
        return Err(ReadError::TooLarge { path: path.into(), what });
    }
    let mut bytes = Vec::new();
    file.by_ref().take(SNIFF_BYTES).read_to_end(&mut bytes).map_err(io_error)?;
    if bytes.is_empty() {
        return Err(ReadError::Empty { path: path.into(), what: "the file is empty".into() });
    }
    if let Some(found) = sniff_other_format(&bytes) {
        return Err(ReadError::Format { path: path.into(), found: found.into() });
    }
    file.take(MAX_FILE_BYTES).read_to_end(&mut bytes).map_err(io_error)?;
    if bytes.len() as u64 >= MAX_FILE_BYTES {
        let what = format!("at most {MAX_FILE_BYTES} bytes are read");
        return Err(ReadError::TooLarge { path: path.into(), what });
    }
    Ok(bytes)
}

/// Says what a file is whose first bytes are `head`, if it is surely no OBJ.
fn sniff_other_format(head: &[u8]) -> Option<&'static str> {
    const MAGIC: [(&[u8], &str); 14] = [
        (b"\x1f\x8b", "gzip data: unpack it first (gunzip)"),
        (b"\x89PNG", "a PNG picture"),
        (b"\xff\xd8\xff", "a JPEG picture"),
        (b"GIF8", "a GIF picture"),
        (b"%PDF", "a PDF document"),
        (b"PK\x03\x04", "a ZIP archive: unpack it first"),
        (b"BZh", "bzip2 data: unpack it first"),
        (b"\xff\xfe", "UTF-16 text: save it as UTF-8"),
        (b"\xfe\xff", "UTF-16 text: save it as UTF-8"),
        (b"glTF", "a binary glTF model: convert it to OBJ"),
        (b"ply\n", "a PLY model: convert it to OBJ"),
        (b"ply\r", "a PLY model: convert it to OBJ"),
        (b"#VRML", "a VRML model: convert it to OBJ"),
        (b"version https://git-lfs", "a Git LFS pointer: fetch the file itself (git lfs pull)"),
    ];
    if let Some((_, found)) = MAGIC.iter().find(|(magic, _)| head.starts_with(magic)) {
        return Some(found);
    }
    let text = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head).trim_ascii_start();
    let starts =
        |word: &[u8]| text.get(..word.len()).is_some_and(|start| start.eq_ignore_ascii_case(word));
    if starts(b"<!doctype") || starts(b"<html") || starts(b"<?xml") {
        return Some("HTML or XML, perhaps an error page that was saved");
    }
    if starts(b"solid ") {
        return Some("an STL model: convert it to OBJ");
    }
    if starts(b"{") {
        return Some("JSON, perhaps a glTF model: convert it to OBJ");
    }
    head.contains(&0).then_some("binary data")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_formats_are_named() {
        let found = |head: &[u8]| sniff_other_format(head);
        assert!(found(b"\x1f\x8b\x08").is_some_and(|text| text.contains("gzip")));
        assert!(found(b"\n <!DOCTYPE html>").is_some_and(|text| text.contains("HTML")));
        assert!(found(b"\x00\x01").is_some_and(|text| text.contains("binary")));
        assert_eq!(found(b"\xef\xbb\xbfv 0 0 0\n"), None, "a byte order mark is sound");
        assert_eq!(found(b"# comment\nv 0 0 0\n"), None);
    }

    #[test]
    fn folders_and_missing_files_are_told_apart() {
        let folder = tempfile::tempdir().unwrap();
        assert!(matches!(read_model(folder.path()), Err(ReadError::Folder { .. })));
        let missing = folder.path().join("none.obj");
        assert!(matches!(read_model(&missing), Err(ReadError::Io { .. })));
    }
}
