//! Large meshes in several places: glTF files made here, what the commands say of them, and that
//! too many of them are refused at once.

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::child::{edgemesh, json, stderr};

/// A place of the mesh: translation, rotation and scale.
pub(crate) type Place = ([f32; 3], [f32; 4], [f32; 3]);

/// A bumpy ball of 4,560 triangles, more than are copied, of which one half is red: its positions,
/// and the triangles of each half.
fn ball() -> (Vec<[f32; 3]>, [Vec<u32>; 2]) {
    const RINGS: u16 = 39;
    const SIDES: u16 = 60;
    let mut positions = vec![[0.0, 1.1, 0.0], [0.0, -1.1, 0.0]];
    for ring in 1..RINGS {
        let (sin, cos) = (f32::from(ring) / f32::from(RINGS) * std::f32::consts::PI).sin_cos();
        for side in 0..SIDES {
            let turn = f32::from(side) / f32::from(SIDES) * std::f32::consts::TAU;
            // Bumps, and none at the poles.
            let radius = 1.0 + 0.12 * (3.0 * turn).sin() * sin.powi(3) + 0.1 * cos * cos;
            let [x, z] = [turn.cos(), turn.sin()].map(|x| radius * sin * x);
            positions.push([x, radius * cos, z]);
        }
    }
    let at = |ring: u16, side: u16| 2 + u32::from(SIDES * (ring - 1) + side % SIDES);
    let mut halves = [Vec::new(), Vec::new()];
    for side in 0..SIDES {
        let half = &mut halves[usize::from(side < SIDES / 2)];
        half.extend([0, at(1, side + 1), at(1, side)]);
        half.extend([1, at(RINGS - 1, side), at(RINGS - 1, side + 1)]);
        for ring in 1..RINGS - 1 {
            let [a, b] = [at(ring, side), at(ring, side + 1)];
            let [c, d] = [at(ring + 1, side), at(ring + 1, side + 1)];
            half.extend([a, b, d, a, d, c]);
        }
    }
    (positions, halves)
}

/// The binary data of a file, with its views and accessors.
#[derive(Default)]
struct Content {
    data: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Content {
    /// Adds an accessor; returns its number.
    fn push(&mut self, bytes: &[u8], accessor: Value) -> usize {
        let view = json!({"buffer": 0, "byteOffset": self.data.len(), "byteLength": bytes.len()});
        self.views.push(view);
        self.data.extend(bytes);
        let mut accessor = accessor;
        accessor["bufferView"] = (self.views.len() - 1).into();
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    fn floats(&mut self, numbers: &[f32], accessor: Value) -> usize {
        let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
        self.push(&bytes, accessor)
    }

    /// Adds the ball; returns the primitives of its halves.
    fn ball(&mut self) -> Vec<Value> {
        let (positions, halves) = ball();
        let column = |pick: fn(f32, f32) -> f32| -> Vec<f32> {
            let of = |axis: usize| positions.iter().map(move |at: &[f32; 3]| at[axis]);
            (0..3).map(|axis| of(axis).reduce(pick).unwrap()).collect()
        };
        let position = self.floats(
            positions.as_flattened(),
            json!({"componentType": 5126, "count": positions.len(), "type": "VEC3",
                   "min": column(f32::min), "max": column(f32::max)}),
        );
        let primitive = |(material, half): (usize, &Vec<u32>)| {
            let bytes: Vec<u8> = half.iter().flat_map(|corner| corner.to_le_bytes()).collect();
            let accessor = json!({"componentType": 5125, "count": half.len(), "type": "SCALAR"});
            let indices = self.push(&bytes, accessor);
            json!({"attributes": {"POSITION": position}, "indices": indices, "material": material})
        };
        halves.iter().enumerate().map(primitive).collect()
    }

    /// Adds the places as attributes of instances.
    fn instances(&mut self, places: &[Place]) -> Value {
        let mut list = |numbers: Vec<f32>, kind: &str| {
            let accessor = json!({"componentType": 5126, "count": places.len(), "type": kind});
            self.floats(&numbers, accessor)
        };
        json!({
            "TRANSLATION": list(places.iter().flat_map(|place| place.0).collect(), "VEC3"),
            "ROTATION": list(places.iter().flat_map(|place| place.1).collect(), "VEC4"),
            "SCALE": list(places.iter().flat_map(|place| place.2).collect(), "VEC3")
        })
    }
}

/// A GLB file with the ball in each place: as instances of one node, or with a mesh for each place,
/// which are copied.
pub(crate) fn balls(places: &[Place], are_shared: bool) -> Vec<u8> {
    let mut content = Content::default();
    let mesh = json!({"primitives": content.ball()});
    let (meshes, nodes): (Vec<Value>, Vec<Value>) = if are_shared {
        let attributes = content.instances(places);
        let extensions = json!({"EXT_mesh_gpu_instancing": {"attributes": attributes}});
        (vec![mesh], vec![json!({"mesh": 0, "name": "ball", "extensions": extensions})])
    } else {
        let node = |(at, (translation, rotation, scale)): (usize, &Place)| {
            json!({"mesh": at, "name": "ball", "translation": translation,
                   "rotation": rotation, "scale": scale})
        };
        (vec![mesh; places.len()], places.iter().enumerate().map(node).collect())
    };
    let color = |color: [f32; 4]| json!({"pbrMetallicRoughness": {"baseColorFactor": color}});
    let mut document = json!({
        "asset": {"version": "2.0"}, "scenes": [{"nodes": (0..nodes.len()).collect::<Vec<_>>()}],
        "nodes": nodes, "meshes": meshes,
        "materials": [color([0.2, 0.4, 0.8, 1.0]), color([0.8, 0.1, 0.1, 1.0])],
        "accessors": content.accessors, "bufferViews": content.views,
        "buffers": [{"byteLength": content.data.len()}]
    });
    if are_shared {
        document["extensionsUsed"] = json!(["EXT_mesh_gpu_instancing"]);
    }
    glb(&document, &content.data)
}

/// A binary glTF file; the length of `data` is a multiple of 4.
fn glb(document: &Value, data: &[u8]) -> Vec<u8> {
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let word = |number: usize| u32::try_from(number).unwrap().to_le_bytes();
    let size = word(28 + text.len() + data.len());
    let parts: [&[u8]; 8] = [
        b"glTF\x02\0\0\0",
        &size,
        &word(text.len()),
        b"JSON",
        &text,
        &word(data.len()),
        b"BIN\0",
        data,
    ];
    parts.concat()
}

/// Places that are turned, mirrored and smaller, and one that is stretched, which is copied.
pub(crate) fn places() -> Vec<Place> {
    let none = [0.0, 0.0, 0.0, 1.0];
    let turn = [0.36, 0.0, 0.48, 0.8];
    vec![
        ([0.0; 3], none, [1.0; 3]),
        ([3.0, 0.0, 0.0], turn, [1.0; 3]),
        ([0.0, 3.0, 0.0], turn, [-1.0, 1.0, 1.0]),
        ([3.0, 3.0, -1.0], none, [0.5; 3]),
        ([6.0, 1.5, 0.0], none, [0.7, 1.4, 0.7]),
    ]
}

fn info(path: &Path) -> Value {
    let output = edgemesh(&["info".as_ref(), "--json".as_ref(), path.as_os_str()]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let mut info = json(&output);
    info["file"] = Value::Null;
    info
}

fn command(arguments: &[&str], from: &Path, to: &Path) {
    let mut all: Vec<&std::ffi::OsStr> =
        arguments.iter().map(std::convert::AsRef::as_ref).collect();
    all.extend([from.as_os_str(), "-o".as_ref(), to.as_os_str()]);
    let output = edgemesh(&all);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

/// The numbers that do not depend on the bytes of a mesh or on its groups.
fn counts(info: &Value) -> Value {
    let keys = [
        "triangles",
        "welded_vertices",
        "edges",
        "boundary_edges",
        "components",
        "records",
        "chains",
        "features",
    ];
    keys.iter()
        .map(|key| ((*key).to_owned(), info[*key].clone()))
        .collect::<serde_json::Map<_, _>>()
        .into()
}

fn assert_near(found: &Value, expected: &Value) {
    for side in ["min", "max"] {
        for axis in 0..3 {
            let of = |info: &Value| info["bounds"][side][axis].as_f64().unwrap();
            assert!((of(found) - of(expected)).abs() < 1e-5, "{found} {expected}");
        }
    }
}

/// Files with instances, and files that were made of them, say what the file with copies says.
#[test]
fn counts_are_those_of_the_scene_as_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    fs::write(file("copies.glb"), balls(&places(), false)).unwrap();
    fs::write(file("shared.glb"), balls(&places(), true)).unwrap();
    let (copies, shared) = (info(&file("copies.glb")), info(&file("shared.glb")));
    assert_eq!((&copies["triangles"], &copies["components"]), (&json!(22800), &json!(5)));
    assert_eq!(copies["features"]["material"], json!(5 * 78));
    assert_eq!(counts(&shared), counts(&copies));
    assert_near(&shared, &copies);
    // The mesh, and the stretched copy.
    let bytes = |info: &Value| info["bytes"]["indexed"].as_u64().unwrap();
    assert_eq!(5 * bytes(&shared), 2 * bytes(&copies));
    command(&["build"], &file("shared.glb"), &file("built.edgemesh"));
    assert_eq!(info(&file("built.edgemesh")), shared);
    for name in ["export.glb", "export.gltf", "export.obj", "export.ply"] {
        command(&["export"], &file("built.edgemesh"), &file(name));
        let again = info(&file(name));
        let facts =
            |info: &Value| ["triangles", "edges", "components"].map(|key| info[key].clone());
        assert_eq!(facts(&again), facts(&copies), "{name}");
        assert_eq!(again["features"], copies["features"], "{name}");
        assert_near(&again, &copies);
    }
    command(&["export"], &file("shared.glb"), &file("all.json"));
    let all: Value = serde_json::from_slice(&fs::read(file("all.json")).unwrap()).unwrap();
    assert_eq!(all["triangles"].as_array().unwrap().len(), 22800);
    assert_eq!(all["counts"]["components"], json!(5));
    let size = |name: &str| fs::metadata(file(name)).unwrap().len();
    command(&["export"], &file("copies.glb"), &file("large.glb"));
    assert!(2 * size("export.glb") < size("large.glb"), "{}", size("export.glb"));
    let output = edgemesh(&["validate".as_ref(), file("built.edgemesh").as_os_str()]);
    assert!(String::from_utf8_lossy(&output.stdout).ends_with(": sound\n"), "{output:?}");
}

/// Ten thousand places of a large mesh are drawn as objects, more are too many.
#[test]
fn a_million_places_are_refused_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("many.glb");
    let place = ([0.0; 3], [0.0, 0.0, 0.0, 1.0], [1.0; 3]);
    fs::write(&path, balls(&vec![place; 1_000_000], true)).unwrap();
    let start = Instant::now();
    let output = edgemesh(&["info".as_ref(), path.as_os_str()]);
    assert!(start.elapsed() < Duration::from_secs(5), "{:?}", start.elapsed());
    assert_eq!(output.status.code(), Some(1));
    let message = stderr(&output);
    assert!(message.contains("too large: 1000000 nodes and instances draw"), "{message}");
}
