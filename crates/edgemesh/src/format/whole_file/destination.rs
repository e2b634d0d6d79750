//! Where the bytes of an output go: into a stream, or into a file behind links.
//!
//! Links are followed one by one, because the file that the last one names may not exist yet. Those
//! in `/proc` to a pipe are kept, because their texts are no paths.

use std::path::{Path, PathBuf};
use std::{fs, io};

/// The longest chain of links, as in Linux.
const MAX_LINKS: usize = 40;

/// Where the bytes of an output go.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Destination {
    /// Standard output of this process.
    Stdout,
    /// Standard error of this process.
    Stderr,
    /// A device, pipe or socket, which is written to and never replaced.
    Stream(PathBuf),
    /// A regular file or a folder, or nothing yet; not a link.
    File(PathBuf),
}

impl Destination {
    /// The destination of the output `path`.
    ///
    /// # Errors
    /// Fails if links form a circle, or the operating system does not show what stands at `path`.
    pub(super) fn of(path: &Path) -> io::Result<Self> {
        let mut path = path.to_owned();
        for _ in 0..MAX_LINKS {
            if let Some(stream) = standard_stream(&path) {
                return Ok(stream);
            }
            let is_stream = match fs::metadata(&path) {
                Ok(found) => !found.is_file() && !found.is_dir(),
                Err(error) if is_absent(&error) => false,
                Err(error) => return Err(error),
            };
            let target = fs::read_link(&path).map(|target| folder_of(&path).join(target));
            match target {
                Ok(target) if !is_stream || fs::symlink_metadata(&target).is_ok() => path = target,
                _ if is_stream => return Ok(Self::Stream(path)),
                _ => return Ok(Self::File(path)),
            }
        }
        Err(io::Error::other("too many links"))
    }
}

/// The standard stream that `path` is a name of. A second opening would not share its position:
/// what other commands wrote into the same file would be lost.
fn standard_stream(path: &Path) -> Option<Destination> {
    match path.to_str()? {
        "/dev/stdout" | "/dev/fd/1" | "/proc/self/fd/1" => Some(Destination::Stdout),
        "/dev/stderr" | "/dev/fd/2" | "/proc/self/fd/2" => Some(Destination::Stderr),
        _ => None,
    }
}

fn is_absent(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory)
}

/// The folder of the file `path`; `.` for a bare name.
pub(crate) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

#[cfg(all(test, unix))]
mod tests {
    use std::os::unix::fs::symlink;
    use std::os::unix::net::UnixListener;

    use super::*;

    #[test]
    fn links_are_followed_to_a_file_that_may_not_exist() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::create_dir(path("below")).unwrap();
        symlink("below/second", path("first")).unwrap();
        symlink("none.obj", path("below/second")).unwrap();
        let of = |name: &str| Destination::of(&path(name)).unwrap();
        assert_eq!(of("first"), Destination::File(path("below/none.obj")));
        fs::write(path("below/none.obj"), "").unwrap();
        assert_eq!(of("first"), Destination::File(path("below/none.obj")));
        assert_eq!(of("new"), Destination::File(path("new")));
        symlink("circle", path("circle")).unwrap();
        assert!(Destination::of(&path("circle")).is_err());
    }

    #[test]
    fn streams_are_no_files() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let _socket = UnixListener::bind(path("socket")).unwrap();
        symlink("socket", path("link")).unwrap();
        for name in ["socket", "link"] {
            assert_eq!(Destination::of(&path(name)).unwrap(), Destination::Stream(path("socket")));
        }
        symlink("/dev/stdout", path("out")).unwrap();
        assert_eq!(Destination::of(&path("out")).unwrap(), Destination::Stdout);
        assert_eq!(Destination::of("/dev/fd/2".as_ref()).unwrap(), Destination::Stderr);
    }
}
