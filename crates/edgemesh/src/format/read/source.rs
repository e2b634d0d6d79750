//! The bytes of a model file, and the files beside it that a reader may open.

use std::fs;
use std::path::{Component, Path, PathBuf};

use super::error::{ReadError, ReadErrorKind};
use crate::format::regular_file::read_regular;
use crate::report::Place;

/// The largest file that is read: 4 GiB. As text, a model with
/// [`MAX_INDEX`](crate::index::MAX_INDEX) corners needs more than that.
pub(crate) const MAX_FILE_BYTES: u64 = 4 << 30;

/// What a reader reads.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Source<'a> {
    /// The file's name in messages.
    pub(crate) name: &'a str,
    /// The folder that may hold other files of the model, in it or below; `None`
    /// for a stream.
    pub(crate) folder: Option<&'a Path>,
    /// The whole file.
    pub(crate) bytes: &'a [u8],
}

impl Source<'_> {
    /// An error in this file.
    pub(crate) fn error(
        &self,
        kind: ReadErrorKind,
        place: Option<Place>,
        what: impl Into<String>,
    ) -> ReadError {
        ReadError { kind, file: self.name.into(), place, what: what.into() }
    }

    /// The path of a file that the model names: `relative` to the folder of the
    /// model, with slashes or backslashes.
    ///
    /// # Errors
    /// Fails if the file does not exist, lies outside the model's folder (also
    /// through a symbolic link), or the model came from a stream. The message
    /// follows the file's name in a sentence and reveals nothing of its content.
    pub(crate) fn sidecar_path(&self, relative: &str) -> Result<PathBuf, String> {
        const OUTSIDE: &str = "lies outside the model's folder and was not opened";
        let folder = self.folder.ok_or("cannot be opened: the model was read from a stream")?;
        let relative = relative.replace('\\', "/");
        let relative = Path::new(&relative);
        let stays_inside = relative
            .components()
            .all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
        if !stays_inside {
            return Err(OUTSIDE.into());
        }
        let folder = folder.canonicalize().map_err(|error| error.to_string())?;
        let target =
            folder.join(relative).canonicalize().map_err(|_| "was not found".to_owned())?;
        if !target.starts_with(&folder) {
            return Err(OUTSIDE.into());
        }
        Ok(target)
    }

    /// As [`Self::sidecar_path`], for a regular file of at most `max_bytes`.
    ///
    /// # Errors
    /// Also fails if it is something else than a file, or larger.
    pub(crate) fn sidecar_file(&self, relative: &str, max_bytes: u64) -> Result<PathBuf, String> {
        let target = self.sidecar_path(relative)?;
        let metadata = fs::metadata(&target).map_err(|error| error.to_string())?;
        if !metadata.is_file() {
            return Err("is not a regular file".into());
        }
        if metadata.len() > max_bytes {
            return Err(format!("is larger than {} MiB", max_bytes >> 20));
        }
        Ok(target)
    }

    /// Reads a file that the model names, of at most [`MAX_FILE_BYTES`].
    ///
    /// # Errors
    /// As [`Self::sidecar_file`]; also if the file cannot be read.
    pub(crate) fn sidecar(&self, relative: &str) -> Result<Vec<u8>, String> {
        let target = self.sidecar_file(relative, MAX_FILE_BYTES)?;
        read_regular(&target, MAX_FILE_BYTES).map_err(|error| error.to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sidecars_stay_in_the_folder() {
        let outer = tempfile::tempdir().unwrap();
        let folder = outer.path().join("models");
        fs::create_dir_all(folder.join("below")).unwrap();
        fs::write(outer.path().join("secret"), "secret").unwrap();
        fs::write(folder.join("below/beside"), "beside").unwrap();
        let source = Source { name: "model", folder: Some(&folder), bytes: b"" };
        assert_eq!(source.sidecar("below\\beside"), Ok(b"beside".to_vec()));
        assert!(source.sidecar("none").unwrap_err().contains("not found"));
        let above = outer.path().join("secret").display().to_string();
        for name in ["../secret", "/etc/hostname", "..\\secret", "below/../../secret", &above] {
            assert!(source.sidecar(name).unwrap_err().contains("outside"), "{name}");
        }
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(outer.path().join("secret"), folder.join("link")).unwrap();
            assert!(source.sidecar("link").unwrap_err().contains("outside"));
        }
        let stream = Source { folder: None, ..source };
        assert!(stream.sidecar("below/beside").unwrap_err().contains("stream"));
    }
}
