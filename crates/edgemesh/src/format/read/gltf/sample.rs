//! Small files for tests.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};

use super::super::error::ReadError;
use super::super::source::Source;
use super::read_gltf;
use crate::format::validate;
use crate::model::Model;
use crate::report::Report;

/// A file; all accessors share one buffer.
#[derive(Default)]
pub(super) struct Sample {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Sample {
    /// Adds a view of `bytes` with the members of `more`; returns its index.
    pub(super) fn view(&mut self, bytes: &[u8], more: &Value) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let view = json!({
            "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()
        });
        self.bytes.extend(bytes);
        self.views.push(joined(view, more));
        self.views.len() - 1
    }

    /// Adds an accessor; returns its index.
    pub(super) fn accessor(&mut self, accessor: Value) -> usize {
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// Adds an accessor of floats, of a type such as `VEC3`; returns its index.
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

    /// Adds an accessor of unsigned bytes; returns its index.
    pub(super) fn bytes<const N: usize>(&mut self, kind: &str, elements: &[[u8; N]]) -> usize {
        let view = self.view(elements.as_flattened(), &json!({}));
        self.accessor(json!({
            "bufferView": view, "componentType": 5121, "count": elements.len(), "type": kind
        }))
    }

    /// The JSON of the file, with the members of `rest` beside its buffers.
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

    /// Reads the file, with the members of `rest` beside its buffers.
    pub(super) fn read(&self, rest: &Value) -> Result<(Model, Report), ReadError> {
        read(&self.json(rest))
    }

    /// Reads the file, with one node that has a mesh of one primitive.
    pub(super) fn read_primitive(&self, primitive: &Value) -> Result<(Model, Report), ReadError> {
        self.read(&one_mesh(primitive))
    }
}

/// One node that has a mesh of one primitive.
pub(super) fn one_mesh(primitive: &Value) -> Value {
    json!({"nodes": [{"mesh": 0}], "meshes": [{"primitives": [primitive]}]})
}

/// Reads a file of this JSON.
pub(super) fn read(json: &Value) -> Result<(Model, Report), ReadError> {
    let text = json.to_string();
    let source = Source { name: "test.gltf", folder: None, bytes: text.as_bytes() };
    read_source(&source)
}

/// Reads a file, with the warnings of the rules that it breaks.
pub(super) fn read_source(source: &Source) -> Result<(Model, Report), ReadError> {
    let mut report = Report::default();
    let model = read_gltf(source, validate::gltf::check, &mut report)?;
    Ok((model, report))
}

/// The members of both objects; those of `more` replace others.
pub(super) fn joined(mut object: Value, more: &Value) -> Value {
    for (name, value) in more.as_object().into_iter().flatten() {
        object[name] = value.clone();
    }
    object
}

/// The four corners of a unit square, counterclockwise.
pub(super) const SQUARE: [[f32; 3]; 4] =
    [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

/// The corners of the two triangles of [`SQUARE`].
pub(super) const TWO_TRIANGLES: [[u8; 1]; 6] = [[0], [1], [2], [0], [2], [3]];
