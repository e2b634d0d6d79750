//! Opens regular files only: a pipe can wait for a writer forever, and a device such as
//! `/dev/zero` has no end.
//!
//! The kind is asked for before the file is opened, because opening a pipe waits already, and
//! again afterwards, because the file at a path can be replaced meanwhile.

use std::fs::{File, FileType};
use std::io::{self, Read as _};
use std::path::Path;

/// Opens the regular file at `path`, or the one that a symbolic link there leads to.
///
/// # Errors
/// Fails with `InvalidInput` if it is something else, or with the error of the operating
/// system.
pub(crate) fn open_regular(path: &Path) -> io::Result<File> {
    check(path.metadata()?.file_type())?;
    let file = File::open(path)?;
    check(file.metadata()?.file_type())?;
    Ok(file)
}

/// Reads the regular file at `path`, of at most `max_bytes`.
///
/// # Errors
/// As [`open_regular`]; also with `FileTooLarge`, before anything is read if its size says so.
pub(crate) fn read_regular(path: &Path, max_bytes: u64) -> io::Result<Vec<u8>> {
    let file = open_regular(path)?;
    let too_large = || {
        let what = format!("it is larger than {} MiB", max_bytes >> 20);
        io::Error::new(io::ErrorKind::FileTooLarge, what)
    };
    if file.metadata()?.len() > max_bytes {
        return Err(too_large());
    }
    let mut bytes = Vec::new();
    // The file can grow meanwhile.
    file.take(max_bytes.saturating_add(1)).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > max_bytes { Err(too_large()) } else { Ok(bytes) }
}

fn check(kind: FileType) -> io::Result<()> {
    match special(kind) {
        None => Ok(()),
        Some(name) => {
            let what =
                format!("it is {name}, not a regular file; only standard input can be a stream");
            Err(io::Error::new(io::ErrorKind::InvalidInput, what))
        }
    }
}

/// What a file is that is not a regular file.
fn special(kind: FileType) -> Option<&'static str> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt as _;
        if kind.is_fifo() {
            return Some("a pipe");
        }
        if kind.is_char_device() || kind.is_block_device() {
            return Some("a device");
        }
        if kind.is_socket() {
            return Some("a socket");
        }
    }
    match (kind.is_file(), kind.is_dir()) {
        (true, _) => None,
        (_, true) => Some("a folder"),
        _ => Some("of an unknown kind"),
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn regular_files_are_read_up_to_the_limit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.marks");
        fs::write(&path, vec![b' '; 1 << 20]).unwrap();
        assert_eq!(read_regular(&path, 1 << 20).unwrap().len(), 1 << 20);
        let error = read_regular(&path, (1 << 20) - 1).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::FileTooLarge);
        assert_eq!(open_regular(folder.path()).unwrap_err().kind(), io::ErrorKind::InvalidInput);
        let none = open_regular(&folder.path().join("none")).unwrap_err();
        assert_eq!(none.kind(), io::ErrorKind::NotFound);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn endless_and_waiting_files_are_refused_at_once() {
        let folder = tempfile::tempdir().unwrap();
        let link = folder.path().join("link");
        std::os::unix::fs::symlink("/dev/zero", &link).unwrap();
        for (path, name) in [(Path::new("/dev/zero"), "a device"), (&link, "a device")] {
            let error = read_regular(path, u64::MAX).unwrap_err();
            assert!(error.to_string().contains(name), "{error}");
        }
    }
}
