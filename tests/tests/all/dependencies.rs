//! What the crates depend on.

use std::process::Command;
use std::{env, fs};

use testkit::locate::workspace_root;

/// Crates that have no place in `edgemesh`: it runs where there is no GPU, no
/// window and no picture.
const FOREIGN: [&str; 6] = ["wgpu", "naga", "winit", "egui", "eframe", "image"];

/// `cargo tree`, a crate a line; `None` where there is nothing to run or read.
fn tree(package: &str) -> Option<Vec<String>> {
    let manifest = workspace_root().join("Cargo.toml");
    if fs::metadata(&manifest).is_err() {
        eprintln!("left out the dependencies of {package}: no {}", manifest.display());
        return None;
    }
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(cargo)
        .args(["tree", "--edges", "normal", "--prefix", "none", "--offline", "--package", package])
        .arg("--manifest-path")
        .arg(&manifest)
        .output();
    let Ok(output) = output else {
        eprintln!("left out the dependencies of {package}: no cargo to ask");
        return None;
    };
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "cargo tree failed: {stderr}");
    Some(String::from_utf8_lossy(&output.stdout).lines().map(str::to_owned).collect())
}

/// The name of a crate in a line such as `glam v0.34.0 (*)`.
fn name(line: &str) -> &str {
    line.split_whitespace().next().unwrap_or("")
}

fn is_foreign(name: &str) -> bool {
    FOREIGN.iter().any(|foreign| {
        // wgpu-core and egui_extras are as foreign as wgpu and egui themselves.
        name.strip_prefix(foreign)
            .is_some_and(|rest| rest.is_empty() || rest.starts_with(['-', '_']))
    })
}

#[test]
fn edgemesh_needs_no_gpu_and_no_window() {
    let Some(lines) = tree("edgemesh") else { return };
    assert_eq!(lines.first().map(|line| name(line)), Some("edgemesh"), "{lines:#?}");
    assert!(lines.len() > 5, "cargo tree lists the crates: {lines:#?}");
    let foreign: Vec<&str> =
        lines.iter().map(|line| name(line)).filter(|n| is_foreign(n)).collect();
    assert!(foreign.is_empty(), "edgemesh depends on {foreign:?}");
}

#[test]
fn foreign_crates_are_known_by_their_names() {
    for line in ["wgpu v30.0.0", "wgpu-core v30.0.0", "egui_extras v0.37.0 (*)", "image v0.25.1"] {
        assert!(is_foreign(name(line)), "{line}");
    }
    for line in ["glam v0.34.0", "imagesize v0.1.0", "edgemesh v0.1.0 (/somewhere)"] {
        assert!(!is_foreign(name(line)), "{line}");
    }
}
