//! Temporary files beside an output, which vanish however the process ends.
//!
//! Idea: the name depends on the output alone, with a number for each writer at the same time, and
//! a writer keeps its file locked. So a file that nobody has locked was left by a process that was
//! killed, and the next writer of the same output removes it. Signals that end the process in an
//! orderly way remove the files of a list, which [`remove_unfinished`] reads.
//!
//! ```text
//! create, lock, list --> write --> rename, unlist        a failure: unlist, remove
//! ```
//!
//! Rejected: random names, of which nobody knows whether their writer still lives.

use std::fs::{self, File, Metadata, OpenOptions, TryLockError};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::destination::folder_of;

/// The most processes that write the same output at the same time.
const MAX_WRITERS: usize = 64;

/// The temporary files of this process.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// See [`before_first_file`].
static BEFORE_FIRST_FILE: Mutex<Option<Box<dyn FnOnce() + Send>>> = Mutex::new(None);

/// Runs `action` before this process makes its first temporary file, which most commands never do.
pub fn before_first_file(action: impl FnOnce() + Send + 'static) {
    *BEFORE_FIRST_FILE.lock().unwrap_or_else(PoisonError::into_inner) = Some(Box::new(action));
}

fn unfinished() -> MutexGuard<'static, Vec<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// While this lives, no temporary file is created or renamed.
#[must_use = "files begin when it is dropped"]
#[derive(Debug)]
pub struct NoFilesBegin {
    _unfinished: MutexGuard<'static, Vec<PathBuf>>,
}

/// Removes the temporary files of this process, which is about to end.
pub fn remove_unfinished() -> NoFilesBegin {
    let mut unfinished = unfinished();
    for path in unfinished.drain(..) {
        // The next writer of the output tries again.
        let _ = fs::remove_file(path);
    }
    NoFilesBegin { _unfinished: unfinished }
}

/// A temporary file, removed on drop.
#[derive(Debug)]
pub(super) struct Temporary {
    file: File,
    path: PathBuf,
}

impl Temporary {
    /// An empty file beside `target`, which `old` describes if it exists: the file has its
    /// permissions, else those of a new file.
    ///
    /// # Errors
    /// Fails if the folder cannot be written, or [`MAX_WRITERS`] write `target` now.
    pub(super) fn beside(target: &Path, old: Option<&Metadata>) -> io::Result<Self> {
        let action = BEFORE_FIRST_FILE.lock().unwrap_or_else(PoisonError::into_inner).take();
        if let Some(action) = action {
            action();
        }
        let names: Vec<PathBuf> = names(target).collect();
        names.iter().for_each(|path| remove_abandoned(path));
        let mut unfinished = unfinished();
        for path in names {
            let file = match create(&path, old) {
                Ok(file) => file,
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => continue,
                Err(error) => return Err(error),
            };
            if is_kept(&file, &path) {
                unfinished.push(path.clone());
                return Ok(Self { file, path });
            }
        }
        Err(io::Error::other("too many programs write it"))
    }

    /// Writes the whole content.
    pub(super) fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.file.write_all(bytes)?;
        self.file.flush()
    }

    /// Renames the file to `target`.
    pub(super) fn rename_to(self, target: &Path) -> io::Result<()> {
        let mut unfinished = unfinished();
        fs::rename(&self.path, target)?;
        unfinished.retain(|path| *path != self.path);
        // Dropping `self` takes the lock again.
        drop(unfinished);
        Ok(())
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        let mut unfinished = unfinished();
        if let Some(at) = unfinished.iter().position(|path| *path == self.path) {
            unfinished.swap_remove(at);
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// The names of the temporary files of `target`, hidden and of one length.
fn names(target: &Path) -> impl Iterator<Item = PathBuf> {
    let name = target.file_name().unwrap_or_default();
    let hash = blake3::hash(name.as_encoded_bytes()).to_hex();
    let folder = folder_of(target);
    (0..MAX_WRITERS).map(move |number| folder.join(format!(".edgemesh-{:.16}-{number}", &hash)))
}

/// Removes a temporary file whose writer no longer lives.
fn remove_abandoned(path: &Path) {
    if !fs::symlink_metadata(path).is_ok_and(|found| found.is_file()) {
        return;
    }
    let Ok(file) = File::open(path) else { return };
    // The lock is held until the file is removed; another process may have done that before it.
    if file.try_lock().is_ok() && is_at(&file, path) {
        let _ = fs::remove_file(path);
    }
}

/// Locks a file that was just created; returns whether `path` is still its name. Another process
/// may have removed it between the two.
///
/// On a file system without locks nobody else can lock it either, and so nobody removes it.
fn is_kept(file: &File, path: &Path) -> bool {
    match file.try_lock() {
        Ok(()) => is_at(file, path),
        Err(TryLockError::WouldBlock) => false,
        Err(TryLockError::Error(_)) => true,
    }
}

/// Whether `path` names the open file.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    let id = |found: Metadata| (found.dev(), found.ino());
    let open = file.metadata().map(id);
    open.is_ok_and(|open| fs::symlink_metadata(path).is_ok_and(|found| id(found) == open))
}

/// Whether `path` names the open file, which cannot be renamed elsewhere here.
#[cfg(not(unix))]
fn is_at(_file: &File, path: &Path) -> bool {
    path.exists()
}

/// Creates a file that nobody can read who could not read the old one.
#[cfg(unix)]
fn create(path: &Path, old: Option<&Metadata>) -> io::Result<File> {
    use std::os::unix::fs::{MetadataExt as _, OpenOptionsExt as _, PermissionsExt as _, fchown};
    // Without the bits that run a program as its owner.
    let mode = old.map(|old| old.permissions().mode() & 0o777);
    let mut options = OpenOptions::new();
    // The umask reduces the usual permissions of a new file.
    let file = options.write(true).create_new(true).mode(mode.unwrap_or(0o666)).open(path)?;
    if let (Some(old), Some(mode)) = (old, mode) {
        let new = file.metadata()?;
        if (new.uid(), new.gid()) != (old.uid(), old.gid()) {
            // Only the administrator may give a file away; else it is ours.
            let _ = fchown(&file, Some(old.uid()), Some(old.gid()));
        }
        file.set_permissions(fs::Permissions::from_mode(mode))?;
    }
    Ok(file)
}

#[cfg(not(unix))]
fn create(path: &Path, _old: Option<&Metadata>) -> io::Result<File> {
    OpenOptions::new().write(true).create_new(true).open(path)
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn abandoned_files_are_removed_and_those_of_other_writers_stay() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("out.glb");
        let count = || fs::read_dir(folder.path()).unwrap().count();
        let [first, second] = [(); 2].map(|()| Temporary::beside(&target, None).unwrap());
        assert_eq!(count(), 2);
        // As a killed process leaves it: the lock is gone, the file stays.
        let name = second.path.clone();
        unfinished().retain(|path| *path != name);
        drop(second);
        assert!(name.exists(), "left behind");
        let other = folder.path().join("other.glb");
        drop(Temporary::beside(&other, None).unwrap());
        assert!(name.exists(), "another output");
        let third = Temporary::beside(&target, None).unwrap();
        assert_eq!((third.path.clone(), count()), (name, 2), "its number is free again");
        first.rename_to(&target).unwrap();
        drop(third);
        assert_eq!(count(), 1);
    }

    #[test]
    fn links_under_the_name_of_a_temporary_file_are_not_followed() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("out");
        let precious = folder.path().join("precious");
        fs::write(&precious, "kept").unwrap();
        let name = names(&target).next().unwrap();
        std::os::unix::fs::symlink(&precious, name).unwrap();
        Temporary::beside(&target, None).unwrap().write(b"new").unwrap();
        assert_eq!(fs::read(&precious).unwrap(), b"kept");
    }
}
