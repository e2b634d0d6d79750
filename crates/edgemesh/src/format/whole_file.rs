//! Writes files whole or not at all.

use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use thiserror::Error;

/// A file could not be written.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The folder of the file does not exist.
    #[error(
        "{}: cannot be written: the folder {} does not exist; create it first",
        path.display(), folder.display()
    )]
    NoFolder {
        /// The file.
        path: PathBuf,
        /// The folder.
        folder: PathBuf,
    },
    /// The operating system cannot write the file.
    #[error("{}: cannot be written: {reason}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The error of the operating system.
        reason: io::Error,
    },
}

/// Checks that the folder of the file `path` exists.
///
/// # Errors
/// Fails with [`WriteError::NoFolder`] if it does not.
pub fn check_folder(path: &Path) -> Result<(), WriteError> {
    let folder = folder_of(path);
    match folder.is_dir() {
        true => Ok(()),
        false => Err(WriteError::NoFolder { path: path.to_owned(), folder: folder.to_owned() }),
    }
}

/// Writes `bytes` to a file beside `path` and renames it, so that a failure leaves no partial file,
/// and an old file stays until the new one is complete.
///
/// # Errors
/// Fails if the folder does not exist, `path` is a folder, or the file cannot be written, for
/// example because the disk is full.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    check_folder(path)?;
    let failed = |reason: io::Error| WriteError::Io { path: path.to_owned(), reason };
    if path.is_dir() {
        return Err(failed(io::ErrorKind::IsADirectory.into()));
    }
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        // The usual permissions of a new file, which the umask reduces.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.prefix(".edgemesh-").tempfile_in(folder_of(path)).map_err(failed)?;
    file.write_all(bytes).and_then(|()| file.flush()).map_err(failed)?;
    file.persist(path).map_err(|error| failed(error.error))?;
    Ok(())
}

/// The folder of the file `path`; `.` for a bare name.
pub(crate) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_replaced_whole_and_nothing_else_is_left() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.txt");
        write_file(&path, b"one").unwrap();
        write_file(&path, b"two").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"two");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_missing_folder_is_named() {
        let error = write_file(Path::new("no/such/folder/out.txt"), b"").unwrap_err();
        assert!(matches!(error, WriteError::NoFolder { .. }), "{error:?}");
        assert!(error.to_string().contains("no/such/folder does not exist"), "{error}");
    }
}
