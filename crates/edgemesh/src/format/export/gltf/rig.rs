//! Nodes, skins and morph targets.
//!
//! Based on: glTF 2.0, sections 3.5 (nodes), 3.7.2.2 (morph targets) and 3.7.3 (skins).
//!
//! ```text
//! node 0 ... node n: those of the model, in their places
//!    '- mesh, skin        for each part of the rig; on a node of its own below if its node has
//!                         several
//! node: lines without a face, where the rest pose has them
//! ```
//!
//! The vertices are those of the model before they are posed, so that their nodes, joints and
//! weights place them again. A vertex that the builder welded is the same as that of the model
//! within a triangle: triangles keep the vertices of their own part.

use glam::{DAffine3, DMat4};
use serde_json::{Value, json};

use super::binary_data::{BinaryData, ElementType};
use crate::index::NONE;
use crate::model::{Influence, NodeTransform, Rig, RigPart};

/// The members of a primitive that bend the vertices of a part.
pub(super) struct Bending {
    /// `JOINTS_0`, `WEIGHTS_0` and so on, with their accessors.
    pub(super) attributes: Vec<(String, usize)>,
    /// The accessors of the displacements of each morph target.
    pub(super) targets: Vec<usize>,
}

impl Bending {
    /// The members for the vertices of a part, by their indices in the rig.
    pub(super) fn of(rig: &Rig, part: &RigPart, vertices: &[u32], data: &mut BinaryData) -> Self {
        let targets = (0..part.targets.len())
            .map(|target| data.push_positions(&displacements(part, target, vertices)))
            .collect();
        Self { attributes: joints(rig, part, vertices, data), targets }
    }
}

/// The displacement of each vertex by a morph target.
fn displacements(part: &RigPart, target: usize, vertices: &[u32]) -> Vec<[f32; 3]> {
    let first = part.vertices.start;
    let mut of_part = vec![[0.0; 3]; part.vertices.len()];
    for displacement in &part.targets[target] {
        if let Some(offset) = of_part.get_mut((displacement.vertex - first) as usize) {
            *offset = displacement.offset;
        }
    }
    vertices.iter().map(|&vertex| of_part[(vertex - first) as usize]).collect()
}

/// Joints and weights, four in a set.
fn joints(
    rig: &Rig,
    part: &RigPart,
    vertices: &[u32],
    data: &mut BinaryData,
) -> Vec<(String, usize)> {
    if part.skin == NONE {
        return Vec::new();
    }
    let influences = |&vertex: &u32| rig.influences_of(vertex);
    let most = vertices.iter().map(|vertex| influences(vertex).len()).max().unwrap_or_default();
    let mut attributes = Vec::new();
    for set in 0..most.div_ceil(4) {
        let own = |vertex: &u32| four(influences(vertex).get(4 * set..).unwrap_or_default());
        let joint = |influence: Influence| u16::try_from(influence.joint).unwrap_or(u16::MAX);
        let joints = vertices.iter().map(|vertex| own(vertex).map(joint).map(u16::to_le_bytes));
        let joints = joints.map(|bytes| -> [u8; 8] { bytemuck::cast(bytes) });
        attributes.push((format!("JOINTS_{set}"), data.push(ElementType::JOINTS, joints)));
        let weights = |vertex| own(vertex).map(|influence| influence.weight.to_le_bytes());
        let weights = vertices.iter().map(weights);
        let weights = weights.map(|bytes| -> [u8; 16] { bytemuck::cast(bytes) });
        attributes.push((format!("WEIGHTS_{set}"), data.push(ElementType::WEIGHTS, weights)));
    }
    attributes
}

/// The first four influences, filled up with weights of zero.
fn four(influences: &[Influence]) -> [Influence; 4] {
    let none = Influence { joint: 0, weight: 0.0 };
    [0, 1, 2, 3].map(|at| influences.get(at).copied().unwrap_or(none))
}

/// The nodes and skins of a document.
pub(super) struct RigLists {
    pub(super) nodes: Vec<Value>,
    pub(super) skins: Vec<Value>,
    /// The nodes without a parent.
    pub(super) roots: Vec<usize>,
}

impl RigLists {
    /// The lists for `rig`; `meshes` has the mesh of each of its parts that is drawn.
    pub(super) fn new(rig: &Rig, meshes: &[Option<usize>], data: &mut BinaryData) -> Self {
        let mut nodes: Vec<Value> =
            rig.nodes.iter().map(|node| transform(&node.transform)).collect();
        let mut children = vec![Vec::new(); nodes.len()];
        let mut roots = Vec::new();
        for (at, node) in rig.nodes.iter().enumerate() {
            match children.get_mut(node.parent as usize) {
                Some(siblings) => siblings.push(at),
                None => roots.push(at),
            }
        }
        let (skins, skin_numbers) = skins(rig, meshes, data);
        for (part, mesh) in rig.parts.iter().zip(meshes) {
            let Some(mesh) = mesh else { continue };
            let node = part.node as usize;
            let at = match nodes[node].get("mesh") {
                None => node,
                Some(_) => {
                    nodes.push(json!({}));
                    children[node].push(nodes.len() - 1);
                    nodes.len() - 1
                }
            };
            nodes[at]["mesh"] = (*mesh).into();
            if let Some(Some(skin)) = skin_numbers.get(part.skin as usize) {
                nodes[at]["skin"] = (*skin).into();
            }
        }
        for (node, children) in nodes.iter_mut().zip(children) {
            if !children.is_empty() {
                node["children"] = children.into();
            }
        }
        Self { nodes, skins, roots }
    }
}

/// The transform of a node as its members.
fn transform(transform: &NodeTransform) -> Value {
    match *transform {
        NodeTransform::Matrix(matrix) => {
            json!({"matrix": DMat4::from(matrix).to_cols_array()})
        }
        NodeTransform::Parts { translation, rotation, scale } => json!({
            "translation": translation.to_array(),
            "rotation": rotation.to_array(),
            "scale": scale.to_array()
        }),
    }
}

/// The skins of the parts that are drawn, and for each skin of the rig its number among them.
fn skins(
    rig: &Rig,
    meshes: &[Option<usize>],
    data: &mut BinaryData,
) -> (Vec<Value>, Vec<Option<usize>>) {
    let mut numbers = vec![None; rig.skins.len()];
    let mut skins = Vec::new();
    let drawn = rig.parts.iter().zip(meshes).filter(|(_, mesh)| mesh.is_some());
    for (part, _) in drawn {
        let Some(number) = numbers.get_mut(part.skin as usize) else { continue };
        if number.is_some() {
            continue;
        }
        *number = Some(skins.len());
        let skin = &rig.skins[part.skin as usize];
        let binds = skin.inverse_binds.iter().map(matrix_bytes);
        skins.push(json!({
            "joints": skin.joints,
            "inverseBindMatrices": data.push(ElementType::MATRICES, binds)
        }));
    }
    (skins, numbers)
}

fn matrix_bytes(matrix: &DAffine3) -> [u8; 64] {
    let columns = DMat4::from(*matrix).as_mat4().to_cols_array();
    bytemuck::cast(columns.map(f32::to_le_bytes))
}
