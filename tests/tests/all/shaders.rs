//! Every shader file is valid with the resolver that the renderer uses.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use edgemesh_shaders::ShaderSource;
use edgemesh_shaders::files::all;
use testkit::locate::workspace_root;

/// All shader files on disk: the path from the shader folder, and the text.
pub(crate) fn shader_files() -> BTreeMap<String, String> {
    fn walk(folder: &Path, prefix: &str, files: &mut BTreeMap<String, String>) {
        for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
            let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
            if entry.path().is_dir() {
                walk(&entry.path(), &format!("{name}/"), files);
            } else if name.ends_with(".wgsl") {
                files.insert(name, fs::read_to_string(entry.path()).unwrap());
            }
        }
    }
    let mut files = BTreeMap::new();
    let folder = workspace_root().join("shaders");
    walk(&folder, "", &mut files);
    assert!(files.len() > 8, "too few shaders under {}", folder.display());
    files
}

#[test]
fn the_embedded_shaders_are_those_on_disk() {
    let embedded: BTreeMap<String, String> =
        all().map(|(path, text)| ((*path).to_owned(), (*text).to_owned())).collect();
    assert_eq!(embedded, shader_files());
}

#[test]
fn every_shader_is_valid_and_common_files_have_no_entry_points() {
    let mut failures = Vec::new();
    for path in shader_files().keys() {
        match ShaderSource::embedded(path).and_then(|source| source.validate()) {
            Err(error) => failures.push(error.to_string()),
            Ok(module) => {
                let is_root = !path.starts_with("common/");
                if is_root == module.entry_points.is_empty() {
                    failures.push(format!("{path}: entry points belong outside of common/"));
                }
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// Comments that name a twin name an existing file.
#[test]
fn files_that_comments_name_exist() {
    let root = workspace_root();
    let mut missing = Vec::new();
    for (path, text) in shader_files() {
        let words = text.split(|letter: char| letter.is_whitespace() || ",;()".contains(letter));
        for word in words.filter(|word| word.starts_with("crates/") && word.contains(".rs")) {
            let named = &word[..word.find(".rs").unwrap_or(0) + 3];
            if !root.join(named).is_file() {
                missing.push(format!("{path}: {named}"));
            }
        }
    }
    assert!(missing.is_empty(), "{}", missing.join("\n"));
}
