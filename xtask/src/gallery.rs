//! `cargo xtask gallery MODEL...`: draws each technique on some models, as pictures and a
//! page in `docs/`.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::failure::Failure;
use crate::{adapter, programs};

/// Credits of models, by file name.
const CREDITS: [(&str, &str); 2] =
    [("spot", "Spot by Keenan Crane"), ("fandisk", "the fan disk by Hugues Hoppe")];

/// Width and height of the pictures.
const SIZE: &str = "320x320";

pub(crate) fn run(models: &[&str]) -> Result<(), Failure> {
    let programs = programs::build()?;
    adapter::ensure(&programs.viewer)?;
    let docs = programs::workspace_root().join("docs");
    let folder = docs.join("gallery");
    std::fs::create_dir_all(&folder).map_err(|error| Failure::file("make", &folder, error))?;
    let techniques = techniques(&programs.viewer)?;
    let models: Vec<PathBuf> = models.iter().map(PathBuf::from).collect();
    for (technique, _) in &techniques {
        for model in &models {
            let mut command = Command::new(&programs.viewer);
            command.arg("-q").arg("render").arg(model);
            command.arg("-o").arg(folder.join(picture_name(technique, model)));
            command.args(["--size", SIZE, "--technique", technique]);
            adapter::use_vulkan(&mut command)?;
            programs::run(&mut command)?;
        }
        println!("{technique}");
    }
    let page = docs.join("gallery.md");
    std::fs::write(&page, page_of(&techniques, &models))
        .map_err(|error| Failure::file("write", &page, error))
}

/// The names and descriptions of the techniques.
fn techniques(viewer: &Path) -> Result<Vec<(String, String)>, Failure> {
    let mut command = Command::new(viewer);
    command.args(["techniques", "list", "--folder", "/"]);
    let output = command.output().map_err(|error| programs::cannot_start(&command, &error))?;
    if !output.status.success() {
        return Err(Failure::new(String::from_utf8_lossy(&output.stderr)));
    }
    let text = String::from_utf8_lossy(&output.stdout);
    let row = |line: &str| {
        let (name, about) = line.split_once(' ')?;
        Some((name.to_owned(), about.trim().to_owned()))
    };
    Ok(text.lines().filter_map(row).collect())
}

fn picture_name(technique: &str, model: &Path) -> String {
    let model = model.file_stem().unwrap_or_default().to_string_lossy();
    format!("{technique}-{model}.png")
}

fn page_of(techniques: &[(String, String)], models: &[PathBuf]) -> String {
    let credits: Vec<&str> = CREDITS
        .iter()
        .filter(|(name, _)| {
            models.iter().any(|model| model.file_stem().is_some_and(|s| s == *name))
        })
        .map(|(_, credit)| *credit)
        .collect();
    let mut page =
        "# Gallery\n\nEvery technique that comes with Edgemesh, drawn by `viewer render \
                    MODEL -o OUT.png --technique NAME` with default settings.\n`cargo xtask \
                    gallery MODEL...` draws the pictures and writes this page.\n\n|  |"
            .to_owned();
    for _ in models {
        page += " |";
    }
    page += "\n|---|";
    for _ in models {
        page += "---|";
    }
    page.push('\n');
    for (technique, about) in techniques {
        let _ = write!(page, "| `{technique}`: {about} |");
        for model in models {
            let name = picture_name(technique, model);
            let _ = write!(page, " ![{technique}](gallery/{name}) |");
        }
        page.push('\n');
    }
    if !credits.is_empty() {
        let _ = writeln!(page, "\nModels: {}.", credits.join("; "));
    }
    page
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_technique_is_on_the_page_with_a_picture_that_is_there() {
        let root = programs::workspace_root();
        let page = std::fs::read_to_string(root.join("docs/gallery.md")).unwrap();
        for (name, _) in edgemesh_techniques::TECHNIQUES {
            assert!(page.contains(&format!("| `{name}`: ")), "{name} is not in the gallery");
        }
        let pictures = page.split("](").skip(1).filter_map(|rest| rest.split_once(')'));
        for (picture, _) in pictures {
            assert!(root.join("docs").join(picture).is_file(), "{picture} is missing");
        }
    }
}
