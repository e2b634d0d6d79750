//! glTF 2.0 with edges, as JSON or as one binary file.
//!
//! Based on: glTF 2.0, sections 3 (objects) and 4 (GLB), and
//! `EXT_mesh_primitive_edge_visibility` (see
//! [`edge_visibility`](super::edge_visibility)).
//!
//! ```text
//! node: the origin of the mesh frame, if the mesh has one
//!   '- node: the rest of the origin that 32 bits lose, and the scale
//!        '- mesh: triangles, with the extension
//!                 lines without a face, with the same vertices
//!
//! GLB:  "glTF" 2 size | size "JSON" {...} | size "BIN" data, all multiples of 4
//! ```
//!
//! The classes of hard edges, which the extension does not have, are in `extras`: runs of
//! a count and the words of [`class_names`](crate::edge_mesh::class_names), in the
//! order of the edges. The extension is used but not required: a program without it shows
//! the mesh without its edges.
//!
//! A normal of zero, of a vertex without faces or with faces that cancel out, is written
//! as +z, because glTF requires unit vectors.

use std::io::{self, Write};

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use serde::Serialize as _;
use serde_json::{Value, json};

use super::edge_visibility::{ClassRun, EdgeVisibility, LineStrings};
use super::lines::LineFormatter;
use crate::edge_mesh::{Bounds, EdgeMesh, MeshFrame, class_names};
use crate::index::NONE;

const EXTENSION: &str = "EXT_mesh_primitive_edge_visibility";

const UNSIGNED_BYTE: u32 = 5121;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const FLOAT: u32 = 5126;

const LINES: u32 = 1;
const TRIANGLES: u32 = 4;

/// Writes a mesh as JSON, with its data in a URI.
///
/// # Errors
/// Those of `out`.
pub(super) fn write_gltf(mesh: &EdgeMesh, name: &str, out: &mut impl Write) -> io::Result<()> {
    let (mut document, data) = document(mesh, name);
    if !data.is_empty() {
        let uri = format!("data:application/octet-stream;base64,{}", BASE64_STANDARD.encode(&data));
        document["buffers"] = json!([{"byteLength": data.len(), "uri": uri}]);
    }
    let mut serializer =
        serde_json::Serializer::with_formatter(&mut *out, LineFormatter::default());
    document.serialize(&mut serializer)?;
    out.write_all(b"\n")
}

/// Writes a mesh as one binary file.
///
/// # Errors
/// Those of `out`; also `FileTooLarge` from 4 GiB on.
pub(super) fn write_glb(mesh: &EdgeMesh, name: &str, out: &mut impl Write) -> io::Result<()> {
    let (mut document, data) = document(mesh, name);
    if !data.is_empty() {
        document["buffers"] = json!([{"byteLength": data.len()}]);
    }
    let mut text = serde_json::to_vec(&document)?;
    text.resize(text.len().next_multiple_of(4), b' ');
    // The length of the data is a multiple of 4 already.
    let chunks = [(b"JSON", text), (b"BIN\0", data)];
    let chunks = || chunks.iter().filter(|(_, bytes)| !bytes.is_empty());
    let size = 12 + chunks().map(|(_, bytes)| 8 + bytes.len()).sum::<usize>();
    out.write_all(b"glTF\x02\0\0\0")?;
    out.write_all(&glb_size(size)?)?;
    for (kind, bytes) in chunks() {
        out.write_all(&glb_size(bytes.len())?)?;
        out.write_all(*kind)?;
        out.write_all(bytes)?;
    }
    Ok(())
}

fn glb_size(size: usize) -> io::Result<[u8; 4]> {
    let too_large = |_| {
        let what = "larger than 4 GiB, the limit of GLB; export as .gltf";
        io::Error::new(io::ErrorKind::FileTooLarge, what)
    };
    u32::try_from(size).map(u32::to_le_bytes).map_err(too_large)
}

/// The document without its buffer, and the bytes of the buffer, which are empty if there
/// is nothing to draw.
fn document(mesh: &EdgeMesh, name: &str) -> (Value, Vec<u8>) {
    let mut data = BinaryData::default();
    let primitives = primitives(mesh, &mut data);
    let mut document = json!({
        "asset": {
            "version": "2.0",
            "generator": concat!("Edgemesh ", env!("CARGO_PKG_VERSION"))
        }
    });
    if primitives.iter().any(|primitive| primitive.get("extensions").is_some()) {
        document["extensionsUsed"] = json!([EXTENSION]);
    }
    document["scene"] = json!(0);
    document["scenes"] = json!([{"nodes": [0]}]);
    document["nodes"] = nodes(&mesh.frame, name, !primitives.is_empty());
    if !primitives.is_empty() {
        document["meshes"] = json!([{"name": name, "primitives": primitives}]);
        document["accessors"] = data.accessors.into();
        document["bufferViews"] = data.views.into();
    }
    (document, data.bytes)
}

/// The node of the mesh. A mesh with a frame has a second node within, because many
/// readers keep only 32 bits of a translation.
fn nodes(frame: &MeshFrame, name: &str, has_mesh: bool) -> Value {
    let mut inner = if has_mesh { json!({"mesh": 0}) } else { json!({}) };
    if frame.is_identity() {
        inner["name"] = name.into();
        return json!([inner]);
    }
    let rounded = frame.origin.as_vec3().as_dvec3();
    let origin = if rounded.is_finite() { rounded } else { frame.origin };
    let scale = 1.0 / frame.scale;
    inner["translation"] = json!((frame.origin - origin).to_array());
    inner["scale"] = json!([scale, scale, scale]);
    json!([{"name": name, "translation": origin.to_array(), "children": [1]}, inner])
}

/// The primitives of a mesh: its triangles and its lines without a face.
fn primitives(mesh: &EdgeMesh, data: &mut BinaryData) -> Vec<Value> {
    let loose: Vec<u32> = mesh
        .records
        .iter()
        .filter(|record| record.face_a == NONE)
        .flat_map(|record| [record.v0, record.v1])
        .collect();
    let mut primitives = Vec::new();
    if mesh.triangles.is_empty() && loose.is_empty() {
        return primitives;
    }
    let vertices = mesh.positions.len();
    let position = data.push_positions(&mesh.positions);
    if !mesh.triangles.is_empty() {
        let normals = mesh.vertex_normals.iter().map(|&normal| float_bytes(unit(normal)));
        let mut triangles = json!({
            "attributes": {
                "POSITION": position,
                "NORMAL": data.push(ElementType::VERTICES, normals)
            },
            "indices": data.push_indices(vertices, true, mesh.triangles.as_flattened()),
            "mode": TRIANGLES
        });
        let visibility = EdgeVisibility::of(mesh);
        if !visibility.is_empty() {
            let extension = extension(&visibility, vertices, data);
            triangles["extensions"] = json!({EXTENSION: extension});
        }
        primitives.push(triangles);
    }
    if !loose.is_empty() {
        primitives.push(json!({
            "attributes": {"POSITION": position},
            "indices": data.push_indices(vertices, true, &loose),
            "mode": LINES
        }));
    }
    primitives
}

/// The normal, or +z if it is zero.
fn unit(normal: [f32; 3]) -> [f32; 3] {
    if normal == [0.0; 3] { [0.0, 0.0, 1.0] } else { normal }
}

fn extension(visibility: &EdgeVisibility, vertices: usize, data: &mut BinaryData) -> Value {
    let mut extension = json!({});
    if visibility.has_values() {
        let bytes = visibility.packed().map(|byte| [byte]);
        extension["visibility"] = data.push(ElementType::BYTES, bytes).into();
    }
    if !visibility.silhouette_normals.is_empty() {
        let normals = visibility.silhouette_normals.as_flattened().iter();
        let normals = normals.map(|&normal| float_bytes(normal));
        extension["silhouetteNormals"] = data.push(ElementType::VECTORS, normals).into();
    }
    if !visibility.line_strings.is_empty() {
        let strings = visibility.line_strings.iter();
        let strings: Vec<Value> =
            strings.map(|strings| line_strings(strings, vertices, data)).collect();
        extension["lineStrings"] = strings.into();
    }
    if !visibility.hard_classes.is_empty() {
        extension["extras"] = json!({"edges": runs(&visibility.hard_classes)});
    }
    extension
}

fn line_strings(strings: &LineStrings, vertices: usize, data: &mut BinaryData) -> Value {
    json!({
        "indices": data.push_indices(vertices, false, &strings.indices),
        "extras": {
            "class": class_names(strings.class).next(),
            "edges": runs(&strings.edge_classes)
        }
    })
}

/// Each run as a list of its count and its classes.
fn runs(runs: &[ClassRun]) -> Value {
    let run = |run: &ClassRun| {
        let words = class_names(run.classes).map(Value::from);
        std::iter::once(Value::from(run.count)).chain(words).collect::<Value>()
    };
    runs.iter().map(run).collect()
}

/// The binary data, with its views and accessors.
#[derive(Default)]
struct BinaryData {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

/// The type of the elements of an accessor.
#[derive(Clone, Copy)]
struct ElementType {
    component: u32,
    shape: &'static str,
    /// The GPU binding of the view: `ARRAY_BUFFER` or `ELEMENT_ARRAY_BUFFER`.
    target: Option<u32>,
}

impl ElementType {
    const BYTES: Self = Self { component: UNSIGNED_BYTE, shape: "SCALAR", target: None };
    const VECTORS: Self = Self { component: FLOAT, shape: "VEC3", target: None };
    const VERTICES: Self = Self { component: FLOAT, shape: "VEC3", target: Some(34962) };

    const fn indices(component: u32, are_drawn: bool) -> Self {
        Self { component, shape: "SCALAR", target: if are_drawn { Some(34963) } else { None } }
    }
}

impl BinaryData {
    /// Adds elements with a view and an accessor; returns the index of the accessor.
    fn push<const N: usize>(
        &mut self,
        kind: ElementType,
        elements: impl Iterator<Item = [u8; N]>,
    ) -> usize {
        let start = self.bytes.len();
        self.bytes.extend(elements.flatten());
        let length = self.bytes.len() - start;
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let mut view = json!({"buffer": 0, "byteOffset": start, "byteLength": length});
        if let Some(target) = kind.target {
            view["target"] = target.into();
        }
        self.accessors.push(json!({
            "bufferView": self.views.len(),
            "componentType": kind.component,
            "count": length / N,
            "type": kind.shape
        }));
        self.views.push(view);
        self.accessors.len() - 1
    }

    /// Adds positions, which must have bounds.
    fn push_positions(&mut self, positions: &[[f32; 3]]) -> usize {
        let accessor = self.push(ElementType::VERTICES, positions.iter().map(|&p| float_bytes(p)));
        let Bounds { min, max } = Bounds::of(positions);
        self.accessors[accessor]["min"] = json!(min);
        self.accessors[accessor]["max"] = json!(max);
        accessor
    }

    /// Adds indices of vertices, in 16 bits if these are enough. The largest number of
    /// either size is not a vertex: it separates line strings.
    fn push_indices(&mut self, vertices: usize, are_drawn: bool, indices: &[u32]) -> usize {
        if vertices <= usize::from(u16::MAX) {
            let short = |&index: &u32| u16::try_from(index).unwrap_or(u16::MAX).to_le_bytes();
            self.push(ElementType::indices(UNSIGNED_SHORT, are_drawn), indices.iter().map(short))
        } else {
            let long = indices.iter().map(|index| index.to_le_bytes());
            self.push(ElementType::indices(UNSIGNED_INT, are_drawn), long)
        }
    }
}

fn float_bytes(vector: [f32; 3]) -> [u8; 12] {
    let [[a, b, c, d], [e, f, g, h], [i, j, k, l]] = vector.map(f32::to_le_bytes);
    [a, b, c, d, e, f, g, h, i, j, k, l]
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::build::{BuildOptions, build_edge_mesh};
    use crate::model::{Model, Segment};
    use crate::report::Report;

    fn build(model: &Model) -> EdgeMesh {
        build_edge_mesh(model, &BuildOptions::default(), &mut Report::default())
    }

    fn square() -> Model {
        let corners = [[0., 1., 0.], [0., 0., 0.], [1., 0., 0.], [1., 1., 0.]];
        Model::from_polygons(&corners, &[&[0, 1, 2, 3]])
    }

    #[test]
    fn a_square_in_full() {
        let (document, data) = document(&build(&square()), "a \"b\"");
        let expected = json!({
            "asset": {
                "version": "2.0",
                "generator": format!("Edgemesh {}", env!("CARGO_PKG_VERSION"))
            },
            "extensionsUsed": [EXTENSION],
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "meshes": [{"name": "a \"b\"", "primitives": [{
                "attributes": {"POSITION": 0, "NORMAL": 1},
                "indices": 2,
                "mode": 4,
                "extensions": {EXTENSION: {
                    "visibility": 3,
                    "extras": {"edges": [[4, "boundary"]]}
                }}
            }]}],
            "accessors": [
                {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
                 "min": [0.0, 0.0, 0.0], "max": [1.0, 1.0, 0.0]},
                {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3"},
                {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"},
                {"bufferView": 3, "componentType": 5121, "count": 2, "type": "SCALAR"}
            ],
            "bufferViews": [
                {"buffer": 0, "byteOffset": 0, "byteLength": 48, "target": 34962},
                {"buffer": 0, "byteOffset": 48, "byteLength": 48, "target": 34962},
                {"buffer": 0, "byteOffset": 96, "byteLength": 12, "target": 34963},
                {"buffer": 0, "byteOffset": 108, "byteLength": 2}
            ],
            "nodes": [{"mesh": 0, "name": "a \"b\""}]
        });
        assert_eq!(document, expected);
        assert_eq!(data[96..], [0, 0, 1, 0, 2, 0, 0, 0, 2, 0, 3, 0, 0b1010, 0b1010, 0, 0]);
    }

    #[test]
    fn a_glb_file_states_the_sizes_of_its_chunks() {
        let mut bytes = Vec::new();
        write_glb(&build(&square()), "", &mut bytes).unwrap();
        let number = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        assert_eq!((&bytes[..4], number(4), number(8)), (&b"glTF"[..], 2, bytes.len()));
        let json = number(12);
        assert_eq!((json % 4, &bytes[16..20]), (0, &b"JSON"[..]));
        assert_eq!((number(20 + json), &bytes[24 + json..28 + json]), (112, &b"BIN\0"[..]));
        assert_eq!(bytes.len(), 28 + json + 112);
        assert_eq!(glb_size(1 << 32).unwrap_err().kind(), io::ErrorKind::FileTooLarge);
    }

    #[test]
    fn an_empty_mesh_is_a_node_without_a_mesh() {
        let mesh = build(&Model::from_polygons(&[[0.; 3], [1.; 3]], &[&[0, 1, 0]]));
        let (document, data) = document(&mesh, "");
        assert_eq!(document["nodes"], json!([{"name": ""}]));
        assert!(document.get("buffers").is_none() && document.get("meshes").is_none());
        let mut bytes = Vec::new();
        write_glb(&mesh, "", &mut bytes).unwrap();
        assert!(data.is_empty() && bytes.len() == 20 + bytes[12] as usize, "one chunk");
    }

    #[test]
    fn translations_fit_into_32_bits_for_each_node() {
        let nodes =
            |x, scale| nodes(&MeshFrame { origin: DVec3::new(x, 0.5, 0.0), scale }, "far", true);
        let expected = |outer: f64, inner: f64, scale: f64| {
            json!([
                {"name": "far", "translation": [outer, 0.5, 0.0], "children": [1]},
                {"mesh": 0, "translation": [inner, 0.0, 0.0], "scale": [scale, scale, scale]}
            ])
        };
        assert_eq!(nodes(16_777_217.0, 0.5), expected(16_777_216.0, 1.0, 2.0));
        assert_eq!(nodes(1e300, 1.0), expected(1e300, 0.0, 1.0), "beyond 32 bits");
    }

    #[test]
    fn lines_alone_are_one_primitive_without_the_extension() {
        let mut model = Model::from_polygons(&[[0.; 3], [1.; 3]], &[]);
        model.segments.push(Segment { ends: [0, 1], line: 0 });
        let (document, _) = document(&build(&model), "");
        let primitives = &document["meshes"][0]["primitives"];
        let expected = json!([{"attributes": {"POSITION": 0}, "indices": 1, "mode": 1}]);
        assert_eq!(primitives, &expected);
        assert!(document.get("extensionsUsed").is_none());
    }

    #[test]
    fn indices_have_32_bits_if_16_would_reach_the_restart_value() {
        let push = |vertices| {
            let mut data = BinaryData::default();
            data.push_indices(vertices, false, &[1, u32::MAX, 2]);
            (data.accessors[0]["componentType"].clone(), data.bytes)
        };
        assert_eq!(push(65_535), (5123.into(), vec![1, 0, 255, 255, 2, 0, 0, 0]));
        assert_eq!(push(65_536), (5125.into(), vec![1, 0, 0, 0, 255, 255, 255, 255, 2, 0, 0, 0]));
    }

    #[test]
    fn normals_of_zero_become_z() {
        assert_eq!([unit([0.0, -0.0, 0.0]), unit([0.0, 1.0, 0.0])], [[0., 0., 1.], [0., 1., 0.]]);
    }
}
