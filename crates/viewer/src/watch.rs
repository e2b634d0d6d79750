//! Watches the files of a technique, its shaders and images, and tells when they have
//! changed and are whole.
//!
//! Folders are watched, not files: editors write a new file and rename it over the old
//! one. An editor may also empty a file before it writes it, and write it in pieces; so a
//! change is told once the folder is quiet, files that are empty are waited for, and who
//! reads a mistake asks again before telling it ([`Watcher::settled`]).

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, SystemTime};

use notify::{RecommendedWatcher, RecursiveMode, Watcher as _};
use thiserror::Error;

/// How long nothing must happen for a change to be over.
const QUIET: Duration = Duration::from_millis(25);

/// How long a mistake is doubted: what is half saved is whole by then.
const DOUBT: Duration = Duration::from_millis(150);

/// The endings of the files that count.
const ENDINGS: [&str; 5] = ["toml", "wgsl", "png", "jpg", "jpeg"];

/// Why files cannot be watched.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum WatchError {
    /// The operating system watches nothing.
    #[error("files cannot be watched: {0}")]
    Start(notify::Error),
    /// It does not watch a folder.
    #[error("{}: files cannot be watched: {reason}", folder.display())]
    Folder {
        /// The folder.
        folder: PathBuf,
        /// What the operating system said.
        reason: notify::Error,
    },
}

/// When files were written, and how long they are.
type Stamps = BTreeMap<PathBuf, (Option<SystemTime>, u64)>;

/// Watches some folders.
#[derive(Debug)]
pub struct Watcher {
    /// Kept, as it stops when it goes.
    _watcher: RecommendedWatcher,
    events: Receiver<notify::Result<notify::Event>>,
    folders: Vec<PathBuf>,
    /// Files that are written and not read.
    ignored: Vec<PathBuf>,
    stamps: Stamps,
}

impl Watcher {
    /// Watches `folders` and their folders of shaders, components, techniques and images;
    /// `ignored` are files in them that do not count.
    ///
    /// # Errors
    /// [`WatchError`].
    pub fn new(folders: &[PathBuf], ignored: &[PathBuf]) -> Result<Self, WatchError> {
        let (sender, events) = channel();
        // Who only reads changes nothing; and nobody listens any more where sending fails.
        let send = move |event: notify::Result<notify::Event>| {
            if !event.as_ref().is_ok_and(|event| event.kind.is_access()) {
                drop(sender.send(event));
            }
        };
        let mut watcher = notify::recommended_watcher(send).map_err(WatchError::Start)?;
        let folders = with_subfolders(folders);
        for folder in &folders {
            watcher
                .watch(folder, RecursiveMode::NonRecursive)
                .map_err(|reason| WatchError::Folder { folder: folder.clone(), reason })?;
        }
        let ignored = ignored.iter().map(|path| absolute(path)).collect();
        let mut this =
            Self { _watcher: watcher, events, folders, ignored, stamps: Stamps::default() };
        this.stamps = this.stamps_now();
        Ok(this)
    }

    /// Waits until a file has changed and all files are whole; false after `patience`
    /// without a change, or where watching has ended.
    pub fn wait(&mut self, patience: Duration) -> bool {
        loop {
            match self.events.recv_timeout(patience) {
                Ok(_) => {}
                Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => return false,
            }
            while self.events.recv_timeout(QUIET).is_ok() {}
            let now = self.stamps_now();
            // A file that has become empty is about to be written; one that always was is
            // nothing to wait for.
            let is_known = |path, stamp| self.stamps.get(path) == Some(stamp);
            let is_whole = now.iter().all(|(path, stamp)| stamp.1 > 0 || is_known(path, stamp));
            if is_whole && now != self.stamps {
                self.stamps = now;
                return true;
            }
        }
    }

    /// Whether nothing more has changed for a while: what is wrong now is not just half
    /// saved. Takes up to 150 ms.
    pub fn settled(&self) -> bool {
        std::thread::sleep(DOUBT);
        self.stamps_now() == self.stamps
    }

    fn stamps_now(&self) -> Stamps {
        let mut stamps = Stamps::new();
        for folder in &self.folders {
            let Ok(entries) = std::fs::read_dir(folder) else { continue };
            for path in entries.filter_map(|entry| Some(absolute(&entry.ok()?.path()))) {
                let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
                let counts = ending.is_some_and(|ending| ENDINGS.iter().any(|e| ending == *e));
                if !counts || self.ignored.contains(&path) {
                    continue;
                }
                if let Ok(metadata) = path.metadata() {
                    stamps.insert(path, (metadata.modified().ok(), metadata.len()));
                }
            }
        }
        stamps
    }
}

/// The folders that there are, with those below them that hold what techniques read.
fn with_subfolders(folders: &[PathBuf]) -> Vec<PathBuf> {
    let mut all: Vec<PathBuf> = Vec::new();
    for folder in folders {
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        all.push(folder.to_owned());
        for name in ["shaders", "components", "techniques", "images", "programs", "common"] {
            all.push(folder.join(name));
        }
        for images in [folder.to_owned(), folder.join("images")] {
            let entries = std::fs::read_dir(images).into_iter().flatten();
            let below = entries.filter_map(|entry| Some(entry.ok()?.path()));
            let is_shown = |path: &PathBuf| {
                path.file_name().is_some_and(|name| !name.to_string_lossy().starts_with('.'))
            };
            all.extend(below.filter(|path| path.is_dir() && is_shown(path)));
        }
    }
    all.retain(|folder| folder.is_dir());
    all.sort();
    all.dedup();
    all
}

/// A path by which a file is known wherever it is named from.
fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    const LONG: Duration = Duration::from_secs(20);
    const SHORT: Duration = Duration::from_millis(300);

    #[test]
    fn a_change_is_told_and_what_does_not_count_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str| folder.path().join(name);
        std::fs::write(file("mine.toml"), "a = 1\n").unwrap();
        let mut watcher =
            Watcher::new(&[folder.path().to_owned()], &[file("picture.png")]).unwrap();
        assert!(!watcher.wait(SHORT), "nothing has happened");
        std::fs::write(file("picture.png"), "drawn").unwrap();
        std::fs::write(file("notes.txt"), "text").unwrap();
        assert!(!watcher.wait(SHORT), "neither is read");
        std::fs::write(file("mine.toml"), "a = 23\n").unwrap();
        assert!(watcher.wait(LONG), "it was written");
        // As editors do it: a new file over the old one.
        std::fs::write(file("mine.toml~"), "a = 456\n").unwrap();
        std::fs::rename(file("mine.toml~"), file("mine.toml")).unwrap();
        assert!(watcher.wait(LONG), "it was replaced");
        assert!(watcher.settled(), "and nothing more happened");
    }

    #[test]
    fn an_empty_file_is_waited_for() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mine.wgsl");
        std::fs::write(&path, "fn one() {}\n").unwrap();
        std::fs::write(folder.path().join("always_empty.toml"), "").unwrap();
        let mut watcher = Watcher::new(&[folder.path().to_owned()], &[]).unwrap();
        std::fs::write(&path, "").unwrap();
        assert!(!watcher.wait(SHORT), "it is about to be written");
        std::fs::write(&path, "fn another() {}\n").unwrap();
        assert!(watcher.wait(LONG), "now it is whole");
    }
}
