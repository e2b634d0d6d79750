//! The cases of people's reports, with the counts that are right for them, worked out apart from
//! the program; and shared models made broken in ways that must not change their features.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use serde_json::Value;
use testkit::locate::{left_out, shared};

use crate::child::{edgemesh, json};

/// A case: a file, arguments, and the numbers at paths of its JSON.
type Case = (&'static str, &'static [&'static str], &'static [(&'static str, u64)]);

const CASES: &[Case] = &[
    (
        "double_sided_sheet.obj",
        &[],
        &[
            ("features/boundary", 32),
            ("features/ridge", 0),
            ("features/valley", 0),
            ("non_manifold_edges", 176),
            ("repairs/two_sided_faces", 128),
        ],
    ),
    (
        "slivers_on_a_flat_plate.obj",
        &[],
        &[("features/ridge", 0), ("features/valley", 0), ("features/boundary", 6)],
    ),
    ("cylinder_12.obj", &[], &[("features/ridge", 24), ("features/valley", 0)]),
    ("cylinder_12.obj", &["--crease", "29.99"], &[("features/ridge", 36)]),
    ("cylinder_12.obj", &["--crease", "30.01"], &[("features/ridge", 24)]),
    (
        "polygon_4098_corners.ply",
        &[],
        &[("features/contour", 0), ("repairs/ear_clipped_polygons", 1)],
    ),
    ("json_chunk_not_padded.glb", &[], &[("triangles", 12), ("features/ridge", 12)]),
    ("nan_msvc_new.obj", &[], &[("triangles", 12), ("features/ridge", 12)]),
    ("nan_msvc_old.obj", &[], &[("triangles", 12), ("features/ridge", 12)]),
    ("outline_with_short_indices.glb", &[], &[("features/marked", 12)]),
    ("peg_in_a_hole.obj", &[], &[("features/ridge", 12), ("non_manifold_edges", 144)]),
    (
        "cylinder_inside_out.obj",
        &[],
        &[
            ("features/ridge", 32),
            ("features/valley", 0),
            ("repairs/inside_out_faces", 60),
            ("repairs/flipped_faces", 0),
        ],
    ),
    ("three_instances.glb", &[], &[("components", 3), ("triangles", 36)]),
    ("circle_with_a_seam.obj", &[], &[("boundary_edges", 16)]),
    ("t_junction_plate.obj", &[], &[("boundary_edges", 7), ("components", 1)]),
];

fn number(info: &Value, path: &str) -> Option<u64> {
    info.pointer(&format!("/{path}"))?.as_u64()
}

#[test]
fn reported_files_give_what_is_right_for_them() {
    let Some(shared) = shared() else { return left_out("reports", CASES.len()) };
    let folder = shared.join("field/cases");
    for (file, arguments, expected) in CASES {
        let path = folder.join(file);
        let path = path.to_str().unwrap();
        let info = json(&edgemesh(&[&["info", path, "--json", "-q"], *arguments].concat()));
        for (key, count) in *expected {
            assert_eq!(number(&info, key), Some(*count), "{file} {arguments:?}: {key}");
        }
    }
}

/// The vertices and faces of an OBJ file of plain statements, counted from 0.
fn parts_of(path: &Path) -> (Vec<[f64; 3]>, Vec<Vec<usize>>) {
    let text = fs::read_to_string(path).unwrap();
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let mut number = || words.next().unwrap().parse().unwrap();
                positions.push([number(), number(), number()]);
            }
            Some("f") => {
                let corner =
                    |word: &str| word.split('/').next().unwrap().parse::<usize>().unwrap() - 1;
                faces.push(words.map(corner).collect());
            }
            _ => {}
        }
    }
    (positions, faces)
}

fn write_obj(path: &Path, positions: &[[f64; 3]], faces: &[Vec<usize>]) {
    let mut text = String::new();
    for [x, y, z] in positions {
        writeln!(text, "v {x} {y} {z}").unwrap();
    }
    for face in faces {
        text.push('f');
        for corner in face {
            write!(text, " {}", corner + 1).unwrap();
        }
        text.push('\n');
    }
    fs::write(path, text).unwrap();
}

/// The counts of features of a file.
fn features(path: &Path) -> Value {
    let output = edgemesh(&["info", path.to_str().unwrap(), "--json", "-q"]);
    json(&output)["features"].clone()
}

/// Five models, inside out and with each face twice; the features stay those of the plain ones.
#[test]
fn turned_and_doubled_models_have_the_features_of_the_plain_ones() {
    let names = ["stanford-bunny", "rocker-arm", "fandisk", "spot", "cow"];
    let Some(shared) = shared() else { return left_out("turned models", names.len()) };
    let folder = tempfile::tempdir().unwrap();
    for name in names {
        let (positions, faces) = parts_of(&shared.join(format!("models/{name}.obj")));
        let path = |kind: &str| folder.path().join(format!("{name}-{kind}.obj"));
        write_obj(&path("plain"), &positions, &faces);
        let plain = features(&path("plain"));
        let turn = |face: &Vec<usize>| {
            let mut turned = face.clone();
            turned[1..].reverse();
            turned
        };
        let turned: Vec<Vec<usize>> = faces.iter().map(turn).collect();
        write_obj(&path("turned"), &positions, &turned);
        assert_eq!(features(&path("turned")), plain, "{name} inside out");
        write_obj(&path("doubled"), &positions, &[faces.clone(), turned].concat());
        assert_eq!(features(&path("doubled")), plain, "{name} doubled");
    }
}
