//! Output that is whole or not there.

use std::io::{self, Write as _};
use std::path::Path;

use super::Failure;

/// Writes `bytes` to standard output; a closed pipe is a quiet end, not an error.
///
/// # Errors
/// Where standard output cannot be written for another reason, a full disk say.
pub fn print_to_stdout(bytes: &[u8]) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::fault(format!("standard output: cannot be written: {error}")))
        }
        _ => Ok(()),
    }
}

/// Writes `bytes` beside `path` and renames them into place, so that a failure
/// leaves no half file and an old file stays until the new one is whole.
///
/// # Errors
/// Names the path, what is wrong, and what to do.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    if !folder.is_dir() {
        let message = format!(
            "{}: cannot be written: the folder {} does not exist; make it first",
            path.display(),
            folder.display()
        );
        return Err(Failure::fault(message));
    }
    let failed = |error: io::Error| {
        Failure::fault(format!("{}: cannot be written: {error}", path.display()))
    };
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
    let mut file = builder.prefix(".edgemesh-").tempfile_in(folder).map_err(failed)?;
    file.write_all(bytes).and_then(|()| file.flush()).map_err(failed)?;
    file.persist(path).map_err(|error| failed(error.error))?;
    Ok(())
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
        let failure = write_file(Path::new("no/such/folder/out.txt"), b"").unwrap_err();
        assert!(failure.message.contains("no/such/folder does not exist"), "{}", failure.message);
    }
}
