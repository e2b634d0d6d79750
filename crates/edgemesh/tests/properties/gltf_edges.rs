//! A small reader of glTF with `EXT_mesh_primitive_edge_visibility`, written from the two
//! specifications alone, not from the writer.
//!
//! It asserts each rule of the extension, so that a file that breaks one fails in every test.

#![expect(clippy::missing_assert_message, reason = "each is a rule of the specifications")]

use std::collections::{BTreeMap, BTreeSet};

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use serde_json::Value;

const EXTENSION: &str = "EXT_mesh_primitive_edge_visibility";

/// An undirected edge by the positions of its ends, as bits, the smaller first.
pub(crate) type Edge = [[u32; 3]; 2];

pub(crate) fn edge(ends: [[f32; 3]; 2]) -> Edge {
    let [a, b] = ends.map(|end| end.map(crate::meshes::key));
    [a.min(b), a.max(b)]
}

/// The mesh of a file.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct DecodedFile {
    pub(crate) name: String,
    /// In units of their node.
    pub(crate) positions: Vec<[f32; 3]>,
    pub(crate) normals: Vec<[f32; 3]>,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// Lines that are not edges of a triangle.
    pub(crate) lines: BTreeSet<Edge>,
    /// Hard edges with the words that `extras` have for them.
    pub(crate) hard: BTreeMap<Edge, Vec<String>>,
    /// Hard edges in line strings.
    pub(crate) in_strings: BTreeSet<Edge>,
    /// Silhouette edges with two normals: of the triangle that lists the edge,
    /// and of the one across.
    pub(crate) silhouettes: BTreeMap<Edge, [[f32; 3]; 2]>,
    pub(crate) translation: [f64; 3],
    pub(crate) scale: [f64; 3],
}

/// A document with the bytes of its only buffer.
struct File {
    json: Value,
    data: Vec<u8>,
}

/// Reads JSON with its data inside, or a binary file.
pub(crate) fn decode(bytes: &[u8]) -> DecodedFile {
    let file = if bytes.starts_with(b"glTF") { open_glb(bytes) } else { open_gltf(bytes) };
    assert_eq!(file.json["asset"]["version"], "2.0");
    assert!(file.json["asset"]["generator"].as_str().unwrap().starts_with("Edgemesh "));
    assert_eq!(file.json["scenes"], serde_json::json!([{"nodes": [0]}]));
    assert!(file.json.get("extensionsRequired").is_none());
    let root = &file.json["nodes"][0];
    let node = root.get("children").map_or(root, |children| {
        assert_eq!(children, &serde_json::json!([1]));
        &file.json["nodes"][1]
    });
    let mut decoded = DecodedFile {
        name: root["name"].as_str().unwrap().into(),
        translation: vector(root, "translation", 0.0),
        scale: vector(node, "scale", 1.0),
        ..DecodedFile::default()
    };
    if !std::ptr::eq(root, node) {
        let within = vector(node, "translation", 0.0);
        decoded.translation = [0, 1, 2].map(|axis| decoded.translation[axis] + within[axis]);
        assert!(root.get("scale").is_none());
    }
    if let Some(mesh) = node.get("mesh") {
        assert_eq!((mesh.as_u64(), file.json["meshes"].as_array().unwrap().len()), (Some(0), 1));
        for primitive in file.json["meshes"][0]["primitives"].as_array().unwrap() {
            file.read_primitive(primitive, &mut decoded);
        }
    }
    let is_used = file.json["meshes"].to_string().contains(EXTENSION);
    assert_eq!(file.json.get("extensionsUsed").is_some(), is_used);
    decoded
}

fn vector(node: &Value, key: &str, missing: f64) -> [f64; 3] {
    let axes = |value: &Value| [0, 1, 2].map(|axis| value[axis].as_f64().unwrap());
    node.get(key).map_or([missing; 3], axes)
}

fn open_gltf(bytes: &[u8]) -> File {
    let json: Value = serde_json::from_slice(bytes).unwrap();
    let data = json.get("buffers").map_or(Vec::new(), |buffers| {
        let uri = buffers[0]["uri"].as_str().unwrap();
        let text = uri.strip_prefix("data:application/octet-stream;base64,").unwrap();
        BASE64_STANDARD.decode(text).unwrap()
    });
    File { json, data }.checked()
}

fn open_glb(bytes: &[u8]) -> File {
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!((word(4), word(8), bytes.len() % 4), (2, bytes.len(), 0));
    let mut chunks = Vec::new();
    let mut at = 12;
    while at < bytes.len() {
        chunks.push((&bytes[at + 4..at + 8], &bytes[at + 8..at + 8 + word(at)]));
        at += 8 + word(at);
    }
    assert_eq!((at, chunks[0].0), (bytes.len(), &b"JSON"[..]));
    assert!(chunks[1..].iter().all(|chunk| chunk.0 == b"BIN\0") && chunks.len() <= 2);
    let data = chunks.get(1).map_or(Vec::new(), |chunk| chunk.1.to_vec());
    File { json: serde_json::from_slice(chunks[0].1).unwrap(), data }.checked()
}

impl File {
    fn checked(self) -> Self {
        let length = self.json.get("buffers").map(|buffers| buffers[0]["byteLength"].clone());
        assert_eq!(length, (!self.data.is_empty()).then(|| self.data.len().into()));
        self
    }

    /// The elements of an accessor, each as its `N` components.
    fn read<const N: usize>(&self, accessor: &Value, shape: &str) -> (u64, Vec<[u32; N]>) {
        let accessor = &self.json["accessors"][number(accessor)];
        assert_eq!(accessor["type"], shape);
        let view = &self.json["bufferViews"][number(&accessor["bufferView"])];
        let component = accessor["componentType"].as_u64().unwrap();
        let width = match component {
            5121 => 1,
            5123 => 2,
            5125 | 5126 => 4,
            _ => panic!("component type {component}"),
        };
        let start = number(&view["byteOffset"]);
        assert_eq!(start % width, 0);
        let bytes = &self.data[start..start + number(&view["byteLength"])];
        assert_eq!(bytes.len(), number(&accessor["count"]) * width * N);
        let value = |bytes: &[u8]| {
            bytes.iter().rev().fold(0, |value: u32, &byte| value << 8 | u32::from(byte))
        };
        let values: Vec<u32> = bytes.chunks(width).map(value).collect();
        (component, values.as_chunks::<N>().0.to_vec())
    }

    fn vectors(&self, accessor: &Value) -> Vec<[f32; 3]> {
        let (component, vectors) = self.read::<3>(accessor, "VEC3");
        assert_eq!(component, 5126);
        vectors.into_iter().map(|vector| vector.map(f32::from_bits)).collect()
    }

    fn read_primitive(&self, primitive: &Value, decoded: &mut DecodedFile) {
        let position = &primitive["attributes"]["POSITION"];
        decoded.positions = self.vectors(position);
        self.check_box(position, &decoded.positions);
        let (_, indices) = self.read::<1>(&primitive["indices"], "SCALAR");
        let indices = indices.into_flattened();
        assert!(indices.iter().all(|&index| (index as usize) < decoded.positions.len()));
        if primitive["mode"] == 1 {
            assert!(primitive.get("extensions").is_none());
            for &ends in indices.as_chunks::<2>().0 {
                assert!(decoded.lines.insert(decoded.edge(ends)), "a line twice");
            }
            return;
        }
        assert_eq!(primitive["mode"], 4);
        decoded.normals = self.vectors(&primitive["attributes"]["NORMAL"]);
        decoded.triangles = indices.as_chunks::<3>().0.to_vec();
        if let Some(extension) = primitive["extensions"].get(EXTENSION) {
            self.read_edges(extension, decoded);
        }
    }

    /// The box is in the same 32 bits as the positions.
    #[expect(clippy::cast_possible_truncation, reason = "that is what is asked for")]
    fn check_box(&self, accessor: &Value, positions: &[[f32; 3]]) {
        let accessor = &self.json["accessors"][number(accessor)];
        let corner = |key: &str, axis: usize| accessor[key][axis].as_f64().unwrap() as f32;
        for axis in 0..3 {
            let coordinates = || positions.iter().map(|position| position[axis]);
            assert_eq!(Some(corner("min", axis)), coordinates().reduce(f32::min));
            assert_eq!(Some(corner("max", axis)), coordinates().reduce(f32::max));
        }
    }

    fn read_edges(&self, extension: &Value, decoded: &mut DecodedFile) {
        assert!(extension.get("visibility").or(extension.get("lineStrings")).is_some());
        for strings in extension.get("lineStrings").and_then(Value::as_array).into_iter().flatten()
        {
            self.read_strings(strings, decoded);
        }
        let sides = decoded.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let sides: Vec<Edge> = sides.map(|side| decoded.edge(side)).collect();
        for edge in decoded.hard.keys() {
            assert!(sides.contains(edge), "a line string leaves the triangles");
        }
        let Some(visibility) = extension.get("visibility") else { return };
        let values = self.values(visibility, sides.len());
        assert!(values.iter().any(|&value| value != 0));
        let normals = extension.get("silhouetteNormals").map(|normals| self.vectors(normals));
        let mut normals = normals.unwrap_or_default().into_iter();
        let mut classes = words(&extension["extras"]).into_iter();
        for value in 1..=3 {
            for (&edge, _) in sides.iter().zip(&values).filter(|(_, own)| **own == value) {
                match value {
                    1 => {
                        let pair = [normals.next().unwrap(), normals.next().unwrap()];
                        let twice = decoded.silhouettes.insert(edge, pair).is_some();
                        assert!(!twice && !decoded.hard.contains_key(&edge));
                    }
                    2 => {
                        let twice = decoded.hard.insert(edge, classes.next().unwrap()).is_some();
                        assert!(!twice && !decoded.silhouettes.contains_key(&edge));
                    }
                    _ => assert!(decoded.hard.contains_key(&edge)),
                }
            }
        }
        assert!(normals.next().is_none() && classes.next().is_none());
        for (edge, value) in sides.iter().zip(values) {
            let is_in_values =
                decoded.hard.contains_key(edge) && !decoded.in_strings.contains(edge);
            assert_eq!(value >= 2, is_in_values, "2 once, then 3; 0 where a string has it");
        }
    }

    /// The value of each of `count` edges.
    fn values(&self, accessor: &Value, count: usize) -> Vec<u32> {
        let (component, bytes) = self.read::<1>(accessor, "SCALAR");
        assert_eq!((component, bytes.len()), (5121, (2 * count).div_ceil(8)));
        let value = |edge: usize| bytes[edge / 4][0] >> (2 * (edge % 4)) & 3;
        assert!((count..4 * bytes.len()).all(|spare| value(spare) == 0));
        (0..count).map(value).collect()
    }

    fn read_strings(&self, strings: &Value, decoded: &mut DecodedFile) {
        let (component, indices) = self.read::<1>(&strings["indices"], "SCALAR");
        let restart = if component == 5123 { 0xffff } else { 0xffff_ffff };
        let mut classes = words(&strings["extras"]).into_iter();
        for string in indices.as_flattened().split(|&index| index == restart) {
            assert!(string.len() > 2, "a line string of {} vertices", string.len());
            for ends in string.windows(2) {
                let edge = decoded.edge([ends[0], ends[1]]);
                let words = classes.next().unwrap();
                assert!(words.contains(&strings["extras"]["class"].as_str().unwrap().to_owned()));
                assert!(decoded.hard.insert(edge, words).is_none(), "an edge in two strings");
                decoded.in_strings.insert(edge);
            }
        }
        assert!(classes.next().is_none());
    }
}

impl DecodedFile {
    fn edge(&self, ends: [u32; 2]) -> Edge {
        edge(ends.map(|end| self.positions[end as usize]))
    }

    /// Positions as the node places them.
    pub(crate) fn placed(&self) -> impl Iterator<Item = [f64; 3]> {
        let place = |axis: usize, x: f32| f64::from(x) * self.scale[axis] + self.translation[axis];
        self.positions.iter().map(move |p| [0, 1, 2].map(|axis| place(axis, p[axis])))
    }
}

/// The words of each edge, from runs of a count and words.
fn words(extras: &Value) -> Vec<Vec<String>> {
    let mut words = Vec::new();
    for run in extras["edges"].as_array().into_iter().flatten() {
        let [count, names @ ..] = &run.as_array().unwrap()[..] else { panic!("an empty run") };
        let names: Vec<String> = names.iter().map(|name| name.as_str().unwrap().into()).collect();
        words.extend(vec![names; number(count)]);
    }
    words
}

fn number(value: &Value) -> usize {
    usize::try_from(value.as_u64().unwrap()).unwrap()
}
