//! Targets of results: a file, standard output, or a folder for several files.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use super::failure::Failure;
use super::output::print_to_stdout;
use crate::format::whole_file::{is_stream, write_file};

/// Each input with its output file.
#[derive(Debug)]
pub(crate) struct Targets {
    pairs: Vec<(PathBuf, PathBuf)>,
}

impl Targets {
    /// Writes one input to `output`, or inputs to the folder `output` under their names with the
    /// extension `extension`.
    ///
    /// # Errors
    /// Fails if a result would overwrite another result or an input, or if several inputs have no
    /// folder.
    pub(crate) fn new(inputs: &[PathBuf], output: &Path, extension: &str) -> Result<Self, Failure> {
        let is_folder = output.is_dir();
        if inputs.len() > 1 && !is_folder {
            return Err(Failure::usage(format!(
                "{}: several inputs need a folder for their results; create it first",
                output.display()
            )));
        }
        let mut pairs: Vec<(PathBuf, PathBuf)> = Vec::with_capacity(inputs.len());
        for input in inputs {
            let target = if is_folder {
                output.join(file_name(input, extension))
            } else {
                output.to_owned()
            };
            if let Some((other, _)) = pairs.iter().find(|(_, taken)| *taken == target) {
                return Err(Failure::usage(format!(
                    "{} and {} would both be written to {}",
                    other.display(),
                    input.display(),
                    target.display()
                )));
            }
            pairs.push((input.clone(), target));
        }
        let targets = Self { pairs };
        targets.check_inputs()?;
        Ok(targets)
    }

    /// Fails if an output is an input, also by another path.
    fn check_inputs(&self) -> Result<(), Failure> {
        let same = |a: &Path, b: &Path| {
            a.canonicalize().ok().zip(b.canonicalize().ok()).is_some_and(|(a, b)| a == b)
        };
        for (_, target) in &self.pairs {
            if let Some((input, _)) = self.pairs.iter().find(|(input, _)| same(input, target)) {
                return Err(Failure::usage(format!(
                    "{}: -o would overwrite this input; give another file",
                    input.display()
                )));
            }
        }
        Ok(())
    }

    pub(crate) fn pairs(&self) -> impl Iterator<Item = (&Path, &Path)> {
        self.pairs.iter().map(|(input, target)| (input.as_path(), target.as_path()))
    }
}

/// The name of `input` with the extension `extension`.
fn file_name(input: &Path, extension: &str) -> OsString {
    let stem = match input.file_stem() {
        Some(stem) if input != Path::new("-") => stem.to_owned(),
        _ => OsString::from("stdin"),
    };
    let mut name = stem;
    name.push(".");
    name.push(extension);
    name
}

/// Writes a result to its file, or to standard output for `-`.
pub(crate) fn write_target(target: &Path, bytes: &[u8]) -> Result<(), Failure> {
    if target == Path::new("-") { print_to_stdout(bytes) } else { Ok(write_file(target, bytes)?) }
}

/// The material library beside the OBJ file `target`: its path and its name. `None` for a stream,
/// and for a name that a statement cannot have.
pub(crate) fn library_beside(target: &Path) -> Option<(PathBuf, String)> {
    if target == Path::new("-") || is_stream(target) {
        return None;
    }
    let name = format!("{}.mtl", target.file_stem()?.to_str()?);
    let is_plain = name.trim() == name && !name.contains(char::is_control);
    is_plain.then(|| (target.with_file_name(&name), name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn several_inputs_keep_their_names_in_a_folder() {
        let folder = tempfile::tempdir().unwrap();
        let inputs = [PathBuf::from("a/one.obj"), PathBuf::from("b/two.stl")];
        let targets = Targets::new(&inputs, folder.path(), "edgemesh").unwrap();
        let names: Vec<_> = targets.pairs().map(|(_, target)| target.file_name()).collect();
        assert_eq!(names, [Some("one.edgemesh".as_ref()), Some("two.edgemesh".as_ref())]);
        let same = [PathBuf::from("a/one.obj"), PathBuf::from("b/one.stl")];
        assert!(Targets::new(&same, folder.path(), "glb").is_err());
        assert!(Targets::new(&inputs, Path::new("none.glb"), "glb").is_err());
    }

    #[test]
    fn an_input_is_never_overwritten() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.obj");
        std::fs::write(&path, "v 0 0 0\n").unwrap();
        let inputs = [path.clone()];
        assert!(Targets::new(&inputs, &path, "obj").is_err());
        assert!(Targets::new(&inputs, &folder.path().join(".").join("a.obj"), "obj").is_err());
        assert!(Targets::new(&inputs, folder.path(), "obj").is_err());
        assert!(Targets::new(&inputs, folder.path(), "glb").is_ok());
    }

    #[test]
    fn a_library_stands_beside_a_file() {
        let library = library_beside(Path::new("a b/part.obj"));
        assert_eq!(library, Some(("a b/part.mtl".into(), "part.mtl".into())));
        for stream in ["-", "/dev/stdout", "a/ part.obj"] {
            assert_eq!(library_beside(Path::new(stream)), None, "{stream}");
        }
    }
}
