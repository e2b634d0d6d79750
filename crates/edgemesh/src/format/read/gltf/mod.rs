//! Reads glTF 2.0, as text and in its binary form.
//!
//! Based on: the glTF 2.0 specification, sections 3 (JSON) and 4 (GLB), with
//! the extensions `KHR_mesh_quantization`, `KHR_node_visibility`,
//! `EXT_mesh_primitive_edge_visibility` and `CESIUM_primitive_outline`.
//!
//! ```text
//! bytes --glb--> JSON --document, extension--> Document --scene--> nodes in order
//!         |              '--lint--> warnings                          |
//!         '--> BIN --buffer--> accessor --vertices, topology, deform--'--> Model
//! ```
//!
//! The JSON goes into the structures of `gltf-json`; container, buffers and
//! accessors are read here. Rejected: the crate `gltf` above it, which aborts on
//! a container of stated length 0, follows paths out of the folder, and yields
//! no positions at all, silently, for an accessor past its buffer.
//!
//! A scene says where each node is drawn, so a mesh is read anew for each node:
//! the time is that of the model that comes out, and a [`Budget`] bounds it.

mod accessor;
mod buffer;
mod builder;
mod deform;
mod document;
mod edge_extensions;
mod extension;
mod glb;
mod lint;
mod material;
#[cfg(test)]
mod sample;
mod scene;
mod texture;
mod topology;
mod vertices;

use std::cell::Cell;

use buffer::Buffers;
use builder::ModelBuilder;
use document::Document;
use scene::{Graph, is_visible};

use super::error::{ReadError, ReadErrorKind};
use super::source::Source;
use crate::index::MAX_INDEX;
use crate::model::Model;
use crate::report::{Place, Report, WarningCode};

/// How many elements accessors and instances may give beyond one for each byte
/// that is read: some 3 GiB of positions, more than any scene that is drawn at
/// once. Only a file that uses its data over and over gets there.
const SHARED_ELEMENTS: usize = 1 << 27;

/// Reads a glTF file of either form, told apart by its first bytes.
///
/// # Errors
/// [`ReadError`], with the byte, the line or the part of the JSON.
pub(super) fn read_gltf(source: &Source, report: &mut Report) -> Result<Model, ReadError> {
    let container = glb::open(source, report)?;
    let document = document::parse(source, &container, report)?;
    extension::check_required(source, &document)?;
    let asset = Asset::new(source, &document, container.binary);
    let graph = Graph::new(&asset)?;
    let mut builder = ModelBuilder::new(&asset, &graph, report)?;
    for node in graph.drawn_nodes(&asset)? {
        builder.add_node(node)?;
    }
    let mut model = builder.finish();
    model.has_invisible_parts = !document.nodes.iter().all(is_visible);
    Ok(model)
}

/// A file's JSON with the bytes that its accessors look at.
#[derive(Debug)]
struct Asset<'a> {
    source: &'a Source<'a>,
    document: &'a Document,
    buffers: Buffers<'a>,
    budget: Budget,
}

impl<'a> Asset<'a> {
    fn new(source: &'a Source<'a>, document: &'a Document, binary: Option<&'a [u8]>) -> Self {
        Self {
            source,
            document,
            buffers: Buffers::new(document.buffers.len(), binary),
            budget: Budget::new(source.bytes.len()),
        }
    }

    /// An error at a part of the JSON.
    fn error(&self, kind: ReadErrorKind, part: String, what: impl Into<String>) -> ReadError {
        self.source.error(kind, Some(Place::Part(part)), what)
    }

    /// The element of `list` that `part` names by its index; `lists` is what the
    /// list is called in the JSON.
    fn get<T>(
        &self,
        list: &'a [T],
        index: usize,
        lists: &str,
        part: impl FnOnce() -> String,
    ) -> Result<&'a T, ReadError> {
        list.get(index).ok_or_else(|| {
            let what = format!("names {lists}[{index}], of which there are {}", list.len());
            self.error(ReadErrorKind::Syntax, part(), what)
        })
    }

    /// Takes `elements` from the budget.
    fn spend(&self, elements: usize, part: impl FnOnce() -> String) -> Result<(), ReadError> {
        if self.budget.take(elements) {
            return Ok(());
        }
        let what = "too large: instances and shared accessors give more elements than are read; \
                    split the scene";
        Err(self.error(ReadErrorKind::Size, part(), what))
    }
}

/// How many elements have been read, against how many bytes.
#[derive(Debug)]
struct Budget {
    bytes: Cell<usize>,
    spent: Cell<usize>,
}

impl Budget {
    const fn new(bytes: usize) -> Self {
        Self { bytes: Cell::new(bytes), spent: Cell::new(0) }
    }

    /// How many bytes have been read so far, the file and others.
    const fn bytes(&self) -> usize {
        self.bytes.get()
    }

    /// Counts bytes of another file.
    fn add_bytes(&self, bytes: usize) {
        self.bytes.set(self.bytes.get().saturating_add(bytes));
    }

    /// Whether `elements` more may be read.
    fn take(&self, elements: usize) -> bool {
        self.spent.set(self.spent.get().saturating_add(elements));
        let limit = self.bytes.get().saturating_add(SHARED_ELEMENTS).min(MAX_INDEX);
        self.spent.get() <= limit
    }
}

/// What `result` holds; where it failed, a warning that the thing was left out.
fn or_left_out<T>(result: Result<T, ReadError>, report: &mut Report) -> Option<T> {
    result
        .map_err(|error| {
            let code = match error.kind {
                ReadErrorKind::Uri => WarningCode::Uri,
                _ => WarningCode::Syntax,
            };
            report.warn(code, error.place, || format!("{}; it was left out", error.what));
        })
        .ok()
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::sample::{SQUARE, Sample, one_mesh, read};
    use super::*;
    use crate::report::Warning;

    /// A quad of two triangles, its positions and indices in the file itself.
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
    fn a_quad_with_its_bytes_in_the_text() {
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
        let model = read_gltf(&source, &mut Report::default()).unwrap();
        assert_eq!(model.positions[2], [1.0, 1.0, 5.0]);
        assert_eq!(model.corner_positions, [0, 1, 2, 0, 2, 3]);
    }

    #[test]
    fn many_nodes_share_a_mesh() {
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

    #[test]
    fn what_is_shared_over_and_over_ends_in_an_error() {
        let document = Document::default();
        let source = Source { name: "test.gltf", folder: None, bytes: b"12345" };
        let asset = Asset::new(&source, &document, None);
        asset.budget.add_bytes(3);
        assert!(asset.spend(SHARED_ELEMENTS, String::new).is_ok());
        assert!(asset.spend(8, String::new).is_ok(), "one for each byte");
        let error = asset.spend(1, || "accessors[4]".into()).unwrap_err();
        assert_eq!(error.kind, ReadErrorKind::Size);
        assert_eq!(error.place, Some(Place::Part("accessors[4]".into())));
        assert!(asset.spend(usize::MAX, String::new).is_err());
    }
}
