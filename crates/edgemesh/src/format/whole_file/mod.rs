//! Writes files whole or not at all.
//!
//! ```text
//! path --links--> file:    a temporary file beside it, renamed
//!           '---> stream:  written to; a device or a pipe stays what it is
//! ```

mod destination;
mod temporary;

use std::fs::{self, Metadata, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use self::destination::Destination;
pub(crate) use self::destination::folder_of;
use self::temporary::Temporary;
pub use self::temporary::{NoFilesBegin, before_first_file, remove_unfinished};

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

/// Checks that the folder of the file `path`, or of the file that it links to, exists.
///
/// # Errors
/// Fails with [`WriteError::NoFolder`] if it does not, and if links form a circle.
pub fn check_folder(path: &Path) -> Result<(), WriteError> {
    match destination_of(path)? {
        Destination::File(file) => require_folder(&file),
        _ => Ok(()),
    }
}

/// Writes `bytes` to a file beside `path` and renames it, so that a failure leaves no partial file,
/// and an old file stays until the new one is complete. The new file has the permissions of the old
/// one; links are followed.
///
/// Devices, pipes and the standard streams are written to; a reader that closes its end early is no
/// error.
///
/// # Errors
/// Fails if the folder does not exist, `path` is a folder, or the file cannot be written, for
/// example because the disk is full.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    let failed = |reason: io::Error| WriteError::Io { path: path.to_owned(), reason };
    let file = match destination_of(path)? {
        Destination::Stdout => return write_stream(io::stdout().lock(), bytes).map_err(failed),
        Destination::Stderr => return write_stream(io::stderr().lock(), bytes).map_err(failed),
        Destination::Stream(stream) => {
            let stream = OpenOptions::new().write(true).open(stream).map_err(failed)?;
            return write_stream(stream, bytes).map_err(failed);
        }
        Destination::File(file) => file,
    };
    require_folder(&file)?;
    let old = fs::metadata(&file).ok();
    if old.as_ref().is_some_and(Metadata::is_dir) {
        return Err(failed(io::ErrorKind::IsADirectory.into()));
    }
    let mut temporary = Temporary::beside(&file, old.as_ref()).map_err(failed)?;
    temporary.write(bytes).and_then(|()| temporary.rename_to(&file)).map_err(failed)
}

/// Whether `path` is a device, a pipe or a standard stream, which other files cannot stand beside.
#[must_use]
pub fn is_stream(path: &Path) -> bool {
    Destination::of(path).is_ok_and(|found| !matches!(found, Destination::File(_)))
}

fn destination_of(path: &Path) -> Result<Destination, WriteError> {
    Destination::of(path).map_err(|reason| WriteError::Io { path: path.to_owned(), reason })
}

fn require_folder(file: &Path) -> Result<(), WriteError> {
    let folder = folder_of(file);
    match folder.is_dir() {
        true => Ok(()),
        false => Err(WriteError::NoFolder { path: file.to_owned(), folder: folder.to_owned() }),
    }
}

fn write_stream(mut stream: impl io::Write, bytes: &[u8]) -> io::Result<()> {
    match stream.write_all(bytes).and_then(|()| stream.flush()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        written => written,
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

    #[cfg(unix)]
    #[test]
    fn permissions_and_links_stay() {
        use std::os::unix::fs::{PermissionsExt as _, symlink};
        let folder = tempfile::tempdir().unwrap();
        let (path, link) = (folder.path().join("out"), folder.path().join("link"));
        write_file(&path, b"one").unwrap();
        let mode = || fs::metadata(&path).unwrap().permissions().mode() & 0o777;
        for wanted in [0o600, 0o640, 0o606] {
            fs::set_permissions(&path, fs::Permissions::from_mode(wanted)).unwrap();
            write_file(&path, b"two").unwrap();
            assert_eq!(mode(), wanted, "{wanted:o}");
        }
        symlink("out", &link).unwrap();
        write_file(&link, b"three").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!((fs::read(&path).unwrap(), mode()), (b"three".to_vec(), 0o606));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
    }

    /// Nobody listens at a socket in the folder, so that opening it fails.
    #[cfg(unix)]
    #[test]
    fn a_stream_is_not_replaced() {
        use std::os::unix::fs::FileTypeExt as _;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("socket");
        drop(std::os::unix::net::UnixListener::bind(&path).unwrap());
        assert!(matches!(write_file(&path, b"one"), Err(WriteError::Io { .. })));
        assert!(fs::metadata(&path).unwrap().file_type().is_socket());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn messages_do_not_name_temporary_files() {
        let folder = tempfile::tempdir().unwrap();
        let long = folder.path().join("n".repeat(300));
        let error = write_file(&long, b"").unwrap_err().to_string();
        assert!(error.contains("cannot be written") && !error.contains(".edgemesh-"), "{error}");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn a_missing_folder_is_named() {
        let error = write_file(Path::new("no/such/folder/out.txt"), b"").unwrap_err();
        assert!(matches!(error, WriteError::NoFolder { .. }), "{error:?}");
        assert!(error.to_string().contains("no/such/folder does not exist"), "{error}");
    }
}
