//! Side files of marked edges. Each line has a pair of vertices, counted from 1 in the order of the
//! model file; `-` before a pair removes the mark that the model has there; `#` begins a comment.
//!
//! `MODEL.marks` beside a model is read with it, if it lies in the model's folder or below: a
//! symbolic link that leads elsewhere is not followed, so that a model cannot make a command
//! read any file of its user. A file that the user names may lie anywhere.

use std::fmt::Write as _;
use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::format::regular_file::read_regular;
use crate::format::whole_file::folder_of;

/// The largest side file that is read: 256 MiB, more than a mark for each edge of the largest
/// models.
const MAX_MARKS_BYTES: u64 = 256 << 20;

/// A side file could not be read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum MarksError {
    /// The operating system cannot read the file, or it is not a regular file, larger than
    /// 256 MiB, or not UTF-8.
    #[error("{}: cannot be read: {reason}", path.display())]
    Io {
        /// The side file.
        path: PathBuf,
        /// The error of the operating system.
        reason: io::Error,
    },
    /// A line is malformed.
    #[error("{}:{line}: {what}", path.display())]
    Line {
        /// The side file.
        path: PathBuf,
        /// The line, counted from 1.
        line: usize,
        /// The defect.
        what: String,
    },
}

/// The marks of a side file, as pairs of vertices of the model file, counted from 0.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct SideMarks {
    /// Pairs whose edges are marked.
    pub marked: Vec<[u32; 2]>,
    /// Pairs whose edges are not marked, although the model marks them.
    pub unmarked: Vec<[u32; 2]>,
}

/// The side file of a model: `part.obj.marks` for `part.obj`.
#[must_use]
pub fn side_file(model: &Path) -> PathBuf {
    let mut name = model.as_os_str().to_owned();
    name.push(".marks");
    name.into()
}

/// The side file that is read with `model`, if there is one.
///
/// # Errors
/// Fails with its path if it is a link out of the model's folder.
pub(super) fn marks_beside(model: &Path) -> Result<Option<PathBuf>, PathBuf> {
    let side = side_file(model);
    let (Ok(folder), Ok(target)) = (folder_of(model).canonicalize(), side.canonicalize()) else {
        return Ok(None);
    };
    match (target.is_file(), target.starts_with(folder)) {
        (false, _) => Ok(None),
        (true, true) => Ok(Some(side)),
        (true, false) => Err(side),
    }
}

/// Reads the side file at `path`.
///
/// # Errors
/// Fails if it is not a regular file, is larger than 256 MiB or cannot be read, or at the first
/// malformed line.
pub fn read_marks(path: &Path) -> Result<SideMarks, MarksError> {
    let failed = |reason| MarksError::Io { path: path.to_owned(), reason };
    let bytes = read_regular(path, MAX_MARKS_BYTES).map_err(failed)?;
    let text = String::from_utf8(bytes)
        .map_err(|_| failed(io::Error::new(io::ErrorKind::InvalidData, "it is not UTF-8 text")))?;
    parse_marks(&text).map_err(|(line, what)| MarksError::Line {
        path: path.to_owned(),
        line,
        what,
    })
}

/// The text of a side file with `marks`.
#[must_use]
pub fn marks_text(marks: &SideMarks) -> String {
    let mut text =
        "# marked edges: pairs of vertices, counted from 1; - removes a mark\n".to_owned();
    for (sign, pairs) in [("", &marks.marked), ("- ", &marks.unmarked)] {
        for [a, b] in pairs {
            let _ = writeln!(text, "{sign}{} {}", u64::from(*a) + 1, u64::from(*b) + 1);
        }
    }
    text
}

fn parse_marks(text: &str) -> Result<SideMarks, (usize, String)> {
    let mut marks = SideMarks::default();
    for (line, text) in text.lines().enumerate() {
        let text = text.split('#').next().unwrap_or_default().trim();
        let (text, pairs) = match text.strip_prefix('-') {
            Some(rest) => (rest, &mut marks.unmarked),
            None => (text, &mut marks.marked),
        };
        let words: Vec<&str> = text.split_whitespace().collect();
        match words[..] {
            [] => {}
            [a, b] => pairs.push([vertex(line, a)?, vertex(line, b)?]),
            _ => {
                let what = format!(
                    "a mark needs two vertices, such as '3 8'; this line has {}",
                    words.len()
                );
                return Err((line + 1, what));
            }
        }
    }
    Ok(marks)
}

fn vertex(line: usize, word: &str) -> Result<u32, (usize, String)> {
    match word.parse::<u32>() {
        Ok(vertex) if vertex > 0 => Ok(vertex - 1),
        _ => {
            Err((line + 1, format!("'{word}' is not a vertex number; vertices are counted from 1")))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_beside_a_model_are_read_in_its_folder_only() {
        let outer = tempfile::tempdir().unwrap();
        let folder = outer.path().join("models");
        std::fs::create_dir_all(folder.join("marks")).unwrap();
        let model = folder.join("a.obj");
        let side = side_file(&model);
        assert_eq!(marks_beside(&model), Ok(None));
        std::fs::write(&side, "1 2\n").unwrap();
        assert_eq!(marks_beside(&model), Ok(Some(side.clone())));
        #[cfg(unix)]
        for (place, expected) in
            [(folder.join("marks/a"), Ok(Some(side.clone()))), (outer.path().join("a"), Err(side))]
        {
            std::fs::write(&place, "3 4\n").unwrap();
            std::fs::remove_file(side_file(&model)).unwrap();
            std::os::unix::fs::symlink(&place, side_file(&model)).unwrap();
            assert_eq!(marks_beside(&model), expected);
        }
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn marks_are_a_regular_file_of_text() {
        let error = read_marks(Path::new("/dev/zero")).unwrap_err();
        assert!(error.to_string().contains("a device, not a regular file"), "{error}");
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("marks");
        std::fs::write(&path, [b'1', b' ', 0xff]).unwrap();
        assert!(read_marks(&path).unwrap_err().to_string().contains("not UTF-8"));
        std::fs::File::create(&path).unwrap().set_len(MAX_MARKS_BYTES + 1).unwrap();
        assert!(read_marks(&path).unwrap_err().to_string().contains("larger than 256 MiB"));
    }

    #[test]
    fn pairs_and_comments() {
        let marks = parse_marks("# seams\n1 2\n\n 7\t3 # rim\n- 4 5\n").unwrap();
        assert_eq!(
            (&marks.marked[..], &marks.unmarked[..]),
            (&[[0, 1], [6, 2]][..], &[[3, 4]][..])
        );
        assert_eq!(parse_marks(&marks_text(&marks)), Ok(marks), "written text is read back");
        for (text, line, part) in [
            ("1 2\n3", 2, "line has 1"),
            ("1 2 3", 1, "line has 3"),
            ("\n0 1", 2, "counted from 1"),
            ("1 x", 1, "'x'"),
        ] {
            let (at, what) = parse_marks(text).unwrap_err();
            assert!(at == line && what.contains(part), "{text}: {at} {what}");
        }
    }
}
