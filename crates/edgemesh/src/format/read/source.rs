//! The bytes of a model file, and the files beside it that a reader may open.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Component, Path, PathBuf};

use super::error::{ReadError, ReadErrorKind};
use super::sniff::{Format, sniff};
use crate::report::Place;

/// The largest file that is read: 4 GiB. A model of [`crate::index::MAX_INDEX`]
/// corners needs more than that as text, so nothing sound is lost.
pub const MAX_FILE_BYTES: u64 = 4 << 30;

/// Files from this size on are read by several threads.
const PARALLEL_BYTES: u64 = 8 << 20;

/// How much of a file is read before its kind is judged.
const SNIFF_BYTES: u64 = 64 << 10;

/// What a reader reads.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Source<'a> {
    /// The file in messages.
    pub(crate) name: &'a str,
    /// The folder that other parts of the model may lie in, or below; `None`
    /// where the bytes came from a stream, which has no folder.
    pub(crate) folder: Option<&'a Path>,
    /// All of the file.
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

    /// Where a file that the model names lies.
    ///
    /// # Errors
    /// Why it is not opened, to go behind the file's name in a sentence; never
    /// a word of what is in it.
    pub(crate) fn sidecar_path(&self, relative: &str) -> Result<PathBuf, String> {
        const OUTSIDE: &str = "lies outside the model's folder and was not opened";
        let folder = self.folder.ok_or("cannot be found: the model came through a stream")?;
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

    /// Where a file of at most `max_bytes` that the model names lies.
    ///
    /// # Errors
    /// As [`Self::sidecar_path`], and where it is no such file.
    pub(crate) fn sidecar_file(&self, relative: &str, max_bytes: u64) -> Result<PathBuf, String> {
        let target = self.sidecar_path(relative)?;
        let metadata = fs::metadata(&target).map_err(|error| error.to_string())?;
        if !metadata.is_file() || metadata.len() > max_bytes {
            return Err("is no file of a sensible size".into());
        }
        Ok(target)
    }

    /// Reads a file that the model names, which must lie in the model's folder
    /// or below.
    ///
    /// # Errors
    /// As [`Self::sidecar_file`], and where the file cannot be read.
    pub(crate) fn sidecar(&self, relative: &str) -> Result<Vec<u8>, String> {
        let target = self.sidecar_file(relative, MAX_FILE_BYTES)?;
        fs::read(&target).map_err(|error| error.to_string())
    }
}

/// The folder of the file at `path`.
pub(crate) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// Reads the file at `path` after its first bytes were found to be those of a
/// model; `format` leaves only the size to be judged.
pub(crate) fn load(path: &Path, format: Option<Format>) -> Result<(Vec<u8>, Format), ReadError> {
    load_file(path, format).map_err(|error| error.in_file(path))
}

fn load_file(path: &Path, format: Option<Format>) -> Result<(Vec<u8>, Format), LoadError> {
    let file = File::open(path).map_err(LoadError::Io)?;
    let metadata = file.metadata().map_err(LoadError::Io)?;
    if metadata.is_dir() {
        let what = "is a folder; name a model file in it".into();
        return Err(LoadError::Other(ReadErrorKind::Io, what));
    }
    // Pipes and devices have no size.
    let size = Some(metadata.len()).filter(|_| metadata.is_file());
    let mut rest = |bytes: &mut Vec<u8>| match size {
        #[cfg(unix)]
        Some(size) if (PARALLEL_BYTES..=MAX_FILE_BYTES).contains(&size) => {
            *bytes = parallel::read_all(&file, size).map_err(LoadError::Io)?;
            Ok(())
        }
        _ => read_rest(&file, size, bytes),
    };
    load_from(&file, size, path, format, &mut rest)
}

/// Reads all of `stream`, which is called `name`, as [`load`] does.
pub(crate) fn load_stream(
    mut stream: impl Read,
    name: &Path,
    format: Option<Format>,
) -> Result<(Vec<u8>, Format), ReadError> {
    let mut start = Vec::new();
    let started = stream.by_ref().take(SNIFF_BYTES).read_to_end(&mut start);
    let mut rest = |bytes: &mut Vec<u8>| read_rest(&mut stream, None, bytes);
    let loaded = match started {
        Ok(_) => load_from(start.as_slice(), None, name, format, &mut rest),
        Err(source) => Err(LoadError::Io(source)),
    };
    loaded.map_err(|error| error.in_file(name))
}

enum LoadError {
    Io(io::Error),
    Other(ReadErrorKind, String),
}

impl LoadError {
    fn in_file(self, path: &Path) -> ReadError {
        let (kind, what) = match self {
            Self::Io(source) => (ReadErrorKind::Io, format!("cannot be read: {source}")),
            Self::Other(kind, what) => (kind, what),
        };
        ReadError { kind, file: path.display().to_string(), place: None, what }
    }
}

/// Judges the first bytes of `head`, then calls `rest` to put the others behind
/// them.
fn load_from(
    head: impl Read,
    size: Option<u64>,
    name: &Path,
    format: Option<Format>,
    rest: &mut dyn FnMut(&mut Vec<u8>) -> Result<(), LoadError>,
) -> Result<(Vec<u8>, Format), LoadError> {
    if let Some(size) = size.filter(|&size| size > MAX_FILE_BYTES) {
        return Err(too_large(size));
    }
    let mut bytes = Vec::new();
    head.take(SNIFF_BYTES).read_to_end(&mut bytes).map_err(LoadError::Io)?;
    if bytes.is_empty() {
        return Err(LoadError::Other(ReadErrorKind::Empty, "the file is empty".into()));
    }
    let format = match format {
        Some(format) => format,
        None => sniff(&bytes, size, name).map_err(|found| {
            LoadError::Other(ReadErrorKind::Format, format!("is no model file but {found}"))
        })?,
    };
    rest(&mut bytes)?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        return Err(too_large(bytes.len() as u64));
    }
    Ok((bytes, format))
}

fn too_large(bytes: u64) -> LoadError {
    let what = format!("too large: {bytes} bytes, at most {MAX_FILE_BYTES} are read");
    LoadError::Other(ReadErrorKind::Size, what)
}

/// Reads what is left of a stream.
fn read_rest(stream: impl Read, size: Option<u64>, bytes: &mut Vec<u8>) -> Result<(), LoadError> {
    // The size only says how much to reserve; the stream says how much there is.
    let rest = size.unwrap_or_default().saturating_sub(bytes.len() as u64);
    if let Ok(rest) = usize::try_from(rest) {
        let refused = |_| {
            let what = format!("too large: no memory for its {} bytes", size.unwrap_or_default());
            LoadError::Other(ReadErrorKind::Size, what)
        };
        // One byte more, so that the end is seen without growing.
        bytes.try_reserve_exact(rest + 1).map_err(refused)?;
    }
    let limit = MAX_FILE_BYTES - bytes.len() as u64 + 1;
    stream.take(limit).read_to_end(bytes).map_err(LoadError::Io)?;
    // Somebody cut the file while it was read.
    if size.is_some_and(|size| (bytes.len() as u64) < size) {
        return Err(LoadError::Io(io::ErrorKind::UnexpectedEof.into()));
    }
    Ok(())
}

/// Reading one file by several threads.
#[cfg(unix)]
mod parallel {
    use std::fs::File;
    use std::io;
    use std::os::unix::fs::FileExt as _;

    use rayon::prelude::*;

    /// Bytes that a thread reads at once.
    const BLOCK: usize = 4 << 20;

    /// Reads the first `size` bytes of a file, which is an error where it has
    /// become shorter.
    pub(super) fn read_all(file: &File, size: u64) -> io::Result<Vec<u8>> {
        let no_memory = |()| io::Error::from(io::ErrorKind::OutOfMemory);
        let length = usize::try_from(size).map_err(|_| no_memory(()))?;
        // Memory that is zero to begin with, so that the threads touch it first.
        let mut bytes = bytemuck::allocation::try_zeroed_vec(length).map_err(no_memory)?;
        bytes
            .par_chunks_mut(BLOCK)
            .enumerate()
            .try_for_each(|(block, target)| file.read_exact_at(target, (block * BLOCK) as u64))?;
        Ok(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_and_missing_files_are_told_apart() {
        let folder = tempfile::tempdir().unwrap();
        let what = |path: &Path| load(path, None).unwrap_err().what;
        assert!(what(folder.path()).contains("is a folder"));
        assert!(what(&folder.path().join("none.obj")).contains("cannot be read"));
    }

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

    #[test]
    fn large_files_are_read_whole_by_several_threads() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("large.obj");
        let mut text = b"# a comment line\n".repeat(600_000);
        text.truncate(usize::try_from(PARALLEL_BYTES).unwrap() + 12_345);
        fs::write(&path, &text).unwrap();
        let (bytes, format) = load(&path, None).unwrap();
        assert_eq!((bytes == text, format), (true, Format::Obj));
        let (bytes, _) = load_stream(text.as_slice(), &path, None).unwrap();
        assert!(bytes == text);
    }

    #[test]
    fn a_file_that_became_shorter_is_an_error() {
        let read = |size: Option<u64>| {
            let mut bytes = Vec::new();
            let is_io = |error: &LoadError| matches!(error, LoadError::Io(_));
            read_rest(&b"v 0 0 0\n"[..], size, &mut bytes).map_err(|error| is_io(&error))
        };
        assert_eq!((read(None), read(Some(8)), read(Some(9))), (Ok(()), Ok(()), Err(true)));
        #[cfg(unix)]
        {
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("short.obj");
            fs::write(&path, "v 0 0 0\n").unwrap();
            let file = File::open(&path).unwrap();
            let error = parallel::read_all(&file, 9).unwrap_err();
            assert_eq!(error.kind(), io::ErrorKind::UnexpectedEof);
        }
    }
}
