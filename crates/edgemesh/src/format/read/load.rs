//! Reads the bytes of a model file or stream and detects its format.

use std::io::{self, Read};
use std::path::Path;

use super::error::{ReadError, ReadErrorKind};
use super::format::Format;
use super::sniff::sniff;
use super::source::MAX_FILE_BYTES;
use crate::format::regular_file::open_regular;

/// Files of this size or more are read by several threads.
const PARALLEL_BYTES: u64 = 8 << 20;

/// How many bytes are read before the format is detected.
const SNIFF_BYTES: u64 = 64 << 10;

/// Reads the file at `path` as `format`, or as the format that is detected from
/// its first bytes.
///
/// # Errors
/// Fails if the file is not a regular one, cannot be read, is empty, larger than
/// [`MAX_FILE_BYTES`], or not a model.
pub(crate) fn load(path: &Path, format: Option<Format>) -> Result<(Vec<u8>, Format), ReadError> {
    load_file(path, format).map_err(|error| error.in_file(path))
}

fn load_file(path: &Path, format: Option<Format>) -> Result<(Vec<u8>, Format), LoadError> {
    if path.is_dir() {
        let what = "is a folder; name a model file in it".into();
        return Err(LoadError::Other(ReadErrorKind::Io, what));
    }
    let file = open_regular(path).map_err(|error| match error.kind() {
        io::ErrorKind::InvalidInput => {
            LoadError::Other(ReadErrorKind::Format, format!("cannot be read: {error}"))
        }
        _ => LoadError::Io(error),
    })?;
    let size = file.metadata().map_err(LoadError::Io)?.len();
    let mut rest = |bytes: &mut Vec<u8>| match size {
        #[cfg(unix)]
        PARALLEL_BYTES..=MAX_FILE_BYTES => {
            *bytes = parallel::read_all(&file, size).map_err(LoadError::Io)?;
            Ok(())
        }
        _ => read_rest(&file, Some(size), bytes),
    };
    load_from(&file, Some(size), path, format, &mut rest)
}

/// As [`load`], from a stream; `name` stands for it in messages, and its extension
/// helps to detect the format.
///
/// # Errors
/// As [`load`].
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

/// A [`ReadError`] without the name of its file.
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

/// Detects the format from the first bytes of `head`, then calls `rest` to append
/// the other bytes.
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
            LoadError::Other(
                ReadErrorKind::Format,
                format!("is not a supported model file but {found}"),
            )
        })?,
    };
    rest(&mut bytes)?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        return Err(too_large(bytes.len() as u64));
    }
    Ok((bytes, format))
}

fn too_large(bytes: u64) -> LoadError {
    let what = format!("too large: {bytes} bytes; the limit is {MAX_FILE_BYTES}");
    LoadError::Other(ReadErrorKind::Size, what)
}

/// Appends the rest of a stream to `bytes`; `size` is that of the whole file, if
/// known.
fn read_rest(stream: impl Read, size: Option<u64>, bytes: &mut Vec<u8>) -> Result<(), LoadError> {
    // The size is only a hint for the reservation.
    let rest = size.unwrap_or_default().saturating_sub(bytes.len() as u64);
    if let Ok(rest) = usize::try_from(rest) {
        let refused = |_| {
            let what = format!("too large: no memory for {} bytes", size.unwrap_or_default());
            LoadError::Other(ReadErrorKind::Size, what)
        };
        // One byte more, so that the end is found without growing.
        bytes.try_reserve_exact(rest + 1).map_err(refused)?;
    }
    let limit = MAX_FILE_BYTES - bytes.len() as u64 + 1;
    stream.take(limit).read_to_end(bytes).map_err(LoadError::Io)?;
    // Another program shortened the file meanwhile.
    if size.is_some_and(|size| (bytes.len() as u64) < size) {
        return Err(LoadError::Io(io::ErrorKind::UnexpectedEof.into()));
    }
    Ok(())
}

/// Reads one file with several threads.
#[cfg(unix)]
mod parallel {
    use std::fs::File;
    use std::io;
    use std::os::unix::fs::FileExt as _;

    use rayon::prelude::*;

    /// Bytes that a thread reads at a time.
    const BLOCK: usize = 4 << 20;

    /// Reads the first `size` bytes of a file; fails if it has become shorter.
    pub(super) fn read_all(file: &File, size: u64) -> io::Result<Vec<u8>> {
        let no_memory = |()| io::Error::from(io::ErrorKind::OutOfMemory);
        let length = usize::try_from(size).map_err(|_| no_memory(()))?;
        // Zeroed by the system, so that each page is first touched by its thread.
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
    use std::fs::{self, File};

    use super::*;

    #[test]
    fn folders_and_missing_files_are_told_apart() {
        let folder = tempfile::tempdir().unwrap();
        let what = |path: &Path| load(path, None).unwrap_err().what;
        assert!(what(folder.path()).contains("is a folder"));
        assert!(what(&folder.path().join("none.obj")).contains("cannot be read"));
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn devices_are_refused() {
        for format in [None, Some(Format::Obj)] {
            let error = load(Path::new("/dev/zero"), format).unwrap_err();
            assert_eq!(error.kind, ReadErrorKind::Format);
            assert!(error.what.contains("a device, not a regular file"), "{error}");
        }
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
