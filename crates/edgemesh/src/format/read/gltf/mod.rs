//! glTF 2.0, as JSON and in its binary form.
//!
//! Based on: the glTF 2.0 specification, sections 3 (JSON) and 4 (GLB), with
//! the extensions `KHR_mesh_quantization`, `KHR_node_visibility`,
//! `EXT_mesh_gpu_instancing`, `EXT_meshopt_compression`, `KHR_meshopt_compression`,
//! `EXT_mesh_primitive_edge_visibility` and `CESIUM_primitive_outline`.
//!
//! ```text
//! bytes --glb--> JSON --document, extension--> Document --scene--> nodes in order
//!         |                                                            |
//!         '--> BIN --buffer, meshopt--> accessor --vertices, topology, deform--builder--> Model
//! ```
//!
//! The JSON is parsed into the structures of `gltf-json`; container, buffers and
//! accessors are read here. Rejected: the crate `gltf` above it, which aborts on
//! a container with a stated length of 0, follows paths out of the folder, and
//! silently yields no positions for an accessor past its buffer.
//!
//! A mesh is read once for each node that draws it, so the time is proportional to the
//! size of the model. A [`Budget`](asset::Budget) limits that size.

mod accessor;
mod asset;
mod buffer;
mod builder;
mod component;
mod deform;
mod document;
mod edge_extensions;
mod extension;
mod glb;
mod instances;
#[cfg(test)]
mod khronos_validator;
mod material;
mod meshopt;
mod primitive;
#[cfg(test)]
mod sample;
mod scene;
mod scene_size;
mod stated_edges;
mod texture;
mod topology;
mod uri;
mod vertices;

use asset::Asset;
use builder::ModelBuilder;
use document::RuleCheck;
use scene::{NodeHierarchy, is_visible};
use scene_size::check_scene_size;

use super::error::ReadError;
use super::source::Source;
use crate::model::Model;
use crate::report::Report;

/// Reads a glTF file in either form, which its first bytes distinguish; `check_rules`
/// adds warnings about its JSON.
///
/// # Errors
/// Fails with the byte, the line or the part of the JSON that has a fault.
pub(super) fn read_gltf(
    source: &Source,
    check_rules: RuleCheck,
    report: &mut Report,
) -> Result<Model, ReadError> {
    let container = glb::open(source, report)?;
    let document = document::parse(source, &container, check_rules, report)?;
    extension::check_required(source, &document)?;
    let asset = Asset::new(source, &document, container.binary);
    let hierarchy = NodeHierarchy::new(&asset)?;
    let nodes = hierarchy.drawn_nodes(&asset)?;
    check_scene_size(&asset, &nodes)?;
    let mut builder = ModelBuilder::new(&asset, &hierarchy, report)?;
    for node in nodes {
        builder.add_node(node)?;
    }
    let mut model = builder.finish();
    model.has_invisible_parts = !document.nodes.iter().all(is_visible);
    Ok(model)
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::sample::{SQUARE, Sample, one_mesh, read, read_source};
    use super::*;
    use crate::report::Warning;

    /// A quad of two triangles, with its bytes in a data URI.
    const QUAD: &str = r#"{
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "name": "plate", "translation": [0, 0, 5]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
             "min": [0, 0, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": 48},
            {"buffer": 0, "byteOffset": 48, "byteLength": 12}
        ],
        "buffers": [{"byteLength": 60, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAgD8AAAAAAAAAAAAAgD8AAAAAAAABAAIAAAACAAMA"}]
    }"#;

    #[test]
    fn a_quad_in_a_text_file() {
        let (model, report) = read(&serde_json::from_str(QUAD).unwrap()).unwrap();
        assert_eq!(report.warnings(), [] as [Warning; 0]);
        let corners = [[0., 0., 5.], [1., 0., 5.], [1., 1., 5.], [0., 1., 5.]];
        assert_eq!(model.positions, corners);
        assert_eq!(model.corner_positions, [0, 1, 2, 0, 2, 3]);
        assert!(model.is_triangles() && model.corner_normals.is_empty());
        assert_eq!(model.groups, ["plate"]);
        assert!(model.rig.is_none() && model.segments.is_empty());
    }

    #[test]
    fn the_binary_form_gives_the_same() {
        let mut json: serde_json::Value = serde_json::from_str(QUAD).unwrap();
        let (_, data) = QUAD.split_once("base64,").unwrap();
        let data = &data[..data.find('"').unwrap()];
        let binary =
            base64::Engine::decode(&base64::engine::general_purpose::STANDARD, data).unwrap();
        json["buffers"][0].as_object_mut().unwrap().remove("uri");
        let mut text = json.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let word = |number: usize| u32::try_from(number).unwrap().to_le_bytes();
        let length = word(28 + text.len() + binary.len());
        let file = [
            b"glTF\x02\0\0\0".as_slice(),
            &length,
            &word(text.len()),
            b"JSON",
            &text,
            &word(binary.len()),
            b"BIN\0",
            &binary,
        ]
        .concat();
        let source = Source { name: "test.glb", folder: None, bytes: &file };
        let (model, _) = read_source(&source).unwrap();
        assert_eq!(model.positions[2], [1.0, 1.0, 5.0]);
        assert_eq!(model.corner_positions, [0, 1, 2, 0, 2, 3]);
    }

    #[test]
    fn many_nodes_may_share_a_mesh() {
        let mut sample = Sample::default();
        let positions = sample.floats("VEC3", &SQUARE[..3]);
        let mut rest = one_mesh(&json!({"attributes": {"POSITION": positions}}));
        let nodes: Vec<_> =
            (0..10_000).map(|at| json!({"mesh": 0, "translation": [at, 0, 0]})).collect();
        rest["nodes"] = nodes.into();
        let (model, _) = sample.read(&rest).unwrap();
        assert_eq!((model.positions.len(), model.polygon_count()), (30_000, 10_000));
        assert_eq!(model.positions[29_998], [10_000.0, 0.0, 0.0]);
        assert_eq!(model.groups.len(), 10_000);
    }
}
