//! Dependencies in the manifests: crates in the wrong place, crates that nothing uses,
//! features that would build everything twice.

use std::collections::BTreeSet;
use std::process::Command;
use std::{env, fs};

use testkit::locate::workspace_root;
use toml::{Table, Value};

use super::source::first_segments;
use super::{assert_none, sources};

/// Crates that `edgemesh` must not depend on: it has no GPU, window or picture.
const FOREIGN: [&str; 6] = ["wgpu", "naga", "winit", "egui", "eframe", "image"];

/// The packages: the folder, and the folders whose code uses `[dependencies]`; all other
/// code uses `[dev-dependencies]`. `testkit` and `fuzz` consist of tests.
const PACKAGES: [(&str, &[&str]); 10] = [
    ("brushes", &["src"]),
    ("crates/edgemesh", &["src"]),
    ("crates/strokes", &["src"]),
    ("crates/viewer", &["src"]),
    ("fuzz", &["src", "fuzz_targets"]),
    ("models", &["src"]),
    ("shaders", &["src"]),
    ("techniques", &["src"]),
    ("tests", &["src", "tests"]),
    ("xtask", &["src"]),
];

/// Packages with a library of another name.
const RENAMED: [(&str, &str); 1] = [("obj-rs", "obj")];

/// Dependencies that no code names, with their purpose.
const UNNAMED: [(&str, &str, &str); 1] =
    [("tests", "getrandom", "its features: see `the_demo_builds_what_the_tests_use`")];

/// The lines of `cargo tree`, one per package; `None` if it cannot run.
fn cargo_tree(arguments: &[&str]) -> Option<Vec<String>> {
    let manifest = workspace_root().join("Cargo.toml");
    if fs::metadata(&manifest).is_err() {
        eprintln!("skipped the dependencies: no {}", manifest.display());
        return None;
    }
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(cargo)
        .args(["tree", "--offline", "--prefix", "none"])
        .args(arguments)
        .arg("--manifest-path")
        .arg(&manifest)
        .output();
    let Ok(output) = output else {
        eprintln!("skipped the dependencies: no cargo");
        return None;
    };
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "cargo tree failed: {stderr}");
    let lines = String::from_utf8_lossy(&output.stdout);
    Some(lines.lines().map(|line| line.trim_end_matches(" (*)").to_owned()).collect())
}

/// The name of the crate in a line such as `glam v0.34.0`.
fn name(line: &str) -> &str {
    line.split_whitespace().next().unwrap_or("")
}

fn is_foreign(name: &str) -> bool {
    FOREIGN.iter().any(|foreign| {
        // wgpu-core and egui_extras are as foreign as wgpu and egui.
        name.strip_prefix(foreign)
            .is_some_and(|rest| rest.is_empty() || rest.starts_with(['-', '_']))
    })
}

#[test]
fn edgemesh_needs_no_gpu_and_no_window() {
    let Some(lines) = cargo_tree(&["--edges", "normal", "--package", "edgemesh"]) else { return };
    assert_eq!(lines.first().map(|line| name(line)), Some("edgemesh"), "{lines:#?}");
    assert!(lines.len() > 5, "cargo tree lists the crates: {lines:#?}");
    let foreign: Vec<&str> =
        lines.iter().map(|line| name(line)).filter(|n| is_foreign(n)).collect();
    assert!(foreign.is_empty(), "edgemesh depends on {foreign:?}");
}

#[test]
fn foreign_crates_are_known_by_their_names() {
    for line in ["wgpu v30.0.0", "wgpu-core v30.0.0", "egui_extras v0.37.0", "image v0.25.1"] {
        assert!(is_foreign(name(line)), "{line}");
    }
    for line in ["glam v0.34.0", "imagesize v0.1.0", "edgemesh v0.1.0 (/somewhere)"] {
        assert!(!is_foreign(name(line)), "{line}");
    }
}

/// Dependencies of tests turn on features of shared crates. If the demo is built without
/// them, everything that depends on such a crate is built twice. A failure lists the
/// packages with their features in the demo: add those of the tests to `tests/Cargo.toml`,
/// as for `getrandom`.
#[test]
fn the_demo_builds_what_the_tests_use() {
    let packages = |edges: &str| {
        let lines = cargo_tree(&[
            "--workspace",
            "--features",
            "testkit/gpu",
            "--format",
            "{p} {f}",
            "--edges",
            edges,
        ])?;
        Some(lines.into_iter().collect::<BTreeSet<_>>())
    };
    let Some((demo, tests)) = packages("normal,build").zip(packages("normal,build,dev")) else {
        return;
    };
    assert!(demo.len() > 100, "cargo tree lists the crates: {demo:#?}");
    let twice: Vec<String> = demo.difference(&tests).cloned().collect();
    assert_none(&twice);
}

/// The first names of all paths in the code of a folder, including tests.
fn named_in(folders: &[String]) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for (file, text) in folders.iter().flat_map(|folder| sources(folder)) {
        names.extend(first_segments(&text).unwrap_or_else(|error| panic!("{file}: {error}")));
    }
    names
}

/// The names in a manifest's tables of one kind, including those of some systems.
fn asked_for(manifest: &Table, kind: &str) -> Vec<String> {
    let targets = manifest.get("target").and_then(Value::as_table);
    let targets = targets.into_iter().flat_map(Table::values).filter_map(Value::as_table);
    std::iter::once(manifest)
        .chain(targets)
        .filter_map(|table| table.get(kind)?.as_table())
        .flat_map(|table| table.keys().cloned())
        .collect()
}

fn manifest(folder: &str) -> Option<Table> {
    let path = workspace_root().join(folder).join("Cargo.toml");
    let text = fs::read_to_string(&path).ok()?;
    Some(text.parse().unwrap_or_else(|error| panic!("{}: {error}", path.display())))
}

/// The dependencies of a package that its code does not name.
fn unused(
    folder: &str,
    asked: &[String],
    named: &BTreeSet<String>,
) -> impl Iterator<Item = String> {
    asked.iter().filter_map(move |package| {
        let library = RENAMED.iter().find(|known| known.0 == package).map(|known| known.1);
        let library = library.unwrap_or(package).replace('-', "_");
        let is_known = UNNAMED.iter().any(|&(of, name, _)| (of, name) == (folder, package));
        (!is_known && !named.contains(&library)).then(|| format!("{folder}: {package}"))
    })
}

#[test]
fn every_dependency_is_used() {
    let Some(workspace) = manifest("") else {
        return eprintln!("skipped the dependencies: no source");
    };
    let mut lines = Vec::new();
    let mut asked_by_all = BTreeSet::new();
    for (folder, code) in PACKAGES {
        let manifest = manifest(folder).unwrap();
        let in_folders = |names: &[&str]| -> Vec<String> {
            names.iter().map(|name| format!("{folder}/{name}")).collect()
        };
        let of_code = named_in(&in_folders(code));
        let of_all = named_in(&in_folders(&["src", "tests", "benches", "examples"]));
        for (kind, named) in [("dependencies", &of_code), ("dev-dependencies", &of_all)] {
            let asked = asked_for(&manifest, kind);
            lines.extend(unused(folder, &asked, named));
            asked_by_all.extend(asked);
        }
        let built = asked_for(&manifest, "build-dependencies");
        assert!(built.is_empty(), "{folder}: add build.rs to this check for {built:?}");
    }
    let known = workspace["workspace"]["dependencies"].as_table().unwrap();
    let nobodys = known.keys().filter(|name| !asked_by_all.contains(*name));
    lines.extend(nobodys.map(|name| format!("the workspace: {name}")));
    assert_none(&lines);
}

/// A package that the profile does not list is optimized like a dependency and has no line
/// numbers in backtraces.
#[test]
fn the_profile_lists_every_package() {
    let Some(workspace) = manifest("") else {
        return eprintln!("skipped the profile: no source");
    };
    let members = workspace["workspace"]["members"].as_array().unwrap().iter();
    let packages: BTreeSet<String> = members
        .map(|folder| manifest(folder.as_str().unwrap()).unwrap())
        .map(|manifest| manifest["package"]["name"].as_str().unwrap().to_owned())
        .collect();
    let listed = workspace["profile"]["dev"]["package"].as_table().unwrap();
    let listed: BTreeSet<String> = listed.keys().cloned().collect();
    assert_eq!(packages, listed);
}

#[test]
fn a_dependency_that_nothing_names_is_found() {
    let named: BTreeSet<String> =
        first_segments("use obj::Obj; fn of() { vec![ply_rs_bw::new()]; }")
            .unwrap()
            .into_iter()
            .collect();
    let asked = ["obj-rs", "ply-rs-bw", "criterion", "getrandom"].map(str::to_owned);
    let lines: Vec<String> = unused("tests", &asked, &named).collect();
    assert_eq!(lines, ["tests: criterion"]);
}
