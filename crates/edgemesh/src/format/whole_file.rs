//! Files that are written whole or not at all.

use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use thiserror::Error;

/// Why a file could not be written.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum WriteError {
    /// Its folder does not exist.
    #[error(
        "{}: cannot be written: the folder {} does not exist; make it first",
        path.display(), folder.display()
    )]
    NoFolder {
        /// The file.
        path: PathBuf,
        /// The folder.
        folder: PathBuf,
    },
    /// The operating system refused.
    #[error("{}: cannot be written: {reason}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the operating system said.
        reason: io::Error,
    },
}

/// Checks that the folder of the file `path` exists.
///
/// # Errors
/// [`WriteError::NoFolder`].
pub fn check_folder(path: &Path) -> Result<(), WriteError> {
    let folder = folder_of(path);
    match folder.is_dir() {
        true => Ok(()),
        false => Err(WriteError::NoFolder { path: path.to_owned(), folder: folder.to_owned() }),
    }
}

/// Writes `bytes` beside `path` and renames them into place, so that a failure leaves no half
/// file, and an old file stays until the new one is whole.
///
/// # Errors
/// [`WriteError`], if the folder does not exist, `path` is a folder, or the disk is full, say.
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
        // As any new file: the umask takes away what others must not do.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.prefix(".edgemesh-").tempfile_in(folder_of(path)).map_err(failed)?;
    file.write_all(bytes).and_then(|()| file.flush()).map_err(failed)?;
    file.persist(path).map_err(|error| failed(error.error))?;
    Ok(())
}

/// The folder of the file `path`; `.` for a bare name.
pub(super) fn folder_of(path: &Path) -> &Path {
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
