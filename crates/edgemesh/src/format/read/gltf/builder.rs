//! Builds one model from the nodes of a scene.
//!
//! ```text
//! node --mesh--> primitive --> vertices, shared by primitives with the same attributes
//!                         '--> triangles and segments of these vertices
//! at the end: all vertices into the rest pose
//! ```
//!
//! Vertices stay as they are in the file until the end, because the pose that places
//! them then is the same code that animates them later.

use std::collections::hash_map::Entry;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::{iter, mem};

use glam::{DAffine3, DVec3, Vec3};
use gltf_json as json;
use json::mesh::Semantic;
use json::validation::Checked;

use super::super::error::{ReadError, ReadErrorKind};
use super::super::normal_transform::normal_transform;
use super::super::stated::add_stated_edge;
use super::asset::Asset;
use super::deform::{add_influences, morph_targets, new_rig};
use super::edge_extensions::edge_marks;
use super::extension::check_uncompressed;
use super::instances::instances;
use super::material::material;
use super::placements::{Placed, relative, similar_groups};
use super::primitive::Primitive;
use super::scene::NodeHierarchy;
use super::scene_size::SceneSize;
use super::texture::PictureCache;
use super::topology::{Shapes, shapes};
use super::vertices::{VertexAttributes, positions};
use crate::index::{NONE, to_u32};
use crate::model::{
    Attributes, Corner, InstancedModel, Model, NodeTransform, Pose, Rig, RigNode, RigPart, Segment,
    Smoothing, WHITE,
};
use crate::report::{Report, WarningCode};

/// A model and its rig, to which nodes are added.
#[derive(Debug)]
pub(super) struct ModelBuilder<'a> {
    asset: &'a Asset<'a>,
    report: &'a mut Report,
    /// Holds the positions until the end, without the transforms of their nodes.
    rig: Rig,
    rest: Pose,
    model: Model,
    /// For each material of the file, its index in the model, or [`NONE`].
    materials: Vec<u32>,
    pictures: PictureCache,
    size: SceneSize,
    /// The places of each mesh that is read once.
    shared: BTreeMap<usize, Vec<Placed>>,
}

/// The attributes and morph targets that primitives with shared vertices have in
/// common.
type VertexKey = (BTreeMap<Checked<Semantic>, json::Index<json::Accessor>>, Vec<Option<usize>>);

/// The cost of a primitive without its vertices, in elements of the budget. It limits
/// files in which many nodes share many empty primitives.
const PRIMITIVE_ELEMENTS: usize = 64;

/// A range of vertices with the same attributes.
#[derive(Debug, Clone, Copy)]
struct VertexRange {
    first: u32,
    count: u32,
    has_normals: bool,
    has_texcoords: bool,
    is_mirrored: bool,
}

/// Where a mesh is drawn.
#[derive(Debug, Clone, Copy)]
struct Spot {
    /// The node that has the mesh.
    node: usize,
    /// The node of the rig that places it: the same, or an instance.
    rig_node: usize,
}

impl<'a> ModelBuilder<'a> {
    /// An empty model with the rig of the file.
    ///
    /// # Errors
    /// As [`new_rig`].
    pub(super) fn new(
        asset: &'a Asset<'a>,
        hierarchy: &NodeHierarchy,
        size: SceneSize,
        report: &'a mut Report,
    ) -> Result<Self, ReadError> {
        let rig = new_rig(asset, hierarchy)?;
        Ok(Self::of_rig(asset, rig, size, report))
    }

    fn of_rig(asset: &'a Asset<'a>, rig: Rig, size: SceneSize, report: &'a mut Report) -> Self {
        let rest = rig.rest_pose();
        let materials = vec![NONE; asset.document.materials.len()];
        let (model, pictures, shared) = Default::default();
        Self { asset, report, rig, rest, model, materials, pictures, size, shared }
    }

    /// Adds the mesh of a node, if it has one. One that is read once is kept for
    /// [`Self::add_shared`].
    ///
    /// # Errors
    /// Fails if the mesh, its skin, its positions or its indices have a fault.
    pub(super) fn add_node(&mut self, index: usize) -> Result<(), ReadError> {
        let document = self.asset.document;
        let node = self.asset.get(&document.nodes, index, "nodes", String::new)?;
        let Some(mesh_index) = node.mesh.map(|mesh| mesh.value()) else { return Ok(()) };
        let part = || format!("nodes[{index}]");
        let mesh = self.asset.get(&document.meshes, mesh_index, "meshes", part)?;
        let found = instances(self.asset, index, node).unwrap_or_else(|error| {
            error.warn_left_out(self.report);
            None
        });
        let is_shared = self.size.is_shared(mesh_index);
        let instances = found.map_or_else(|| vec![None], |all| all.into_iter().map(Some).collect());
        for instance in instances {
            let placed = self.placed(index, instance);
            if is_shared {
                self.shared.entry(mesh_index).or_default().push(placed);
            } else {
                self.add_copy(&placed, mesh_index, mesh)?;
            }
        }
        Ok(())
    }

    /// The place of a node, or of an instance of it.
    fn placed(&self, node: usize, instance: Option<NodeTransform>) -> Placed {
        let world_from_node = self.rest.world_from_node.get(node).copied().unwrap_or_default();
        let own = instance.map_or(DAffine3::IDENTITY, |instance| instance.parent_from_node());
        Placed { node, instance, world: world_from_node * own }
    }

    /// Adds a mesh to the model.
    fn add_copy(
        &mut self,
        &Placed { node, instance, .. }: &Placed,
        mesh_index: usize,
        mesh: &'a json::Mesh,
    ) -> Result<(), ReadError> {
        let rig_node = instance.map_or(node, |instance| self.add_instance(node, instance));
        self.add_mesh(Spot { node, rig_node }, mesh_index, mesh)
    }

    /// The meshes that are read once, with their places. A place that is stretched as no other
    /// is gets a copy in this model.
    ///
    /// # Errors
    /// As [`Self::add_node`]; Size if there are too many such copies.
    pub(super) fn add_shared(&mut self) -> Result<Vec<InstancedModel>, ReadError> {
        let mut instanced = Vec::new();
        for (mesh_index, placed) in mem::take(&mut self.shared) {
            let part = || format!("meshes[{mesh_index}]");
            let mesh = self.asset.get(&self.asset.document.meshes, mesh_index, "meshes", part)?;
            for group in similar_groups(placed) {
                if let [only] = &group[..] {
                    self.size.add_copy(self.asset, mesh_index)?;
                    self.add_copy(only, mesh_index, mesh)?;
                } else {
                    instanced.push(self.instanced(&group, mesh_index, mesh)?);
                }
            }
        }
        Ok(instanced)
    }

    /// A mesh as a model of its own, in the first of its places.
    fn instanced(
        &mut self,
        group: &[Placed],
        mesh_index: usize,
        mesh: &json::Mesh,
    ) -> Result<InstancedModel, ReadError> {
        let Placed { node, world, .. } = group[0];
        let root = RigNode { parent: NONE, transform: NodeTransform::Matrix(world) };
        let rig = Rig { nodes: vec![root], node_order: vec![0], ..Rig::default() };
        let mut own = ModelBuilder::of_rig(self.asset, rig, SceneSize::default(), self.report);
        own.pictures = mem::take(&mut self.pictures);
        own.add_mesh(Spot { node, rig_node: 0 }, mesh_index, mesh)?;
        self.pictures = mem::take(&mut own.pictures);
        Ok(InstancedModel { model: own.finish(), placements: relative(group) })
    }

    /// Adds an instance to the rig, as a child of its node; returns its index there.
    fn add_instance(&mut self, node: usize, transform: NodeTransform) -> usize {
        let index = self.rig.nodes.len();
        self.rig.nodes.push(RigNode { parent: to_u32(node), transform });
        self.rig.node_order.push(to_u32(index));
        let world_from_node = self.rest.world_from_node.get(node).copied().unwrap_or_default();
        self.rest.world_from_node.push(world_from_node * transform.parent_from_node());
        index
    }

    /// Adds a mesh at a node or at an instance of it.
    fn add_mesh(
        &mut self,
        spot: Spot,
        mesh_index: usize,
        mesh: &'a json::Mesh,
    ) -> Result<(), ReadError> {
        let node = self.asset.document.nodes.get(spot.node);
        let node_name = node.and_then(|node| node.name.as_ref());
        let mut names = [node_name, mesh.name.as_ref()].into_iter().flatten();
        let name = names.find(|name| !name.is_empty());
        let group = to_u32(self.model.groups.len());
        let unnamed = || format!("nodes[{}]", spot.node);
        self.model.groups.push(name.cloned().unwrap_or_else(unnamed));
        let mut ranges = HashMap::new();
        for (at, json) in mesh.primitives.iter().enumerate() {
            let primitive = Primitive { asset: self.asset, json, mesh: mesh_index, index: at };
            let cost = PRIMITIVE_ELEMENTS + json.attributes.len();
            self.asset.spend(cost, || primitive.part())?;
            let range = match ranges.entry(vertex_key(json)) {
                Entry::Occupied(shared) => *shared.get(),
                Entry::Vacant(new) => *new.insert(self.add_vertices(spot, mesh, primitive)?),
            };
            let Some(range) = range else { continue };
            let material = self.material(json);
            let smoothing = Smoothing::Unstated;
            self.model.set_attributes(Attributes { material, group, smoothing });
            self.add_shapes(primitive, range)?;
        }
        Ok(())
    }

    /// The index of a primitive's material in the model, or [`NONE`].
    fn material(&mut self, primitive: &json::mesh::Primitive) -> u32 {
        let Some(index) = primitive.material.map(|material| material.value()) else { return NONE };
        let materials = &self.asset.document.materials;
        let (Some(json), Some(in_model)) = (materials.get(index), self.materials.get_mut(index))
        else {
            return NONE;
        };
        if *in_model == NONE {
            *in_model = to_u32(self.model.materials.len());
            let mut material = material(json);
            if let Some(info) = &json.pbr_metallic_roughness.base_color_texture {
                material.diffuse_texture =
                    self.pictures.base_color_texture(self.asset, index, info, self.report);
            }
            self.model.materials.push(material);
        }
        *in_model
    }

    /// Adds the vertices of a primitive of `mesh` at a node; `None` if it has no
    /// positions.
    fn add_vertices(
        &mut self,
        Spot { node, rig_node }: Spot,
        mesh: &json::Mesh,
        primitive: Primitive,
    ) -> Result<Option<VertexRange>, ReadError> {
        check_uncompressed(primitive)?;
        let Some(positions) = positions(primitive, self.report)? else {
            self.report.warn(WarningCode::Unsupported, primitive.place(), || {
                "a primitive without positions was left out".into()
            });
            return Ok(None);
        };
        let count = positions.len();
        let start = self.rig.positions.len();
        let vertices = to_u32(start)..to_u32(start + count);
        let skin = self.add_skin(node, primitive, count)?;
        let targets = morph_targets(primitive, vertices.start, count)?;
        let json = self.asset.document.nodes.get(node);
        let node_weights = json.and_then(|node| node.weights.as_ref());
        let weights = node_weights.or(mesh.weights.as_ref()).into_iter().flatten().copied();
        let weights = weights.chain(iter::repeat(0.0)).take(targets.len()).collect();
        let attributes = VertexAttributes::read(primitive, count, self.report);
        let range = VertexRange {
            first: vertices.start,
            count: to_u32(count),
            has_normals: !attributes.normals.is_empty(),
            has_texcoords: !attributes.texcoords.is_empty(),
            is_mirrored: self.rig.is_mirrored(&self.rest, rig_node, skin),
        };
        extend_from(&mut self.model.normals, start, attributes.normals, [0.0; 3]);
        extend_from(&mut self.model.texcoords, start, attributes.texcoords, [0.0; 2]);
        extend_from(&mut self.model.colors, start, attributes.colors, WHITE);
        self.rig.positions.extend(positions.into_iter().map(|position| position.map(f64::from)));
        self.rig.parts.push(RigPart { vertices, node: to_u32(rig_node), skin, weights, targets });
        Ok(Some(range))
    }

    /// Adds the influences of the next `count` vertices by the skin of their node;
    /// returns the index of the skin, or [`NONE`].
    fn add_skin(
        &mut self,
        node: usize,
        primitive: Primitive,
        count: usize,
    ) -> Result<u32, ReadError> {
        let skin = self.asset.document.nodes.get(node).and_then(|node| node.skin);
        let Some(index) = skin.map(|skin| skin.value()) else { return Ok(NONE) };
        let part = || format!("nodes[{node}].skin");
        let skin = self.asset.get(&self.asset.document.skins, index, "skins", part)?;
        if add_influences(&mut self.rig, primitive, skin.joints.len(), count, self.report)? {
            return Ok(to_u32(index));
        }
        self.report.warn(WarningCode::Syntax, primitive.place(), || {
            format!("names no joints for the skin of nodes[{node}]; the node places it instead")
        });
        Ok(NONE)
    }

    /// Adds the triangles or segments of a primitive with the vertices of `range`.
    fn add_shapes(&mut self, primitive: Primitive, range: VertexRange) -> Result<(), ReadError> {
        let Checked::Valid(mode) = primitive.json.mode else {
            let what = "has a mode that glTF does not define";
            return Err(primitive.error(ReadErrorKind::Syntax, what));
        };
        let corners = self.corners(primitive, range)?;
        let (shapes, rest) = shapes(mode, &corners);
        self.report.warn_many(WarningCode::Syntax, rest, primitive.place(), || {
            format!("has {rest} surplus corners at the end; they were left out")
        });
        match shapes {
            Shapes::Triangles(triangles) => self.add_triangles(&triangles, primitive, range),
            Shapes::Segments(segments) => self.add_segments(&segments, range),
            Shapes::Points => {
                self.report.warn(WarningCode::Unsupported, primitive.place(), || {
                    "points are not supported; they were left out".into()
                });
            }
        }
        Ok(())
    }

    /// The corners of a primitive, as indices of the vertices of `range`.
    fn corners(&self, primitive: Primitive, range: VertexRange) -> Result<Vec<u32>, ReadError> {
        let Some(index) = primitive.json.indices else {
            self.asset.spend(range.count as usize, || primitive.part())?;
            return Ok((0..range.count).collect());
        };
        let part = || format!("{}.indices", primitive.part());
        let accessor = self.asset.accessor(index.value(), part)?;
        let corners = accessor.indices()?;
        match corners.iter().position(|&corner| corner >= range.count) {
            None => Ok(corners),
            Some(at) => {
                let what = format!(
                    "index {at} of accessors[{index}] names vertex {} (counted from 0) of {}",
                    corners[at], range.count
                );
                Err(primitive.error(ReadErrorKind::Index, what))
            }
        }
    }

    fn add_triangles(&mut self, triangles: &[[u32; 3]], primitive: Primitive, range: VertexRange) {
        for &[a, b, c] in triangles {
            let corners = if range.is_mirrored { [a, c, b] } else { [a, b, c] };
            self.model.push_polygon(&corners.map(|corner| range.corner(corner)), 0);
        }
        let edges = edge_marks(primitive, triangles, range.count, self.report);
        self.add_segments(&edges.marked, range);
        let suppressed = edges.suppressed.iter().map(|ends| ends.map(|end| range.first + end));
        self.model.suppressed_edges.extend(suppressed);
        if edges.states_classes {
            self.model.stated_edges.get_or_insert_default();
        }
        for (ends, classes) in edges.stated {
            let ends = ends.map(|end| range.first + end);
            add_stated_edge(&mut self.model, ends, classes, 0);
        }
    }

    fn add_segments(&mut self, segments: &[[u32; 2]], range: VertexRange) {
        let segment =
            |ends: &[u32; 2]| Segment { ends: ends.map(|end| range.first + end), line: 0 };
        self.model.segments.extend(segments.iter().map(segment));
    }

    /// The model in its rest pose.
    pub(super) fn finish(self) -> Model {
        let Self { mut rig, rest, mut model, .. } = self;
        model.positions = rig.posed_positions(&rest, |part| &rig.parts[part].weights);
        pose_normals(&mut model.normals, &rig, &rest);
        let count = model.positions.len();
        if !model.colors.is_empty() {
            model.colors.resize(count, WHITE);
        }
        remove_repeated_edges(&mut model);
        if rig.bends() {
            if !rig.influence_ends.is_empty() {
                rig.influence_ends.resize(count, to_u32(rig.influences.len()));
            }
            model.rig = Some(Box::new(rig));
        }
        model
    }
}

impl VertexRange {
    const fn corner(self, vertex: u32) -> Corner {
        let position = self.first + vertex;
        Corner {
            position,
            texcoord: if self.has_texcoords { position } else { NONE },
            normal: if self.has_normals { position } else { NONE },
            color: NONE,
        }
    }
}

fn vertex_key(primitive: &json::mesh::Primitive) -> VertexKey {
    let targets = primitive.targets.iter().flatten();
    let targets = targets.map(|target| target.positions.map(|accessor| accessor.value()));
    (primitive.attributes.clone(), targets.collect())
}

/// Resizes `list` to `start` elements with `filler`, then appends `elements`; does
/// nothing if there are none.
fn extend_from<T: Copy>(list: &mut Vec<T>, start: usize, elements: Vec<T>, filler: T) {
    if !elements.is_empty() {
        list.resize(start, filler);
        list.extend(elements);
    }
}

/// Removes repeated segments and suppressed edges, which come from edges that two
/// triangles or primitives share, and suppressed edges that are also segments.
fn remove_repeated_edges(model: &mut Model) {
    let mut drawn = HashSet::new();
    model.segments.retain(|segment| {
        let [a, b] = segment.ends;
        drawn.insert([a.min(b), a.max(b)])
    });
    model.suppressed_edges.sort_unstable();
    model.suppressed_edges.dedup();
    model.suppressed_edges.retain(|edge| !drawn.contains(edge));
}

/// Transforms normals by the rest pose.
fn pose_normals(normals: &mut [[f32; 3]], rig: &Rig, pose: &Pose) {
    for part in &rig.parts {
        for vertex in part.vertices.clone() {
            let Some(normal) = normals.get_mut(vertex as usize) else { return };
            let transform = normal_transform(rig.vertex_transform(pose, part, vertex).matrix3);
            let posed = transform * DVec3::from(Vec3::from(*normal));
            *normal = posed.normalize_or_zero().as_vec3().to_array();
        }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::super::sample::{SQUARE, Sample, TWO_TRIANGLES, one_mesh};
    use super::*;
    use crate::report::Place;

    /// A square with normals, on a node with these members.
    fn square_on(node: &json::Value) -> Model {
        let mut sample = Sample::default();
        let mut rest = one_mesh(&json!({
            "attributes": {
                "POSITION": sample.floats("VEC3", &SQUARE),
                "NORMAL": sample.floats("VEC3", &[[0.6, 0.0, 0.8]; 4])
            },
            "indices": sample.bytes("SCALAR", &TWO_TRIANGLES)
        }));
        rest["nodes"] = json!([node]);
        rest["nodes"][0]["mesh"] = 0.into();
        sample.read(&rest).unwrap().0
    }

    #[test]
    fn mirrored_nodes_reverse_the_winding() {
        let model = square_on(&json!({"scale": [-1, 1, 1]}));
        assert_eq!(model.positions[1], [-1.0, 0.0, 0.0]);
        assert_eq!(model.corner_positions, [0, 2, 1, 0, 3, 2]);
        assert!(model.normals[0][0] < 0.0 && model.normals[0][2] > 0.0, "{:?}", model.normals[0]);
        let model = square_on(&json!({"scale": [-1, -1, 1]}));
        assert_eq!(model.corner_positions, [0, 1, 2, 0, 2, 3]);
    }

    #[test]
    fn normals_stay_upright_where_their_surface_is_stretched() {
        let [x, y, z] = square_on(&json!({"scale": [2, 1, 1]})).normals[0];
        // (0.3, 0, 0.8) of unit length.
        let length = 0.73_f32.sqrt();
        assert!((x - 0.3 / length).abs() < 1e-6 && y == 0.0 && (z - 0.8 / length).abs() < 1e-6);
        assert_eq!(square_on(&json!({"scale": [1, 1, 0]})).normals[0], [0.0, 0.0, 1.0]);
        assert_eq!(square_on(&json!({"scale": [1e-20, 0, 0]})).normals[0], [0.0; 3]);
    }

    #[test]
    fn primitives_with_the_same_attributes_share_vertices() {
        let mut sample = Sample::default();
        let [a, b] = [0, 1].map(|_| sample.floats("VEC3", &SQUARE));
        let primitive = |positions: usize, indices: usize, material: usize| {
            json!({
                "attributes": {"POSITION": positions}, "indices": indices, "material": material
            })
        };
        let [first, second] = [&TWO_TRIANGLES[..3], &TWO_TRIANGLES[3..]]
            .map(|triangle| sample.bytes("SCALAR", triangle));
        let rest = json!({
            "nodes": [{"mesh": 0}, {"mesh": 0, "name": "b"}],
            "meshes": [{"name": "m", "primitives": [
                primitive(a, first, 1), primitive(a, second, 0), primitive(b, first, 1)
            ]}],
            "materials": [{"name": "red"}, {"name": "green"}]
        });
        let (model, _) = sample.read(&rest).unwrap();
        assert_eq!(model.positions.len(), 16, "two nodes with two ranges of four vertices");
        assert_eq!(model.corner_positions[..9], [0, 1, 2, 0, 2, 3, 4, 5, 6]);
        assert_eq!(model.corner_positions[9..12], [8, 9, 10]);
        assert_eq!(model.groups, ["m", "b"]);
        let names: Vec<&str> = model.materials.iter().map(|m| m.name.as_str()).collect();
        assert_eq!(names, ["green", "red"], "in the order of their first use");
        assert_eq!(model.per_polygon(|run| run.material), [0, 1, 0, 0, 1, 0]);
        assert_eq!(model.per_polygon(|run| run.group), [0, 0, 0, 1, 1, 1]);
    }

    #[test]
    fn lines_become_segments_and_points_are_left_out() {
        let mut sample = Sample::default();
        let positions = sample.floats("VEC3", &SQUARE);
        let read = |mode: u32| {
            let primitive = json!({"attributes": {"POSITION": positions}, "mode": mode});
            sample.read_primitive(&primitive).unwrap()
        };
        let (model, _) = read(2);
        let ends: Vec<[u32; 2]> = model.segments.iter().map(|segment| segment.ends).collect();
        assert_eq!(ends, [[0, 1], [1, 2], [2, 3], [3, 0]]);
        assert_eq!(read(5).0.corner_positions, [0, 1, 2, 1, 3, 2]);
        let (model, report) = read(0);
        assert_eq!((model.polygon_count(), report.count(WarningCode::Unsupported)), (0, 1));
        let (_, report) = read(4);
        assert_eq!(report.count(WarningCode::Syntax), 1, "one surplus corner");
    }

    #[test]
    fn attributes_of_some_primitives_are_filled_up() {
        let mut sample = Sample::default();
        let [a, b, c] = [0, 1, 2].map(|_| sample.floats("VEC3", &SQUARE[..3]));
        let colors = sample.floats("VEC3", &[[0.5; 3]; 3]);
        let rest = json!({"nodes": [{"mesh": 0}], "meshes": [{"primitives": [
            {"attributes": {"POSITION": a}},
            {"attributes": {"POSITION": b, "COLOR_0": colors, "NORMAL": colors}},
            {"attributes": {"POSITION": c}}
        ]}]});
        let (model, _) = sample.read(&rest).unwrap();
        let gray = model.colors[3];
        assert!((gray[0] - 0.735_357).abs() < 1e-5 && gray[3] == 1.0, "linear 0.5: {gray:?}");
        assert_eq!(model.colors, [[WHITE; 3], [gray; 3], [WHITE; 3]].concat());
        assert_eq!(model.corner_normals, [NONE, NONE, NONE, 3, 4, 5, NONE, NONE, NONE]);
    }

    #[test]
    fn indices_are_checked_with_their_part() {
        let mut sample = Sample::default();
        let primitive = json!({
            "attributes": {"POSITION": sample.floats("VEC3", &SQUARE[..3])},
            "indices": sample.bytes("SCALAR", &TWO_TRIANGLES)
        });
        let error = sample.read_primitive(&primitive).unwrap_err();
        assert_eq!(error.kind, ReadErrorKind::Index);
        assert_eq!(error.place, Some(Place::Part("meshes[0].primitives[0]".into())));
        assert!(
            error.what.starts_with("index 5 of accessors[1] names vertex 3 (counted from 0) of 3"),
            "{error}"
        );
    }

    #[test]
    fn unsupported_parts_give_warnings() {
        let mut sample = Sample::default();
        let positions = sample.floats("VEC3", &SQUARE[..3]);
        let triangle = json!({"attributes": {"POSITION": positions}});
        let mut rest = one_mesh(&triangle);
        rest["meshes"][0]["primitives"] =
            json!([{"attributes": {"NORMAL": positions}, "indices": 0}, triangle]);
        let (model, report) = sample.read(&rest).unwrap();
        assert_eq!(model.polygon_count(), 1);
        assert_eq!(report.count(WarningCode::Unsupported), 1);
        let refusal = |rest: json::Value| sample.read(&rest).unwrap_err();
        let error = refusal(one_mesh(&json!({"attributes": {"POSITION": positions}, "mode": 9})));
        assert_eq!(error.kind, ReadErrorKind::Syntax);
        let mut rest = one_mesh(&triangle);
        rest["nodes"][0]["mesh"] = 3.into();
        assert!(refusal(rest).what.contains("meshes[3]; there are 1"));
    }

    #[test]
    fn compressed_positions_are_errors_even_if_not_required() {
        let mut sample = Sample::default();
        let positions = sample.accessor(json!({"componentType": 5126, "count": 3, "type": "VEC3"}));
        let error = sample
            .read_primitive(&json!({
                "attributes": {"POSITION": positions},
                "extensions": {"KHR_draco_mesh_compression": {}}
            }))
            .unwrap_err();
        assert_eq!(error.kind, ReadErrorKind::Extension);
    }
}
