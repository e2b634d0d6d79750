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
//! size of the model. A [`Budget`](asset::Budget) limits that size. A large mesh in several
//! places is read once and becomes a model of its own ([`placements`]).

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
mod placements;
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
use scene_size::SceneSize;

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
    let size = SceneSize::of(&asset, &nodes)?;
    let mut builder = ModelBuilder::new(&asset, &hierarchy, size, report)?;
    for node in nodes {
        builder.add_node(node)?;
    }
    let instanced = builder.add_shared()?;
    let mut model = builder.finish();
    model.instanced = instanced;
    model.has_invisible_parts = !document.nodes.iter().all(is_visible);
    Ok(model)
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::sample::{SQUARE, Sample, TWO_TRIANGLES, one_mesh, read, read_source};
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

    /// A square of 4,000 triangles: moved by a node, mirrored by an instance, stretched by another.
    #[test]
    fn a_large_mesh_in_several_places_is_read_once() {
        let mut sample = Sample::default();
        let places = sample.floats("VEC3", &[[0.0; 3], [0.0, 5.0, 0.0]]);
        let scales = sample.floats("VEC3", &[[-2.0, 2.0, 2.0], [1.0, 3.0, 1.0]]);
        let mut rest = one_mesh(&json!({
            "attributes": {"POSITION": sample.floats("VEC3", &SQUARE)},
            "indices": sample.bytes("SCALAR", &TWO_TRIANGLES.repeat(2000))
        }));
        let attributes = json!({"TRANSLATION": places, "SCALE": scales});
        rest["extensionsUsed"] = json!(["EXT_mesh_gpu_instancing"]);
        rest["nodes"] = json!([
            {"mesh": 0, "name": "first", "translation": [1, 0, 0]},
            {"mesh": 0, "translation": [10, 0, 0]},
            {"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": attributes}}}
        ]);
        let (model, report) = sample.read(&rest).unwrap();
        assert!(report.warnings().is_empty(), "{report:?}");
        let [instanced] = &model.instanced[..] else { panic!("{:?}", model.instanced) };
        assert_eq!(instanced.model.positions[2], [2.0, 1.0, 0.0], "in its first place");
        assert_eq!((instanced.model.polygon_count(), &*instanced.model.groups[0]), (4000, "first"));
        // (2, 1, 0) is the corner (1, 1, 0).
        let corner = glam::DVec3::new(2.0, 1.0, 0.0);
        let corners: Vec<[f64; 3]> = instanced
            .placements
            .iter()
            .map(|place| place.transform_point3(corner).to_array())
            .collect();
        assert_eq!(corners, [[2., 1., 0.], [11., 1., 0.], [-2., 2., 0.]]);
        assert_eq!((model.positions.len(), model.polygon_count()), (4, 4000), "stretched: a copy");
        assert_eq!(model.positions[2], [1.0, 8.0, 0.0]);
        rest["nodes"] = json!([{"mesh": 0}, {"mesh": 0, "scale": [0, 1, 1]}]);
        let (model, _) = sample.read(&rest).unwrap();
        assert_eq!((model.instanced.len(), model.polygon_count()), (0, 8000), "flattened: copies");
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
