//! Puts the nodes of a scene together to one model.
//!
//! ```text
//! node --mesh--> primitive --> vertices, once for those that share attributes
//!                         '--> triangles and segments between them
//! at the end: all vertices into the rest pose, part by part
//! ```
//!
//! Vertices are kept as the file has them until all are there: the pose that
//! places them is the same code that animates them later.

use std::collections::hash_map::Entry;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::iter;

use glam::{DMat3, DVec3, Vec3};
use gltf_json as json;
use json::mesh::Semantic;
use json::validation::Checked;

use super::super::error::{ReadError, ReadErrorKind};
use super::Asset;
use super::deform::new_rig;
use super::edge_extensions::edges;
use super::extension::check_uncompressed;
use super::material::material;
use super::scene::Graph;
use super::texture::Textures;
use super::topology::{Shapes, shapes};
use super::vertices::{Looks, Site, positions};
use crate::index::{NONE, to_u32};
use crate::model::rig::{Pose, Rig, RigPart};
use crate::model::{Attributes, Corner, Model, Segment, Smoothing};
use crate::report::{Place, Report, WarningCode};

/// A model on its way.
#[derive(Debug)]
pub(super) struct ModelBuilder<'a> {
    pub(super) asset: &'a Asset<'a>,
    pub(super) report: &'a mut Report,
    /// Holds the vertices until the end, placed by nothing.
    pub(super) rig: Rig,
    rest: Pose,
    model: Model,
    /// The index into the model's materials of each of the file's, or [`NONE`].
    materials: Vec<u32>,
    textures: Textures,
}

/// What primitives of a mesh must have in common to share vertices.
type VertexKey = (BTreeMap<Checked<Semantic>, json::Index<json::Accessor>>, Vec<Option<usize>>);

/// What a primitive costs beside its vertices, in elements of the budget: many
/// nodes that share many empty primitives must end as well.
const PRIMITIVE_ELEMENTS: usize = 64;

/// The colour of vertices that have none, where others have one.
const WHITE: [f32; 3] = [1.0; 3];

/// Vertices in a row, all with the same attributes.
#[derive(Debug, Clone, Copy)]
struct Block {
    base: u32,
    count: u32,
    has_normals: bool,
    has_texcoords: bool,
    is_mirrored: bool,
}

impl<'a> ModelBuilder<'a> {
    /// # Errors
    /// Where a skin is not sound.
    pub(super) fn new(
        asset: &'a Asset<'a>,
        graph: &Graph,
        report: &'a mut Report,
    ) -> Result<Self, ReadError> {
        let rig = new_rig(asset, graph)?;
        let rest = rig.rest_pose();
        let materials = vec![NONE; asset.document.materials.len()];
        let (model, textures) = (Model::default(), Textures::default());
        Ok(Self { asset, report, rig, rest, model, materials, textures })
    }

    /// Adds what the mesh of a node draws.
    ///
    /// # Errors
    /// Where mesh, skin, positions or indices are not sound.
    pub(super) fn add_node(&mut self, index: usize) -> Result<(), ReadError> {
        let document = self.asset.document;
        let node = self.asset.get(&document.nodes, index, "nodes", String::new)?;
        let Some(mesh_index) = node.mesh.map(|mesh| mesh.value()) else { return Ok(()) };
        let part = || format!("nodes[{index}]");
        let mesh = self.asset.get(&document.meshes, mesh_index, "meshes", part)?;
        let extensions = node.extensions.as_ref();
        if extensions.is_some_and(|all| all.others.contains_key("EXT_mesh_gpu_instancing")) {
            self.report.warn(WarningCode::Unsupported, Some(Place::Part(part())), || {
                "EXT_mesh_gpu_instancing is not read: the mesh is drawn once".into()
            });
        }
        let mut names = [&node.name, &mesh.name].into_iter().flatten();
        let name = names.find(|name| !name.is_empty());
        let group = to_u32(self.model.groups.len());
        self.model.groups.push(name.cloned().unwrap_or_else(part));
        let mut blocks = HashMap::new();
        for (at, primitive) in mesh.primitives.iter().enumerate() {
            let site = Site { mesh: mesh_index, primitive: at };
            self.asset.spend(PRIMITIVE_ELEMENTS + primitive.attributes.len(), || site.part())?;
            let block = match blocks.entry(vertex_key(primitive)) {
                Entry::Occupied(known) => *known.get(),
                Entry::Vacant(new) => *new.insert(self.add_vertices(index, mesh, primitive, site)?),
            };
            let Some(block) = block else { continue };
            let material = self.material(primitive);
            self.model.set_attributes(Attributes {
                material,
                group,
                smoothing: Smoothing::Unstated,
            });
            self.add_shapes(primitive, site, block)?;
        }
        Ok(())
    }

    /// The index of a primitive's material in the model, or [`NONE`].
    fn material(&mut self, primitive: &json::mesh::Primitive) -> u32 {
        let Some(index) = primitive.material.map(|material| material.value()) else { return NONE };
        let materials = &self.asset.document.materials;
        let (Some(json), Some(known)) = (materials.get(index), self.materials.get_mut(index))
        else {
            return NONE;
        };
        if *known == NONE {
            *known = to_u32(self.model.materials.len());
            let mut material = material(json);
            if let Some(info) = &json.pbr_metallic_roughness.base_color_texture {
                material.diffuse_texture =
                    self.textures.of_base_color(self.asset, index, info, self.report);
            }
            self.model.materials.push(material);
        }
        *known
    }

    /// Adds the vertices of a primitive of `mesh` where it hangs on a node;
    /// nothing where it has no positions.
    fn add_vertices(
        &mut self,
        node: usize,
        mesh: &json::Mesh,
        primitive: &json::mesh::Primitive,
        site: Site,
    ) -> Result<Option<Block>, ReadError> {
        check_uncompressed(self.asset, primitive, site)?;
        let Some(positions) = positions(self.asset, primitive, site, self.report)? else {
            self.report.warn(WarningCode::Unsupported, site.place(), || {
                "a primitive without positions was left out".into()
            });
            return Ok(None);
        };
        let count = positions.len();
        let start = self.rig.positions.len();
        let vertices = to_u32(start)..to_u32(start + count);
        let skin = self.add_skin(node, primitive, site, count)?;
        let targets = self.targets(primitive, site, vertices.start, count)?;
        let json = self.asset.document.nodes.get(node);
        let own_weights = json.and_then(|node| node.weights.as_ref());
        let weights = own_weights.or(mesh.weights.as_ref()).into_iter().flatten().copied();
        let weights = weights.chain(iter::repeat(0.0)).take(targets.len()).collect();
        let looks = Looks::read(self.asset, primitive, count, site, self.report);
        let block = Block {
            base: vertices.start,
            count: to_u32(count),
            has_normals: !looks.normals.is_empty(),
            has_texcoords: !looks.texcoords.is_empty(),
            is_mirrored: self.is_mirrored(node, skin),
        };
        extend_from(&mut self.model.normals, start, looks.normals, [0.0; 3]);
        extend_from(&mut self.model.texcoords, start, looks.texcoords, [0.0; 2]);
        extend_from(&mut self.model.colors, start, looks.colors, WHITE);
        self.rig.positions.extend(positions.into_iter().map(|position| position.map(f64::from)));
        self.rig.parts.push(RigPart { vertices, node: to_u32(node), skin, weights, targets });
        Ok(Some(block))
    }

    /// Hangs the next `count` vertices on the skin of their node, if it has one;
    /// gives its index, or [`NONE`].
    fn add_skin(
        &mut self,
        node: usize,
        primitive: &json::mesh::Primitive,
        site: Site,
        count: usize,
    ) -> Result<u32, ReadError> {
        let skin = self.asset.document.nodes.get(node).and_then(|node| node.skin);
        let Some(index) = skin.map(|skin| skin.value()) else { return Ok(NONE) };
        let part = || format!("nodes[{node}].skin");
        let skin = self.asset.get(&self.asset.document.skins, index, "skins", part)?;
        if self.add_influences(primitive, site, skin.joints.len(), count)? {
            return Ok(to_u32(index));
        }
        self.report.warn(WarningCode::Syntax, site.place(), || {
            format!("names no joints for the skin of nodes[{node}], which places it instead")
        });
        Ok(NONE)
    }

    /// Whether the rest pose turns faces inside out, which their winding makes
    /// good for. The node of a skinned mesh does not place it, its joints do.
    fn is_mirrored(&self, node: usize, skin: u32) -> bool {
        let joints = self.rest.world_from_mesh.get(skin as usize);
        let placing = match joints {
            Some(joints) => joints.first(),
            None => self.rest.world_from_node.get(node),
        };
        placing.is_some_and(|transform| transform.matrix3.determinant() < 0.0)
    }

    /// Adds the triangles or segments of a primitive between vertices of `block`.
    fn add_shapes(
        &mut self,
        primitive: &json::mesh::Primitive,
        site: Site,
        block: Block,
    ) -> Result<(), ReadError> {
        let Checked::Valid(mode) = primitive.mode else {
            let what = "has a mode that glTF does not have";
            return Err(self.asset.error(ReadErrorKind::Syntax, site.part(), what));
        };
        let corners = self.corners(primitive, site, block)?;
        let (shapes, rest) = shapes(mode, &corners);
        self.report.warn_many(WarningCode::Syntax, rest, site.place(), || {
            format!("{rest} corners at the end of the list make no shape; they were left out")
        });
        match shapes {
            Shapes::Triangles(triangles) => self.add_triangles(&triangles, primitive, site, block),
            Shapes::Segments(segments) => self.add_segments(&segments, block),
            Shapes::Points => {
                self.report.warn(WarningCode::Unsupported, site.place(), || {
                    "points are not drawn; they were left out".into()
                });
            }
        }
        Ok(())
    }

    /// The vertices of `block` that a primitive lists, one after the other.
    fn corners(
        &self,
        primitive: &json::mesh::Primitive,
        site: Site,
        block: Block,
    ) -> Result<Vec<u32>, ReadError> {
        let Some(index) = primitive.indices else {
            self.asset.spend(block.count as usize, || site.part())?;
            return Ok((0..block.count).collect());
        };
        let part = || format!("{}.indices", site.part());
        let accessor = self.asset.accessor(index.value(), part)?;
        let corners = accessor.unsigned::<1>()?.into_flattened();
        match corners.iter().position(|&corner| corner >= block.count) {
            None => Ok(corners),
            Some(at) => {
                let what = format!(
                    "index {at} of accessors[{index}] names vertex {} of {}, counted from 0",
                    corners[at], block.count
                );
                Err(self.asset.error(ReadErrorKind::Index, site.part(), what))
            }
        }
    }

    fn add_triangles(
        &mut self,
        triangles: &[[u32; 3]],
        primitive: &json::mesh::Primitive,
        site: Site,
        block: Block,
    ) {
        for &[a, b, c] in triangles {
            let corners = if block.is_mirrored { [a, c, b] } else { [a, b, c] };
            self.model.push_polygon(&corners.map(|corner| block.corner(corner)), 0);
        }
        let Some(extensions) = &primitive.extensions else { return };
        let extensions = &extensions.others;
        let edges = edges(self.asset, extensions, triangles, block.count, site, self.report);
        self.add_segments(&edges.marked, block);
        let hidden = edges.hidden.iter().map(|ends| ends.map(|end| block.base + end));
        self.model.hidden_edges.extend(hidden);
    }

    fn add_segments(&mut self, segments: &[[u32; 2]], block: Block) {
        let segment = |ends: &[u32; 2]| Segment { ends: ends.map(|end| block.base + end), line: 0 };
        self.model.segments.extend(segments.iter().map(segment));
    }

    /// The model, in its rest pose.
    pub(super) fn finish(self) -> Model {
        let Self { mut rig, rest, mut model, .. } = self;
        model.positions = rig.posed_positions(&rest, |part| &rig.parts[part].weights);
        pose_normals(&mut model.normals, &rig, &rest);
        let count = model.positions.len();
        if !model.colors.is_empty() {
            model.colors.resize(count, WHITE);
        }
        keep_one_of_each(&mut model);
        if rig.bends() {
            if !rig.influence_ends.is_empty() {
                rig.influence_ends.resize(count, to_u32(rig.influences.len()));
            }
            model.rig = Some(Box::new(rig));
        }
        model
    }
}

impl Block {
    const fn corner(self, vertex: u32) -> Corner {
        let position = self.base + vertex;
        Corner {
            position,
            texcoord: if self.has_texcoords { position } else { NONE },
            normal: if self.has_normals { position } else { NONE },
        }
    }
}

fn vertex_key(primitive: &json::mesh::Primitive) -> VertexKey {
    let targets = primitive.targets.iter().flatten();
    let targets = targets.map(|target| target.positions.map(|accessor| accessor.value()));
    (primitive.attributes.clone(), targets.collect())
}

/// Puts `elements` behind the first `start` of `list`; where those have none,
/// `filler` stands in.
fn extend_from<T: Copy>(list: &mut Vec<T>, start: usize, elements: Vec<T>, filler: T) {
    if !elements.is_empty() {
        list.resize(start, filler);
        list.extend(elements);
    }
}

/// Drops segments and hidden edges that are there twice, as those of two
/// triangles or primitives are, and hidden edges that are drawn after all.
fn keep_one_of_each(model: &mut Model) {
    let mut drawn = HashSet::new();
    model.segments.retain(|segment| {
        let [a, b] = segment.ends;
        drawn.insert([a.min(b), a.max(b)])
    });
    model.hidden_edges.sort_unstable();
    model.hidden_edges.dedup();
    model.hidden_edges.retain(|edge| !drawn.contains(edge));
}

/// Turns normals as the rest pose turns the surface they stand on.
fn pose_normals(normals: &mut [[f32; 3]], rig: &Rig, pose: &Pose) {
    for part in &rig.parts {
        for vertex in part.vertices.clone() {
            let Some(normal) = normals.get_mut(vertex as usize) else { return };
            let across = normal_matrix(rig.vertex_transform(pose, part, vertex).matrix3);
            let turned = across * DVec3::from(Vec3::from(*normal));
            *normal = turned.normalize_or_zero().as_vec3().to_array();
        }
    }
}

/// What turns the normals of a surface that `linear` turns: its inverse
/// transpose, but for a positive factor. By cofactors, as `linear` may have no
/// inverse: of a flattened surface the one normal remains.
fn normal_matrix(linear: DMat3) -> DMat3 {
    let DMat3 { x_axis, y_axis, z_axis } = linear;
    let cofactors =
        DMat3::from_cols(y_axis.cross(z_axis), z_axis.cross(x_axis), x_axis.cross(y_axis));
    cofactors * linear.determinant().signum()
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::super::sample::{SQUARE, Sample, TWO_TRIANGLES, one_mesh};
    use super::*;

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
    fn mirrored_nodes_turn_the_winding_around() {
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
        assert_eq!(model.positions.len(), 16, "twice two blocks of four");
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
        assert_eq!(report.count(WarningCode::Syntax), 1, "one corner too many");
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
        assert_eq!(model.colors, [[WHITE; 3], [[0.5; 3]; 3], [WHITE; 3]].concat());
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
        assert!(error.what.starts_with("index 5 of accessors[1] names vertex 3 of 3"), "{error}");
    }

    #[test]
    fn what_cannot_be_drawn_is_told() {
        let mut sample = Sample::default();
        let positions = sample.floats("VEC3", &SQUARE[..3]);
        let triangle = json!({"attributes": {"POSITION": positions}});
        let mut rest = one_mesh(&triangle);
        rest["meshes"][0]["primitives"] =
            json!([{"attributes": {"NORMAL": positions}, "indices": 0}, triangle]);
        rest["nodes"][0]["extensions"] = json!({"EXT_mesh_gpu_instancing": {}});
        let (model, report) = sample.read(&rest).unwrap();
        assert_eq!(model.polygon_count(), 1);
        assert_eq!(report.count(WarningCode::Unsupported), 2);
        let refusal = |rest: json::Value| sample.read(&rest).unwrap_err();
        let error = refusal(one_mesh(&json!({"attributes": {"POSITION": positions}, "mode": 9})));
        assert_eq!(error.kind, ReadErrorKind::Syntax);
        let mut rest = one_mesh(&triangle);
        rest["nodes"][0]["mesh"] = 3.into();
        assert!(refusal(rest).what.contains("meshes[3], of which there are 1"));
    }

    #[test]
    fn compressed_positions_are_refused_even_where_not_required() {
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
