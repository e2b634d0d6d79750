//! glTF 2.0 with edges, as JSON or as one binary file.
//!
//! Based on: glTF 2.0, sections 3 (objects) and 4 (GLB), and
//! `EXT_mesh_primitive_edge_visibility` (see
//! [`edge_visibility`]).
//!
//! ```text
//! node: the origin of the mesh frame, if the mesh has one
//!   '- node: the rest of the origin that 32 bits lose, and the scale
//!        '- mesh: triangles of each material, with the extension
//!                 lines without a face; all with the same vertices
//! with a rig: its own nodes, a mesh for each part ([`rig`])
//! with instances: a node for each place ([`instances`])
//!
//! GLB:  "glTF" 2 size | size "JSON" {...} | size "BIN" data, all multiples of 4
//! ```
//!
//! The classes of hard edges, which the extension does not have, are in `extras`: runs of
//! a count and the words of [`class_names`](crate::edge_mesh::class_names), in the
//! order of the edges; those of silhouettes say which are diagonals of polygons. The reader of
//! this project takes them if the asset says so. The extension is used but not required: a
//! program without it shows the mesh without its edges.
//!
//! A normal of zero, of a vertex without faces or with faces that cancel out, is written
//! as +z, because glTF requires unit vectors.

mod binary_data;
mod edge_visibility;
mod edges;
mod faces;
mod instances;
mod materials;
mod objects;
mod primitives;
mod rig;
mod surface;

use std::borrow::Cow;
use std::io::{self, Write};

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use serde::Serialize as _;
use serde_json::{Value, json};

use self::binary_data::BinaryData;
use self::edge_visibility::EXTENSION;
use self::materials::MaterialLists;
use self::objects::Objects;
use super::lines::LineFormatter;
use super::parts::Parts;
use crate::edge_mesh::EdgeMesh;
use crate::format::edge_classes::{GENERATOR, STATES_CLASSES};
use crate::index::NONE;
use crate::model::{Material, MeshRig};

/// Writes a mesh as JSON, with its data in a URI.
///
/// # Errors
/// Those of `out`.
pub(super) fn write_gltf(
    mesh: &EdgeMesh,
    parts: Parts,
    name: &str,
    out: &mut impl Write,
) -> io::Result<()> {
    let (mut document, data) = document(mesh, parts, name)?;
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
pub(super) fn write_glb(
    mesh: &EdgeMesh,
    parts: Parts,
    name: &str,
    out: &mut impl Write,
) -> io::Result<()> {
    let (mut document, data) = document(mesh, parts, name)?;
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
///
/// # Errors
/// Those of [`MaterialLists::new`].
fn document(mesh: &EdgeMesh, parts: Parts, name: &str) -> io::Result<(Value, Vec<u8>)> {
    let Parts { rig, instanced } = parts;
    let mut data = BinaryData::default();
    let mut document = json!({
        "asset": {
            "version": "2.0",
            "generator": format!("{GENERATOR}{}", env!("CARGO_PKG_VERSION")),
            "extras": {"edges": STATES_CLASSES}
        }
    });
    let is_of_mesh =
        |own: &&MeshRig| own.corners.len() == mesh.triangles.len() && !own.rig.parts.is_empty();
    let mut objects = match rig.filter(is_of_mesh) {
        Some(rig) => Objects::of_rig(mesh, rig, name, &mut data),
        None => Objects::of_mesh(mesh, name, &mut data),
    };
    let mut materials = Cow::Borrowed(&mesh.fill.materials);
    for own in instanced {
        objects.add_instanced(own, name, materials.len(), &mut data);
        materials.to_mut().extend(own.mesh.fill.materials.iter().cloned());
    }
    if objects.uses_extension() {
        document["extensionsUsed"] = json!([EXTENSION]);
    }
    document["scene"] = json!(0);
    document["scenes"] = json!([{"nodes": objects.roots}]);
    document["nodes"] = objects.nodes.into();
    if !objects.meshes.is_empty() {
        document["meshes"] = objects.meshes.into();
        if !objects.skins.is_empty() {
            document["skins"] = objects.skins.into();
        }
        let fills = std::iter::once(&mesh.fill).chain(instanced.iter().map(|own| &own.mesh.fill));
        if fills.flat_map(|fill| &fill.runs).any(|run| run.material != NONE) {
            add_materials(&mut document, &materials, &mut data)?;
        }
        document["accessors"] = data.accessors.into();
        document["bufferViews"] = data.views.into();
    }
    Ok((document, data.bytes))
}

fn add_materials(
    document: &mut Value,
    materials: &[Material],
    data: &mut BinaryData,
) -> io::Result<()> {
    let MaterialLists { materials, textures, images } = MaterialLists::new(materials, data)?;
    document["materials"] = materials.into();
    if !images.is_empty() {
        document["textures"] = textures.into();
        document["images"] = images.into();
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::{BuildOptions, build_edge_mesh};
    use crate::model::{Model, Segment};
    use crate::report::Report;

    fn build(model: &Model) -> EdgeMesh {
        let options = BuildOptions { with_fill: false, ..BuildOptions::default() };
        build_edge_mesh(model, &options, &mut Report::default())
    }

    fn square() -> Model {
        let corners = [[0., 1., 0.], [0., 0., 0.], [1., 0., 0.], [1., 1., 0.]];
        Model::from_polygons(&corners, &[&[0, 1, 2, 3]])
    }

    #[test]
    fn a_square_in_full() {
        let (document, data) = document(&build(&square()), Parts::default(), "a \"b\"").unwrap();
        let expected = json!({
            "asset": {
                "version": "2.0",
                "generator": format!("Edgemesh {}", env!("CARGO_PKG_VERSION")),
                "extras": {"edges": "Edgemesh edge classes 1"}
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
        write_glb(&build(&square()), Parts::default(), "", &mut bytes).unwrap();
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
        let (document, data) = document(&mesh, Parts::default(), "").unwrap();
        assert_eq!(document["nodes"], json!([{"name": ""}]));
        assert!(document.get("buffers").is_none() && document.get("meshes").is_none());
        let mut bytes = Vec::new();
        write_glb(&mesh, Parts::default(), "", &mut bytes).unwrap();
        assert!(data.is_empty() && bytes.len() == 20 + bytes[12] as usize, "one chunk");
    }

    #[test]
    fn lines_alone_are_one_primitive_without_the_extension() {
        let mut model = Model::from_polygons(&[[0.; 3], [1.; 3]], &[]);
        model.segments.push(Segment { ends: [0, 1], line: 0 });
        let (document, _) = document(&build(&model), Parts::default(), "").unwrap();
        let primitives = &document["meshes"][0]["primitives"];
        let expected = json!([{"attributes": {"POSITION": 0}, "indices": 1, "mode": 1}]);
        assert_eq!(primitives, &expected);
        assert!(document.get("extensionsUsed").is_none());
    }
}
