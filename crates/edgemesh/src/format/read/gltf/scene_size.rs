//! Counts what a scene draws before it is read.
//!
//! A small file can name a mesh many times, by nodes and by instances. Without this
//! count, it would be refused only when memory is full of them. The count is what the
//! file states, so it is never larger than what reading takes from the
//! [`Budget`](super::asset::Budget), which limits the rest. A count that no buffer can
//! hold is left to the accessor, which knows its place.
//!
//! A large mesh in several places is read once, so it counts once, unless there are too many
//! places for objects.

use std::collections::BTreeSet;

use gltf_json as json;
use json::mesh::Semantic;
use json::validation::Checked;

use super::super::error::{ReadError, ReadErrorKind};
use super::accessor::MAX_FREE_ZEROS;
use super::asset::{Asset, SHARED_ELEMENTS};
use super::document::Document;
use super::instances::stated_count;
use crate::index::{MAX_INDEX, MAX_PLACEMENTS};

/// A mesh of fewer corners is copied for each of its places, because each object has buffers
/// and draws of its own.
///
/// Measured with a million triangles in all on Mesa's software driver: 1,000 objects of 1,000
/// triangles take 1.5 times the frame of one copied mesh, 500 of 2,000 the same, 62 of 16,000
/// take 0.6 times the frame and a third of the time to the first picture; memory is 0.6, 0.5
/// and 0.45 times. A graphics card draws triangles faster, and most of the time of an object
/// is the processor's, so the least mesh has twice the triangles at which both are even.
pub(super) const MIN_SHARED_CORNERS: u64 = 12_000;

/// What the nodes of a scene draw, and which of its meshes are read once.
#[derive(Debug, Default)]
pub(super) struct SceneSize {
    /// For each mesh its vertices and corners, if it is read once.
    shared: Vec<Option<u64>>,
    places: u64,
    elements: u64,
    limit: u64,
}

/// What the file states of a mesh.
#[derive(Debug, Clone, Copy)]
struct MeshUse {
    /// Vertices and corners.
    elements: u64,
    corners: u64,
    /// Nodes and instances that draw it.
    places: u64,
    /// Whether no skin and no morph target bends it.
    is_rigid: bool,
}

impl SceneSize {
    /// Checks that the meshes of `nodes` have not too many vertices and corners together.
    ///
    /// # Errors
    /// Size, with the number of nodes and instances and the limit.
    pub(super) fn of(asset: &Asset, nodes: &[usize]) -> Result<Self, ReadError> {
        let bytes = stated_bytes(asset);
        let uses = mesh_uses(asset, nodes, bytes.saturating_add(MAX_FREE_ZEROS));
        let sum = |of: &dyn Fn(&MeshUse) -> u64| {
            uses.iter().fold(0_u64, |sum, mesh| sum.saturating_add(of(mesh)))
        };
        let shared_places = sum(&|mesh| if mesh.is_shared() { mesh.places } else { 0 });
        let shares = shared_places <= MAX_PLACEMENTS as u64;
        let shared = |mesh: &MeshUse| (shares && mesh.is_shared()).then_some(mesh.elements);
        let size = Self {
            places: sum(&|mesh| mesh.places),
            elements: sum(&|mesh| {
                shared(mesh).unwrap_or_else(|| mesh.elements.saturating_mul(mesh.places))
            }),
            limit: bytes.saturating_add(SHARED_ELEMENTS as u64).min(MAX_INDEX as u64),
            shared: uses.iter().map(shared).collect(),
        };
        size.check(asset)?;
        Ok(size)
    }

    /// Whether a mesh is read once for all its places.
    pub(super) fn is_shared(&self, mesh: usize) -> bool {
        self.shared.get(mesh).is_some_and(Option::is_some)
    }

    /// Counts a copy of a mesh that is read once.
    ///
    /// # Errors
    /// As [`Self::of`].
    pub(super) fn add_copy(&mut self, asset: &Asset, mesh: usize) -> Result<(), ReadError> {
        let elements = self.shared.get(mesh).copied().flatten().unwrap_or_default();
        self.elements = self.elements.saturating_add(elements);
        self.check(asset)
    }

    fn check(&self, asset: &Asset) -> Result<(), ReadError> {
        let Self { places, elements, limit, .. } = self;
        if elements <= limit {
            return Ok(());
        }
        let what = format!(
            "too large: {places} nodes and instances draw {elements} vertices and corners; the \
             limit is {limit}: split the scene"
        );
        Err(asset.source.error(ReadErrorKind::Size, None, what))
    }
}

impl MeshUse {
    /// Whether the mesh is worth to be read once.
    const fn is_shared(&self) -> bool {
        self.is_rigid && self.places > 1 && self.corners >= MIN_SHARED_CORNERS
    }
}

/// The size of each mesh, at most `most` for each accessor, and how `nodes` draw it.
fn mesh_uses(asset: &Asset, nodes: &[usize], most: u64) -> Vec<MeshUse> {
    let document = asset.document;
    let unused = |mesh: &json::Mesh| {
        let (vertices, corners) = mesh_size(document, mesh, most);
        let elements = vertices.saturating_add(corners);
        let is_rigid = mesh.primitives.iter().all(|primitive| primitive.targets.is_none());
        MeshUse { elements, corners, places: 0, is_rigid }
    };
    let mut uses: Vec<MeshUse> = document.meshes.iter().map(unused).collect();
    for node in nodes.iter().filter_map(|&node| document.nodes.get(node)) {
        let Some(mesh) = node.mesh.and_then(|mesh| uses.get_mut(mesh.value())) else { continue };
        mesh.places = mesh.places.saturating_add(stated_count(asset, node));
        mesh.is_rigid &= node.skin.is_none();
    }
    uses
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
fn mesh_size(document: &Document, mesh: &json::Mesh, most: u64) -> (u64, u64) {
    let count = |index: &json::Index<json::Accessor>| {
        document.accessors.get(index.value()).map_or(0, |accessor| accessor.count.0.min(most))
    };
    let (mut vertices, mut corners) = (0_u64, 0_u64);
    let mut positions = BTreeSet::new();
    for primitive in &mesh.primitives {
        let of_primitive = primitive.attributes.get(&Checked::Valid(Semantic::Positions));
        let own = of_primitive.map_or(0, count);
        if of_primitive.is_some_and(|index| positions.insert(index.value())) {
            vertices = vertices.saturating_add(own);
        }
        let of_primitive = primitive.indices.as_ref().map_or(own, count);
        corners = corners.saturating_add(of_primitive);
    }
    (vertices, corners)
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

    /// Two meshes of a million corners: too large to be copied a hundred times, not to be read
    /// once; skins, morph targets and many places do not share them.
    #[test]
    fn large_meshes_in_several_places_count_once() {
        let plan = |nodes: Value, targets: &Value| {
            let mut sample = Sample::default();
            let many = json!({"componentType": 5126, "count": 1_000_000, "type": "VEC3"});
            let positions = sample.accessor(many);
            let mut primitive = json!({"attributes": {"POSITION": positions}});
            if !targets.is_null() {
                primitive["targets"] = targets.clone();
            }
            let mut rest = one_mesh(&primitive);
            rest["nodes"] = nodes;
            let document: Document = serde_json::from_value(sample.json(&rest)).unwrap();
            let bytes = vec![0; 1 << 20];
            let source = crate::format::read::source::Source {
                name: "test.gltf",
                folder: None,
                bytes: &bytes,
            };
            let asset = Asset::new(&source, &document, None);
            let nodes: Vec<usize> = (0..document.nodes.len()).collect();
            SceneSize::of(&asset, &nodes).map(|size| (size.is_shared(0), size.elements))
        };
        let nodes = |count: usize| vec![json!({"mesh": 0}); count];
        assert_eq!(plan(nodes(1).into(), &Value::Null).unwrap(), (false, 2_000_000));
        assert_eq!(plan(nodes(100).into(), &Value::Null).unwrap(), (true, 2_000_000));
        assert!(plan(nodes(100).into(), &json!([{"POSITION": 0}])).is_err());
        assert_eq!(plan(nodes(9).into(), &json!([{"POSITION": 0}])).unwrap(), (false, 18_000_000));
        let mut skinned = nodes(9);
        skinned.push(json!({"mesh": 0, "skin": 0}));
        assert_eq!(plan(skinned.into(), &Value::Null).unwrap(), (false, 20_000_000));
        assert!(plan(nodes(MAX_PLACEMENTS + 1).into(), &Value::Null).is_err());
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
