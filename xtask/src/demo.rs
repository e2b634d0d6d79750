//! `cargo xtask demo`: draws every model with some techniques.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::failure::Failure;
use crate::{adapter, programs};

const TECHNIQUES: [&str; 7] =
    ["ink", "pen", "charcoal", "watercolour", "fur", "hidden_line", "linked"];

pub(crate) fn run() -> Result<(), Failure> {
    let root = programs::workspace_root();
    let models = models_in(&root.join("models"))?;
    let programs = programs::build()?;
    adapter::ensure(&programs.viewer)?;

    let folder = programs::target_folder()?.join("demo");
    std::fs::create_dir_all(&folder).map_err(|error| Failure::file("make", &folder, error))?;
    for model in &models {
        for technique in TECHNIQUES {
            let picture = picture_path(&folder, model, technique);
            programs::run(&mut render(&programs.viewer, model, &picture, technique)?)?;
            println!("{}", from_root(&picture).display());
        }
    }
    let count = models.len() * TECHNIQUES.len();
    println!("made {count} pictures in {}", from_root(&folder).display());
    Ok(())
}

/// The folder's OBJ files, by name.
fn models_in(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let entries =
        std::fs::read_dir(folder).map_err(|error| Failure::file("read", folder, error))?;
    let mut models = Vec::new();
    for entry in entries {
        let path = entry.map_err(|error| Failure::file("read", folder, error))?.path();
        if path.extension().is_some_and(|extension| extension == "obj") {
            models.push(path);
        }
    }
    if models.is_empty() {
        let message = format!("no OBJ files in {}: run `cargo xtask models`", folder.display());
        return Err(Failure::new(message));
    }
    models.sort();
    Ok(models)
}

fn picture_path(folder: &Path, model: &Path, technique: &str) -> PathBuf {
    let name = model.file_stem().unwrap_or_default().to_string_lossy();
    folder.join(format!("{name}-{technique}.png"))
}

fn render(
    viewer: &Path,
    model: &Path,
    picture: &Path,
    technique: &str,
) -> Result<Command, Failure> {
    let mut command = Command::new(viewer);
    command.current_dir(programs::workspace_root());
    command.arg("render").arg(from_root(model)).arg("-o").arg(from_root(picture));
    command.args(["--size", "1024x1024", "--technique", technique]);
    adapter::use_vulkan(&mut command)?;
    Ok(command)
}

/// A path in the workspace, relative to its root; others stay as they are.
fn from_root(path: &Path) -> &Path {
    path.strip_prefix(programs::workspace_root()).unwrap_or(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_model_of_the_project_is_found_by_name() {
        let models = models_in(&programs::workspace_root().join("models")).unwrap();
        let names: Vec<_> = models.iter().filter_map(|path| path.file_name()).collect();
        assert!(names.is_sorted(), "{names:?}");
        assert!(names.contains(&"bracket.obj".as_ref()), "{names:?}");
        assert!(!names.contains(&"bracket.mtl".as_ref()), "{names:?}");
    }

    #[test]
    fn a_picture_is_named_for_its_model_and_technique() {
        let picture = picture_path(Path::new("target/demo"), Path::new("models/cube.obj"), "ink");
        assert_eq!(picture, Path::new("target/demo/cube-ink.png"));
    }
}
