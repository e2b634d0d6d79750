//! The crates can be published: each package holds all that it is built from.
//!
//! `.ci/run` builds the packages as well, which takes minutes.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;
use std::{env, fs};

use testkit::locate::workspace_root;

/// The packages that can be published, and their folders.
const PUBLISHED: [(&str, &str); 7] = [
    ("edgemesh", "crates/edgemesh"),
    ("edgemesh-brushes", "brushes"),
    ("edgemesh-models", "models"),
    ("edgemesh-shaders", "shaders"),
    ("edgemesh-techniques", "techniques"),
    ("strokes", "crates/strokes"),
    ("viewer", "crates/viewer"),
];

/// What `cargo package` prints; `None` if there is no source.
fn cargo_package(arguments: &[&str]) -> Option<String> {
    let manifest = workspace_root().join("Cargo.toml");
    if !manifest.is_file() {
        eprintln!("left out the packages: no {}", manifest.display());
        return None;
    }
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.args(["package", "--offline", "--allow-dirty", "--no-verify", "--manifest-path"]);
    let output = command.arg(&manifest).args(arguments).output().unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "cargo package failed: {stderr}");
    Some(String::from_utf8_lossy(&output.stdout).into_owned())
}

#[test]
fn every_crate_can_be_packaged() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().to_str().unwrap();
    let arguments =
        ["--workspace", "--exclude", "testkit", "--exclude", "xtask", "--target-dir", target];
    if cargo_package(&arguments).is_none() {
        return;
    }
    let packages: BTreeSet<String> = fs::read_dir(folder.path().join("package"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
        .filter(|name| name.ends_with(".crate"))
        .collect();
    let version = env!("CARGO_PKG_VERSION");
    let expected = PUBLISHED.map(|(name, _)| format!("{name}-{version}.crate"));
    assert_eq!(packages, expected.into());
}

#[test]
fn a_package_holds_its_license_and_what_it_embeds() {
    for (name, folder) in PUBLISHED {
        let Some(list) = cargo_package(&["--list", "--package", name]) else { return };
        let files: BTreeSet<&str> = list.lines().collect();
        for file in ["Cargo.toml", "README.md", "LICENSE-APACHE", "LICENSE-MIT", "src/lib.rs"] {
            assert!(files.contains(file), "{name}: {file} is missing");
        }
        for file in files.iter().filter(|file| file.ends_with(".rs")) {
            let text = fs::read_to_string(workspace_root().join(folder).join(file)).unwrap();
            assert_eq!(left_by(file, &text), [""; 0], "{name}: {file} embeds from outside");
        }
    }
}

/// The embedded paths of a source file that lead out of its package, as far as they are
/// written in one literal.
fn left_by(file: &str, text: &str) -> Vec<String> {
    let depth = Path::new(file).parent().map_or(0, |folder| folder.components().count());
    let calls = ["include_str!", "include_bytes!"].iter().flat_map(|call| text.split(call).skip(1));
    let literals = calls.filter_map(|rest| rest.split('"').nth(1));
    let leaves = |path: &&str| path.split('/').take_while(|step| *step == "..").count() > depth;
    literals.filter(leaves).map(str::to_owned).collect()
}

#[test]
fn a_path_that_leads_out_of_a_package_is_found() {
    let text = |path: &str| format!("const TEXT: &str = include_str!(concat!({path:?}, $name));");
    assert_eq!(left_by("src/files.rs", &text("../common/")), [""; 0]);
    assert_eq!(left_by("src/load/input.rs", &text("../../data/")), [""; 0]);
    assert_eq!(left_by("src/load/input.rs", &text("../../../models/")), ["../../../models/"]);
    assert_eq!(left_by("src/lib.rs", "include_bytes!(\"../../a.png\")"), ["../../a.png"]);
}
