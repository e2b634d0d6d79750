//! Technique, shader and image files, watched on another thread.
//!
//! A change is reported twice: at once, when the files may be half saved and errors are not
//! shown, and again when no more changes follow.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use crate::watch::{WatchError, Watcher};

/// How often the thread checks whether the watch has ended.
const PATIENCE: Duration = Duration::from_millis(500);

/// Folders that are watched until this is dropped.
#[derive(Debug)]
pub(crate) struct Watching {
    folders: Vec<PathBuf>,
    changes: Receiver<Change>,
    is_over: Arc<AtomicBool>,
}

/// A change of files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Change {
    /// The files may be half saved.
    Now,
    /// The files have not changed for a while.
    Settled,
}

impl Watching {
    /// Watches folders; `wake` is called after each change.
    ///
    /// # Errors
    /// [`WatchError`].
    pub(crate) fn start(
        folders: &[PathBuf],
        wake: impl Fn() + Send + 'static,
    ) -> Result<Self, WatchError> {
        let mut watcher = Watcher::new(folders, &[])?;
        let (sender, changes) = channel();
        let is_over = Arc::new(AtomicBool::new(false));
        let over = is_over.clone();
        std::thread::spawn(move || {
            while !over.load(Ordering::Relaxed) {
                if !watcher.wait(PATIENCE) {
                    continue;
                }
                let is_heard = sender.send(Change::Now).is_ok();
                wake();
                // Another change comes with its own report.
                if is_heard && watcher.settled() {
                    let _ = sender.send(Change::Settled);
                    wake();
                }
            }
        });
        Ok(Self { folders: folders.to_owned(), changes, is_over })
    }

    /// Whether these are the watched folders.
    #[must_use]
    pub(crate) fn is_of(&self, folders: &[PathBuf]) -> bool {
        self.folders == folders
    }

    /// The last change since the last call.
    #[must_use]
    pub(crate) fn take(&self) -> Option<Change> {
        self.changes.try_iter().last()
    }
}

impl Drop for Watching {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_is_told_at_once_and_when_it_is_over() {
        let folder = tempfile::tempdir().unwrap();
        let (sender, woken) = channel();
        let folders = [folder.path().to_owned()];
        let wake = move || sender.send(()).unwrap();
        let watching = Watching::start(&folders, wake).unwrap();
        assert!(watching.is_of(&folders) && watching.take().is_none());
        std::fs::write(folder.path().join("a.toml"), "a = 1\n").unwrap();
        let wait = || woken.recv_timeout(Duration::from_secs(20)).unwrap();
        wait();
        assert_eq!(watching.take(), Some(Change::Now));
        wait();
        assert_eq!(watching.take(), Some(Change::Settled));
    }
}
