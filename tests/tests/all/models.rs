//! The shared models: exact counts from an independent program, and 36 views around each
//! model in 64 bits.

use std::collections::HashMap;
use std::f64::consts::TAU;
use std::fs;
use std::path::Path;

use edgemesh::build::{BuildOptions, build_edge_mesh};
use edgemesh::edge_mesh::EdgeMesh;
use edgemesh::line::LineClass;
use edgemesh::view::{Camera, count_features};
use glam::{DVec3, Vec3};
use serde_json::{Map, Value};
use testkit::locate::{left_out, shared};

use crate::child::{edgemesh, json, stderr};

/// The number of models with reference counts.
const MODELS: usize = 7;

/// Keys of the reference, and pointers into `edgemesh info --json`. A model of quads has no
/// crease counts.
const SAME: [(&str, &str); 14] = [
    ("polygons", "/source/polygons"),
    ("vertices_in_file", "/vertices"),
    ("vertices_welded", "/welded_vertices"),
    ("triangles", "/triangles"),
    ("degenerate_triangles_dropped", "/degenerate_triangles"),
    ("zero_area_triangles_kept", "/repairs/zero_area_triangles"),
    ("edges", "/edges"),
    ("boundary_edges", "/boundary_edges"),
    ("boundary_edges", "/features/boundary"),
    ("nonmanifold_edges", "/non_manifold_edges"),
    ("inconsistent_winding_edges", "/inconsistent_edges"),
    ("crease_ridge", "/features/ridge"),
    ("crease_valley", "/features/valley"),
    ("contour_edges_manifold", "/features/contour"),
];

fn reference(folder: &Path) -> Map<String, Value> {
    let text = fs::read_to_string(folder.join("reference_counts.json")).unwrap();
    let json: Value = serde_json::from_str(&text).unwrap();
    let models = json["models"].as_object().unwrap().clone();
    assert!(models.len() >= MODELS, "only {} models", models.len());
    models
}

fn vector(value: &Value) -> DVec3 {
    let number = |axis: usize| value[axis].as_f64().unwrap();
    DVec3::new(number(0), number(1), number(2))
}

/// An argument of the command line; Rust prints all significant digits.
fn argument(name: &str, point: DVec3) -> String {
    format!("--{name}={},{},{}", point.x, point.y, point.z)
}

fn info(model: &Path, camera: &[String]) -> Value {
    let mut arguments = vec!["info".to_owned(), "--json".to_owned()];
    arguments.extend_from_slice(camera);
    arguments.push(model.to_str().unwrap().to_owned());
    let output = edgemesh(&arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    json(&output)
}

#[test]
fn counts_equal_the_reference() {
    let Some(shared) = shared() else { return left_out("models with reference counts", MODELS) };
    let folder = shared.join("models");
    let mut wrong = Vec::new();
    for (name, expected) in reference(&folder) {
        let camera = [
            argument("eye", vector(&expected["eye"])),
            argument("target", vector(&expected["center"])),
        ];
        let info = info(&folder.join(format!("{name}.obj")), &camera);
        for (key, pointer) in SAME {
            let Some(count) = expected.get(key) else {
                assert!(key.starts_with("crease_"), "{name} has no {key:?}");
                continue;
            };
            if info.pointer(pointer) != Some(count) {
                wrong.push(format!("{name}{pointer}: {:?}, not {count}", info.pointer(pointer)));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_default_view_is_the_documented_one() {
    let Some(shared) = shared() else { return left_out("models in the default view", MODELS) };
    let folder = shared.join("models");
    for (name, expected) in reference(&folder) {
        let center = vector(&expected["center"]);
        let radius = expected["radius"].as_f64().unwrap();
        let eye = center + DVec3::new(1.0, 0.6, 1.2).normalize_or_zero() * (3.0 * radius);
        let path = folder.join(format!("{name}.obj"));
        let stated = info(&path, &[argument("eye", eye), argument("target", center)]);
        assert_eq!(info(&path, &[])["features"], stated["features"], "{name}");
    }
}

/// A welded triangle mesh in 64 bits, with its edges in a plain map.
struct Plain {
    /// The normal, not of unit length, and a point of each face.
    faces: Vec<(DVec3, DVec3)>,
    /// The faces of each edge with two.
    pairs: Vec<[usize; 2]>,
}

impl Plain {
    fn of(mesh: &EdgeMesh) -> Self {
        let mut users: HashMap<(u32, u32), Vec<usize>> = HashMap::new();
        let mut faces = Vec::new();
        for (face, &[a, b, c]) in mesh.triangles.iter().enumerate() {
            let [p, q, r] = [a, b, c].map(|v| Vec3::from(mesh.positions[v as usize]).as_dvec3());
            faces.push(((q - p).cross(r - p), p));
            let [a, b, c] = [a, b, c].map(|vertex| mesh.welded_vertex(vertex));
            for (v, w) in [(a, b), (b, c), (c, a)] {
                users.entry((v.min(w), v.max(w))).or_default().push(face);
            }
        }
        let pairs = users.into_values().filter_map(|faces| faces.try_into().ok()).collect();
        Self { faces, pairs }
    }

    /// The edges between a front and a back face, and those with a face so nearly edge-on
    /// that 32 bits may decide otherwise.
    fn contours(&self, eye: DVec3) -> (u32, u32) {
        let facing: Vec<(bool, bool)> = self
            .faces
            .iter()
            .map(|&(normal, point)| {
                let to_eye = eye - point;
                let sine = normal.dot(to_eye) / (normal.length() * to_eye.length());
                (sine > 0.0, sine.abs() < 1e-6)
            })
            .collect();
        let (mut contours, mut doubtful) = (0, 0);
        for &[a, b] in &self.pairs {
            contours += u32::from(facing[a].0 != facing[b].0);
            doubtful += u32::from(facing[a].1 || facing[b].1);
        }
        (contours, doubtful)
    }
}

#[test]
fn contours_are_right_all_around() {
    let Some(shared) = shared() else { return left_out("models all around", MODELS) };
    let folder = shared.join("models");
    let (mut contours_seen, mut doubtful_seen) = (0, 0);
    for (name, expected) in reference(&folder) {
        let path = folder.join(format!("{name}.obj"));
        let (model, mut report) = edgemesh::format::read::read_model(&path).unwrap();
        let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut report);
        let plain = Plain::of(&mesh);
        let target = vector(&expected["center"]);
        let start = vector(&expected["eye"]) - target;
        for step in 0..36 {
            let (sin, cos) = (f64::from(step) * TAU / 36.0).sin_cos();
            let turned =
                DVec3::new(start.x * cos + start.z * sin, start.y, start.z * cos - start.x * sin);
            let camera =
                Camera { eye: target + turned, target, ..Camera::default_view(&mesh.bounds) };
            let found =
                count_features(&mesh, camera.view(&mesh.bounds, 1.0).eye)[LineClass::Contour];
            let (contours, doubtful) = plain.contours(target + turned);
            assert!(
                found.abs_diff(contours) <= doubtful,
                "{name}, view {step}: {found} contours, {contours} in 64 bits, {doubtful} in doubt"
            );
            contours_seen += contours;
            doubtful_seen += doubtful;
        }
    }
    assert!(contours_seen > 100_000, "{contours_seen} contours");
    assert!(doubtful_seen < contours_seen / 1000, "{doubtful_seen} in doubt is no test");
}
