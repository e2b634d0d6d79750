//! The nodes, meshes and skins of a document.

use serde_json::{Value, json};

use super::binary_data::BinaryData;
use super::edge_visibility::EXTENSION;
use super::instances::{placed_node, shift_materials};
use super::primitives::{Attributes, line_primitive, triangle_primitives};
use super::rig::{Bending, RigLists};
use super::surface::{Surface, line_ends};
use crate::edge_mesh::{EdgeMesh, InstancedMesh, MeshFrame};
use crate::model::MeshRig;

/// The nodes, meshes and skins of a document.
#[derive(Debug, Default)]
pub(super) struct Objects {
    pub(super) roots: Vec<usize>,
    pub(super) nodes: Vec<Value>,
    pub(super) meshes: Vec<Value>,
    pub(super) skins: Vec<Value>,
}

impl Objects {
    /// One mesh in its place.
    pub(super) fn of_mesh(mesh: &EdgeMesh, name: &str, data: &mut BinaryData) -> Self {
        let mut objects = Self::default();
        objects.meshes.extend(whole_mesh(mesh, name, data));
        let own = (!objects.meshes.is_empty()).then_some(0);
        objects.add_placed(&mesh.frame, name, own);
        objects
    }

    /// The mesh of each part of a rig at its node, and the lines without a face in their place.
    pub(super) fn of_rig(
        mesh: &EdgeMesh,
        own: &MeshRig,
        name: &str,
        data: &mut BinaryData,
    ) -> Self {
        let surface = Surface::of_rig(mesh, own);
        let rig = &own.rig;
        let parts = surface.parts.iter().zip(&surface.rig_vertices).zip(&rig.parts);
        let attributes: Vec<Attributes> = parts
            .map(|((vertices, of_rig), part)| match of_rig.is_empty() {
                true => Attributes::default(),
                false => {
                    let bending = Bending::of(rig, part, of_rig, data);
                    Attributes::of(vertices, true, data).with(bending)
                }
            })
            .collect();
        let mut objects = Self::default();
        let mut mesh_of_part = vec![None; rig.parts.len()];
        for (part, primitive) in triangle_primitives(mesh, &surface, &attributes, data) {
            let weights = &rig.parts[part].weights;
            let number = *mesh_of_part[part].get_or_insert_with(|| {
                let mut mesh = json!({"name": name, "primitives": []});
                if !weights.is_empty() {
                    mesh["weights"] = json!(weights);
                }
                objects.meshes.push(mesh);
                objects.meshes.len() - 1
            });
            if let Some(primitives) = objects.meshes[number]["primitives"].as_array_mut() {
                primitives.push(primitive);
            }
        }
        let lists = RigLists::new(rig, &mesh_of_part, data);
        (objects.nodes, objects.skins, objects.roots) = (lists.nodes, lists.skins, lists.roots);
        objects.add_lines(mesh, name, data);
        objects
    }

    /// Adds a mesh with a node for each of its places. Its materials follow the first
    /// `first_material` of the file.
    pub(super) fn add_instanced(
        &mut self,
        InstancedMesh { mesh, placements }: &InstancedMesh,
        name: &str,
        first_material: usize,
        data: &mut BinaryData,
    ) {
        let Some(mut own) = whole_mesh(mesh, name, data) else { return };
        shift_materials(&mut own, first_material);
        self.meshes.push(own);
        let number = self.meshes.len() - 1;
        let is_placed = !mesh.frame.is_identity();
        if is_placed {
            self.add_placed(&mesh.frame, name, None);
        }
        let parent = self.nodes.len();
        self.nodes.extend(placements.iter().map(|place| placed_node(place, name, number)));
        let own = parent..self.nodes.len();
        if is_placed {
            self.nodes[parent - 1]["children"] = json!(own.collect::<Vec<usize>>());
        } else {
            self.roots.extend(own);
        }
    }

    /// Adds the lines without a face as a mesh of their own.
    fn add_lines(&mut self, mesh: &EdgeMesh, name: &str, data: &mut BinaryData) {
        let ends: Vec<u32> = line_ends(mesh).collect();
        let positions: Vec<[f32; 3]> =
            ends.iter().map(|&end| mesh.positions[end as usize]).collect();
        let attributes = match ends.is_empty() {
            true => return,
            false => Attributes::of_positions(&positions, data),
        };
        let lines: Vec<u32> = (0..crate::index::to_u32(ends.len())).collect();
        let primitives: Vec<Value> =
            line_primitive(&attributes, &lines, data).into_iter().collect();
        self.meshes.push(json!({"name": name, "primitives": primitives}));
        self.add_placed(&mesh.frame, name, Some(self.meshes.len() - 1));
    }

    /// Adds the node of a mesh in its frame as a root.
    fn add_placed(&mut self, frame: &MeshFrame, name: &str, mesh: Option<usize>) {
        let first = self.nodes.len();
        self.roots.push(first);
        self.nodes.extend(nodes(frame, name, first, mesh));
    }

    /// Whether any primitive has visible edges.
    pub(super) fn uses_extension(&self) -> bool {
        let primitives =
            self.meshes.iter().filter_map(|mesh| mesh["primitives"].as_array()).flatten();
        let mut extensions = primitives.filter_map(|primitive| primitive.get("extensions"));
        extensions.any(|extensions| extensions.get(EXTENSION).is_some())
    }
}

/// A mesh with its triangles and its lines without a face; `None` without any.
fn whole_mesh(mesh: &EdgeMesh, name: &str, data: &mut BinaryData) -> Option<Value> {
    let surface = Surface::of(mesh);
    let vertices = &surface.parts[0];
    let lines: Vec<u32> = line_ends(mesh).map(|end| vertices.stored(end)).collect();
    if surface.corners.is_empty() && lines.is_empty() {
        return None;
    }
    let attributes = Attributes::of(vertices, !surface.corners.is_empty(), data);
    let mut primitives: Vec<Value> =
        triangle_primitives(mesh, &surface, std::slice::from_ref(&attributes), data)
            .into_iter()
            .map(|(_, primitive)| primitive)
            .collect();
    primitives.extend(line_primitive(&attributes, &lines, data));
    Some(json!({"name": name, "primitives": primitives}))
}

/// The node of a mesh, number `first` of the file. A mesh with a frame has a second node within,
/// because many readers keep only 32 bits of a translation.
fn nodes(frame: &MeshFrame, name: &str, first: usize, mesh: Option<usize>) -> Vec<Value> {
    let mut inner = mesh.map_or_else(|| json!({}), |mesh| json!({"mesh": mesh}));
    if frame.is_identity() {
        inner["name"] = name.into();
        return vec![inner];
    }
    let rounded = frame.origin.as_vec3().as_dvec3();
    let origin = if rounded.is_finite() { rounded } else { frame.origin };
    let scale = 1.0 / frame.scale;
    inner["translation"] = json!((frame.origin - origin).to_array());
    inner["scale"] = json!([scale, scale, scale]);
    let children = json!([first + 1]);
    vec![json!({"name": name, "translation": origin.to_array(), "children": children}), inner]
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    #[test]
    fn translations_fit_into_32_bits_for_each_node() {
        let nodes = |x, scale| {
            nodes(&MeshFrame { origin: DVec3::new(x, 0.5, 0.0), scale }, "far", 0, Some(0))
        };
        let expected = |outer: f64, inner: f64, scale: f64| {
            vec![
                json!({"name": "far", "translation": [outer, 0.5, 0.0], "children": [1]}),
                json!({"mesh": 0, "translation": [inner, 0.0, 0.0], "scale": [scale, scale, scale]}),
            ]
        };
        assert_eq!(nodes(16_777_217.0, 0.5), expected(16_777_216.0, 1.0, 2.0));
        assert_eq!(nodes(1e300, 1.0), expected(1e300, 0.0, 1.0), "beyond 32 bits");
    }
}
