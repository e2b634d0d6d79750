//! The extension of a primitive as JSON, with the classes of its edges.

use serde_json::{Value, json};

use super::binary_data::{BinaryData, ElementType, float_bytes};
use super::edge_visibility::{ClassRun, EdgeVisibility, LineStrings};
use crate::edge_mesh::class_names;

/// The extension of a primitive with `vertices` vertices.
pub(super) fn extension(
    visibility: &EdgeVisibility,
    vertices: usize,
    data: &mut BinaryData,
) -> Value {
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
    if visibility.silhouette_classes.iter().any(|run| !run.classes.is_empty()) {
        let mut extras = extension["extras"].take();
        extras["silhouettes"] = runs(&visibility.silhouette_classes);
        extension["extras"] = extras;
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
