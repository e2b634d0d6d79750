//! Compares with the test cases of the Khronos validator, if they are at hand: there is
//! a warning or error for each file that it rejects, and none for the others.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::{env, fs};

use serde_json::Value;

use super::super::source::Source;
use super::{glb, read_gltf};
use crate::format::validate::gltf::check;
use crate::report::{Report, WarningCode};

/// Error codes that need no warning, and why.
const ACCEPTED: [(&str, &str); 15] = [
    ("ACCESSOR_INVALID_FLOAT", "data is checked when it is drawn"),
    ("ACCESSOR_ELEMENT_OUT_OF_MIN_BOUND", "data is checked when it is drawn"),
    ("ACCESSOR_ANIMATION_SAMPLER_OUTPUT_NON_NORMALIZED_QUATERNION", "animations are not read"),
    ("ANIMATION_CHANNEL_TARGET_NODE_MATRIX", "animations are not read"),
    ("ANIMATION_CHANNEL_TARGET_NODE_WEIGHTS_NO_MORPHS", "animations are not read"),
    ("ANIMATION_SAMPLER_INPUT_ACCESSOR_INVALID_FORMAT", "animations are not read"),
    ("ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_FORMAT", "animations are not read"),
    ("BUFFER_VIEW_INVALID_BYTE_STRIDE", "the use of a view does not matter here"),
    ("BUFFER_VIEW_TARGET_OVERRIDE", "the use of a view does not matter here"),
    ("IMAGE_DATA_INVALID", "pictures are not decoded"),
    ("INVALID_URI", "pictures and buffers that are not drawn are not opened"),
    ("IO_ERROR", "pictures and buffers that are not drawn are not opened"),
    ("MESH_PRIMITIVE_NO_TANGENT_SPACE", "pictures of normals are not read"),
    ("MESH_PRIMITIVE_TOO_FEW_TEXCOORDS", "a picture without texture coordinates is not drawn"),
    ("SKIN_NO_COMMON_ROOT", "joints need no common root here"),
];

/// Files with another verdict than that of the validator, and why.
const JUDGED_OTHERWISE: [(&str, &str); 5] = [
    ("base/data/asset/min_version_valid.gltf", "it needs a reader of version 2.1"),
    ("base/data/root/unused_objects.gltf", "its only buffer has no data"),
    ("base/data/skin/no_joints_in_scene.gltf", "joints need not be drawn to be followed"),
    (
        "ext/KHR_lights_punctual/data/light/spot_light_without_spot_object.gltf",
        "lights are not read",
    ),
    ("ext/KHR_materials_variants/data/variant/invalid_name.gltf", "variants are not read"),
];

#[test]
#[expect(clippy::print_stderr, reason = "reports what was left out")]
fn its_errors_give_warnings_and_sound_files_do_not() {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let shared = env::var_os("EDGEMESH_SHARED").map_or(beside, PathBuf::from);
    let folder = shared.join("corpus/malformed/gltf/khronos-validator");
    if !folder.is_dir() {
        eprintln!("left out the validator's cases: set EDGEMESH_SHARED to the shared files");
        return;
    }
    let mut reports = Vec::new();
    find_reports(&folder, &mut reports);
    let mut differing = BTreeSet::new();
    let mut wrong = Vec::new();
    for path in &reports {
        let errors = error_codes(path);
        let file = path.with_extension("").with_extension("");
        let name = file.strip_prefix(&folder).unwrap().to_string_lossy().replace('\\', "/");
        if has_fault(&file) != errors.is_empty() {
            continue;
        }
        let code = ACCEPTED.iter().find(|(code, _)| errors.iter().any(|error| error == code));
        let file = JUDGED_OTHERWISE.iter().find(|(file, _)| *file == name);
        match code.or(file) {
            Some((excuse, _)) => _ = differing.insert(*excuse),
            None => wrong.push(format!("{name}: {errors:?}")),
        }
    }
    assert!(reports.len() > 150, "only {} cases in {}", reports.len(), folder.display());
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), reports.len(), wrong.join("\n"));
    let excuses = ACCEPTED.iter().chain(&JUDGED_OTHERWISE).map(|(excuse, _)| *excuse);
    let needless: Vec<&str> = excuses.filter(|excuse| !differing.contains(excuse)).collect();
    assert!(needless.is_empty(), "no longer needed: {needless:?}");
}

fn find_reports(folder: &Path, into: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            find_reports(&path, into);
        } else if path.to_string_lossy().ends_with(".report.json") {
            into.push(path);
        }
    }
}

fn error_codes(report: &Path) -> Vec<String> {
    let json: Value = serde_json::from_slice(&fs::read(report).unwrap()).unwrap();
    let messages = json["issues"]["messages"].as_array().unwrap().iter();
    let errors = messages.filter(|message| message["severity"] == 0);
    errors.map(|message| message["code"].as_str().unwrap().to_owned()).collect()
}

/// Whether the container, the rules or the reader find a fault in a file. The reader
/// alone accepts files without geometry.
fn has_fault(path: &Path) -> bool {
    let bytes = fs::read(path).unwrap();
    let name = path.display().to_string();
    let source = Source { name: &name, folder: path.parent(), bytes: &bytes };
    let mut report = Report::default();
    let Ok(container) = glb::open(&source, &mut report) else { return true };
    let is_refused = read_gltf(&source, |_, _| (), &mut Report::default()).is_err();
    if let Ok(root) = serde_json::from_slice(container.json) {
        check(&root, &mut report);
    }
    is_refused || report.count(WarningCode::Syntax) > 0
}
