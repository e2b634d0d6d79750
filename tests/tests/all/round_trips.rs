//! Exported files say of themselves what their models say: `edgemesh info` of both is equal.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;
use testkit::locate::{left_out, shared};

use crate::child::{edgemesh, info, json, stderr};

/// Every format with a reader.
const FORMATS: [&str; 4] = ["glb", "gltf", "ply", "obj"];

/// The counts that must be equal. Those of duplicate faces are not among them, because an export
/// has none, and neither are those of the file, whose polygons an export has cut.
const KEYS: [&str; 6] =
    ["edges", "boundary_edges", "non_manifold_edges", "components", "triangles", "features"];

fn info_of(path: &Path) -> Value {
    let output = info(path);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    json(&output)
}

/// Asserts that exports of `model` in all formats are equal to it; returns its counts.
fn check(model: &Path) -> Value {
    let folder = tempfile::tempdir().unwrap();
    let expected = info_of(model);
    for format in FORMATS {
        let path = folder.path().join("out").with_extension(format);
        let arguments = ["export".as_ref(), model.as_os_str(), "-o".as_ref(), path.as_os_str()];
        let output = edgemesh(&arguments);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let found = info_of(&path);
        for key in KEYS {
            assert_eq!(found[key], expected[key], "{key} of {} as {format}", model.display());
        }
        check_bounds(&found, &expected, format);
    }
    expected
}

/// Bounds are equal but for the rounding of 32 bits.
fn check_bounds(found: &Value, expected: &Value, format: &str) {
    let corners = |info: &Value| -> Vec<f64> {
        let corner = |end: &str| info["bounds"][end].as_array().unwrap().clone();
        let both = [corner("min"), corner("max")].concat();
        both.iter().map(|number| number.as_f64().unwrap()).collect()
    };
    let (found, expected) = (corners(found), corners(expected));
    let size = expected.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
    for (a, b) in found.iter().zip(&expected) {
        assert!((a - b).abs() <= size * 1.2e-7, "{a} is not {b} as {format}");
    }
}

/// Two textured boxes of quads in two materials, one over the other, with a marked diagonal on
/// top, a line beside them and smoothing groups.
const BOXES: &str = "mtllib boxes.mtl\n\
v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
v 0 0 2\nv 1 0 2\nv 1 1 2\nv 0 1 2\nv 5 0 0\nv 6 0 0\n\
vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
usemtl red\ns 1\nf 1/1 4/2 3/3 2/4\nf 1/1 2/2 6/3 5/4\nf 2/1 3/2 7/3 6/4\n\
s 2\nf 3/1 4/2 8/3 7/4\nf 4/1 1/2 5/3 8/4\n\
usemtl blue\nf 5/1 6/2 10/3 9/4\nf 6/1 7/2 11/3 10/4\nf 7/1 8/2 12/3 11/4\n\
f 8 5 9 12\nf 9/1 10/2 11/3\nf 9/1 11/2 12/3\nl 9 11\nl 13 14\n";

const LIBRARY: &str = "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\nd 0.5\n";

#[test]
fn boxes_come_back_equal() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    fs::write(path("boxes.obj"), BOXES).unwrap();
    fs::write(path("boxes.mtl"), LIBRARY).unwrap();
    let counts = check(&path("boxes.obj"));
    // A belt of four edges between the materials; a diagonal and the line are marked.
    assert_eq!(counts["features"]["material"], 4, "{counts}");
    assert_eq!(counts["features"]["marked"], 2, "{counts}");
    assert!(counts["features"]["smoothing"].as_u64() > Some(0), "{counts}");
}

/// A material library stands beside an OBJ file, and never in the place of another program's.
#[test]
fn colors_come_back_from_a_library() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    fs::write(path("boxes.obj"), BOXES).unwrap();
    fs::write(path("boxes.mtl"), LIBRARY).unwrap();
    let export = |target: &str| {
        let [model, target] = [path("boxes.obj"), path(target)].map(PathBuf::into_os_string);
        edgemesh(&["export".as_ref(), model.as_os_str(), "-o".as_ref(), target.as_os_str()])
    };
    assert_eq!(export("out.obj").status.code(), Some(0));
    let text = fs::read_to_string(path("out.mtl")).unwrap();
    let rows: Vec<&str> = text.lines().skip(1).collect();
    assert_eq!(rows, ["newmtl red", "Kd 1 0 0", "newmtl blue", "Kd 0 0 1", "d 0.5"]);
    assert!(fs::read_to_string(path("out.obj")).unwrap().contains("\nmtllib out.mtl\n"));
    assert_eq!(export("out.obj").status.code(), Some(0), "again");
    fs::write(path("other.mtl"), LIBRARY).unwrap();
    let refused = export("other.obj");
    assert_eq!(refused.status.code(), Some(1), "{}", stderr(&refused));
    assert!(stderr(&refused).contains("other.mtl"), "{}", stderr(&refused));
    assert!(
        !path("other.obj").exists() && fs::read(path("other.mtl")).unwrap() == LIBRARY.as_bytes()
    );
}

/// Thresholds that are given classify an export again, as they do with an edge mesh.
#[test]
fn given_thresholds_classify_an_export_again() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    fs::write(path("boxes.obj"), BOXES).unwrap();
    let ridges = |path: &Path, arguments: &[&str]| {
        let model = ["info", "--json", path.to_str().unwrap()];
        let output = edgemesh(&[&model[..], arguments].concat());
        json(&output)["features"]["ridge"].as_u64().unwrap()
    };
    for format in FORMATS {
        let output = path("out").with_extension(format);
        let names = [path("boxes.obj"), output.clone()].map(PathBuf::into_os_string);
        let [model, target] = &names;
        let arguments: [&std::ffi::OsStr; 6] =
            ["export".as_ref(), model, "-o".as_ref(), target, "--crease".as_ref(), "120".as_ref()];
        assert_eq!(edgemesh(&arguments).status.code(), Some(0));
        assert_eq!(ridges(&output, &[]), 0, "as exported, {format}");
        let expected = ridges(&path("boxes.obj"), &["--crease", "60"]);
        assert_eq!((ridges(&output, &["--crease", "60"]), expected), (expected, 16), "{format}");
    }
}

#[test]
fn shared_models_come_back_equal() {
    let models = ["fandisk", "spot", "suzanne", "teapot"];
    let Some(shared) = shared() else { return left_out("exports", models.len()) };
    for model in models {
        check(&shared.join("models").join(model).with_extension("obj"));
    }
}
