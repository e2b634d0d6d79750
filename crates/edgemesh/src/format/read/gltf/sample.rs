//! Small files for tests: bytes of accessors, and the JSON around them.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};

use super::super::error::ReadError;
use super::super::source::Source;
use super::read_gltf;
use crate::model::Model;
use crate::report::Report;

/// A file in the making; all accessors share one buffer.
#[derive(Default)]
pub(super) struct Sample {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Sample {
    /// Adds a view of `bytes` with the members of `more`; gives its index.
    pub(super) fn view(&mut self, bytes: &[u8], more: &Value) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let view = json!({
            "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()
        });
        self.bytes.extend(bytes);
        self.views.push(joined(view, more));
        self.views.len() - 1
    }

    /// Adds an accessor as it is; gives its index.
    pub(super) fn accessor(&mut self, accessor: Value) -> usize {
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// Adds an accessor of floats, of a type such as `VEC3`; gives its index.
    pub(super) fn floats<const N: usize>(&mut self, kind: &str, elements: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = elements.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
        let view = self.view(&bytes, &json!({}));
        let bounds = |pick: fn(f32, f32) -> f32| -> Vec<f32> {
            let column = |at: usize| elements.iter().map(move |element| element[at]);
            (0..N).map(|at| column(at).reduce(pick).unwrap()).collect()
        };
        self.accessor(json!({
            "bufferView": view, "componentType": 5126, "count": elements.len(),
            "type": kind, "min": bounds(f32::min), "max": bounds(f32::max)
        }))
    }

    /// Adds an accessor of unsigned bytes; gives its index.
    pub(super) fn bytes<const N: usize>(&mut self, kind: &str, elements: &[[u8; N]]) -> usize {
        let view = self.view(elements.as_flattened(), &json!({}));
        self.accessor(json!({
            "bufferView": view, "componentType": 5121, "count": elements.len(), "type": kind
        }))
    }

    /// The whole file with the members of `rest` beside its buffers.
    pub(super) fn json(&self, rest: &Value) -> Value {
        let uri = format!("data:;base64,{}", STANDARD.encode(&self.bytes));
        let file = json!({
            "asset": {"version": "2.0"},
            "buffers": [{"byteLength": self.bytes.len(), "uri": uri}],
            "bufferViews": self.views,
            "accessors": self.accessors
        });
        joined(file, rest)
    }

    /// What the reader makes of the whole file.
    pub(super) fn read(&self, rest: &Value) -> Result<(Model, Report), ReadError> {
        read(&self.json(rest))
    }

    /// What the reader makes of a file of one node with one mesh of one primitive.
    pub(super) fn read_primitive(&self, primitive: &Value) -> Result<(Model, Report), ReadError> {
        self.read(&one_mesh(primitive))
    }
}

/// One node with a mesh of one primitive.
pub(super) fn one_mesh(primitive: &Value) -> Value {
    json!({"nodes": [{"mesh": 0}], "meshes": [{"primitives": [primitive]}]})
}

/// What the reader makes of a file of this JSON, with what it warns of.
pub(super) fn read(json: &Value) -> Result<(Model, Report), ReadError> {
    let text = json.to_string();
    let source = Source { name: "test.gltf", folder: None, bytes: text.as_bytes() };
    let mut report = Report::default();
    read_gltf(&source, &mut report).map(|model| (model, report))
}

/// The members of both; those of `more` win.
pub(super) fn joined(mut object: Value, more: &Value) -> Value {
    for (name, value) in more.as_object().into_iter().flatten() {
        object[name] = value.clone();
    }
    object
}

/// A unit square in four corners, counterclockwise.
pub(super) const SQUARE: [[f32; 3]; 4] =
    [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

/// The corners of its two triangles.
pub(super) const TWO_TRIANGLES: [[u8; 1]; 6] = [[0], [1], [2], [0], [2], [3]];
