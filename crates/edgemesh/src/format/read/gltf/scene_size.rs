//! Counts what a scene draws before it is read.
//!
//! A small file can name a mesh many times, by nodes and by instances. Without this
//! count, it would be refused only when memory is full of them. The count is what the
//! file states, so it is never larger than what reading takes from the
//! [`Budget`](super::asset::Budget), which limits the rest. A count that no buffer can
//! hold is left to the accessor, which knows its place.

use std::collections::BTreeSet;

use gltf_json as json;
use json::mesh::Semantic;
use json::validation::Checked;

use super::super::error::{ReadError, ReadErrorKind};
use super::accessor::MAX_FREE_ZEROS;
use super::asset::{Asset, SHARED_ELEMENTS};
use super::document::Document;
use super::instances::stated_count;
use crate::index::MAX_INDEX;

/// Checks that the meshes of `nodes` have not too many vertices and corners together.
///
/// # Errors
/// Size, with the number of nodes and instances and the limit.
pub(super) fn check_scene_size(asset: &Asset, nodes: &[usize]) -> Result<(), ReadError> {
    let document = asset.document;
    let bytes = stated_bytes(asset);
    let most = bytes.saturating_add(MAX_FREE_ZEROS);
    let sizes: Vec<u64> =
        document.meshes.iter().map(|mesh| mesh_size(document, mesh, most)).collect();
    let (mut places, mut elements) = (0_u64, 0_u64);
    for node in nodes.iter().filter_map(|&node| document.nodes.get(node)) {
        let Some(size) = node.mesh.and_then(|mesh| sizes.get(mesh.value())) else { continue };
        let count = stated_count(asset, node);
        places = places.saturating_add(count);
        elements = elements.saturating_add(count.saturating_mul(*size));
    }
    let limit = bytes.saturating_add(SHARED_ELEMENTS as u64).min(MAX_INDEX as u64);
    if elements <= limit {
        return Ok(());
    }
    let what = format!(
        "too large: {places} nodes and instances draw {elements} vertices and corners; the limit \
         is {limit}: split the scene"
    );
    Err(asset.source.error(ReadErrorKind::Size, None, what))
}

/// The bytes of the file, and those that its buffers state.
fn stated_bytes(asset: &Asset) -> u64 {
    let beside = asset.document.buffers.iter().filter(|buffer| buffer.uri.is_some());
    beside.fold(asset.source.bytes.len() as u64, |sum, buffer| {
        sum.saturating_add(buffer.byte_length.0)
    })
}

/// The stated vertices and corners of a mesh, at most `most` for each accessor; primitives
/// share vertices if they have the same positions.
fn mesh_size(document: &Document, mesh: &json::Mesh, most: u64) -> u64 {
    let count = |index: &json::Index<json::Accessor>| {
        document.accessors.get(index.value()).map_or(0, |accessor| accessor.count.0.min(most))
    };
    let mut size = 0_u64;
    let mut positions = BTreeSet::new();
    for primitive in &mesh.primitives {
        let of_primitive = primitive.attributes.get(&Checked::Valid(Semantic::Positions));
        let vertices = of_primitive.map_or(0, count);
        if of_primitive.is_some_and(|index| positions.insert(index.value())) {
            size = size.saturating_add(vertices);
        }
        let corners = primitive.indices.as_ref().map_or(vertices, count);
        size = size.saturating_add(corners);
    }
    size
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::super::sample::{Sample, one_mesh};
    use super::*;
    use crate::report::{Place, Report};

    /// A triangle of 1000 corners that are stated and not there.
    fn file(nodes: Value, instances: u64) -> Value {
        let mut sample = Sample::default();
        let many = |count: u64| json!({"componentType": 5126, "count": count, "type": "VEC3"});
        let positions = sample.accessor(many(1000));
        sample.accessor(many(instances));
        let mut rest = one_mesh(&json!({"attributes": {"POSITION": positions}}));
        rest["nodes"] = nodes;
        sample.json(&rest)
    }

    fn check(file: &Value) -> Result<(), ReadError> {
        super::super::sample::read(file).map(|_: (_, Report)| ())
    }

    #[test]
    fn nodes_and_instances_are_counted_before_they_are_read() {
        let nodes: Vec<Value> = (0..100_000).map(|_| json!({"mesh": 0})).collect();
        let error = check(&file(nodes.into(), 1)).unwrap_err();
        assert_eq!((error.kind, &error.place), (ReadErrorKind::Size, &None::<Place>));
        // 1000 vertices and 1000 corners each.
        assert!(error.what.contains("100000 nodes and instances draw 200000000 "), "{error}");
        let extension = json!({"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 1}}});
        let node = json!([{"mesh": 0, "extensions": extension}]);
        let error = check(&file(node.clone(), 1_000_000)).unwrap_err();
        assert!(error.what.contains("1000000 nodes and instances"), "{error}");
        let error = check(&file(node.clone(), u64::MAX)).unwrap_err();
        assert!(error.what.contains("18446744073709551615 nodes"), "{error}");
        assert_eq!(check(&file(node, 30)), Ok(()));
        let unused: Vec<Value> = (0..100_000).map(|_| json!({})).collect();
        let error = check(&file(unused.into(), 1)).map_err(|error| error.kind);
        assert_ne!(error, Err(ReadErrorKind::Size));
    }
}
