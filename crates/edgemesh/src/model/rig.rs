//! Rigs: nodes, skins and morph targets, which move the vertices of a model.
//!
//! Based on: glTF 2.0, sections 3.5.2 (transformations) and 3.7 (meshes, skins,
//! morph targets).
//!
//! ```text
//! unposed position --morph targets--> --joints, else the node--> Model::positions
//!                   weights of a part        transforms of nodes
//! ```
//!
//! A rig is data of the file; a [`Pose`] is one moment of it. The positions of the model are those
//! of the rest pose, so a program that does not animate needs no rig.
//!
//! Influences are one flat list with the end of each vertex, not a fixed eight for each vertex:
//! most vertices have one to four joints.

use std::ops::Range;

use glam::{DAffine3, DMat3, DQuat, DVec3};

use crate::index::NONE;

/// The nodes of a file, and the vertices that follow them.
///
/// Methods panic if an index is out of range; rigs from a reader have none.
#[derive(Debug, Clone, Default)]
pub struct Rig {
    /// All nodes, in the order of the file, then instances of nodes, as their children.
    pub nodes: Vec<RigNode>,
    /// Indices into `nodes`, each node after its parent.
    pub node_order: Vec<u32>,
    /// All skins, in the order of the file; unused ones are empty.
    pub skins: Vec<Skin>,
    /// All vertices of the model, in ascending ranges.
    pub parts: Vec<RigPart>,
    /// [`Model::positions`](crate::model::Model::positions) before morph targets, skins and nodes
    /// move them.
    pub positions: Vec<[f64; 3]>,
    /// The end of each vertex in `influences`; empty if no vertex has any.
    pub influence_ends: Vec<u32>,
    /// The joints of each vertex, vertex by vertex.
    pub influences: Vec<Influence>,
}

/// The rig of a mesh that was built from a model.
#[derive(Debug, Clone)]
pub struct MeshRig {
    /// The rig.
    pub rig: Box<Rig>,
    /// The vertices of the model at the corners of each triangle of the mesh.
    pub corners: Vec<[u32; 3]>,
}

/// A node of the hierarchy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigNode {
    /// Index into [`Rig::nodes`], or [`NONE`] for a root.
    pub parent: u32,
    /// The transform at rest.
    pub transform: NodeTransform,
}

/// The transform of a node in its parent.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum NodeTransform {
    /// A matrix, which cannot be animated.
    Matrix(DAffine3),
    /// Scale, then rotation, then translation.
    Parts {
        /// Translation, in units of the file.
        translation: DVec3,
        /// Unit quaternion.
        rotation: DQuat,
        /// Scale of each axis; negative values mirror.
        scale: DVec3,
    },
}

impl NodeTransform {
    /// The transform from the node to its parent.
    #[must_use]
    pub(crate) fn parent_from_node(&self) -> DAffine3 {
        match *self {
            Self::Matrix(matrix) => matrix,
            Self::Parts { translation, rotation, scale } => {
                DAffine3::from_scale_rotation_translation(scale, rotation, translation)
            }
        }
    }
}

/// Joints that bend a mesh.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Skin {
    /// The joints, as indices into [`Rig::nodes`].
    pub joints: Vec<u32>,
    /// For each joint, the transform from the unposed mesh to the joint.
    pub inverse_binds: Vec<DAffine3>,
}

/// Successive vertices with the same node, skin and morph targets.
#[derive(Debug, Clone, PartialEq)]
pub struct RigPart {
    /// The vertices, as indices into [`Model::positions`](crate::model::Model::positions).
    pub vertices: Range<u32>,
    /// Index into [`Rig::nodes`]; the node moves the vertices only if they have no skin.
    pub node: u32,
    /// Index into [`Rig::skins`], or [`NONE`].
    pub skin: u32,
    /// The weight of each of `targets` at rest.
    pub weights: Vec<f32>,
    /// The displacements of each morph target.
    pub targets: Vec<Vec<Displacement>>,
}

/// The displacement of a vertex by a morph target, before skin and node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Displacement {
    /// Index into [`Model::positions`](crate::model::Model::positions).
    pub vertex: u32,
    /// Offset at weight 1, in units of the file.
    pub offset: [f32; 3],
}

/// The influence of a joint on a vertex.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Influence {
    /// Index into [`Skin::joints`] of the skin of the part.
    pub joint: u32,
    /// Weight, 0 to 1; the weights of a vertex sum to 1.
    pub weight: f32,
}

/// The transforms of nodes and joints at one moment.
#[derive(Debug, Clone, Default)]
pub struct Pose {
    /// For each node, the transform to the world.
    pub world_from_node: Vec<DAffine3>,
    /// For each joint of each skin, the transform from the unposed mesh to the world.
    pub world_from_mesh: Vec<Vec<DAffine3>>,
}

impl Rig {
    /// Whether skins or morph targets move any vertex.
    #[must_use]
    pub(crate) fn bends(&self) -> bool {
        self.parts.iter().any(|part| part.skin != NONE || !part.targets.is_empty())
    }

    /// The pose of the file.
    #[must_use]
    pub fn rest_pose(&self) -> Pose {
        self.pose(|node| self.nodes[node].transform)
    }

    /// The pose in which the node with an index has the transform `transform(index)`.
    #[must_use]
    pub fn pose(&self, transform: impl Fn(usize) -> NodeTransform) -> Pose {
        let mut world_from_node = vec![DAffine3::IDENTITY; self.nodes.len()];
        for &node in &self.node_order {
            let node = node as usize;
            let local = transform(node).parent_from_node();
            world_from_node[node] = match self.nodes[node].parent {
                NONE => local,
                parent => world_from_node[parent as usize] * local,
            };
        }
        let joints = |skin: &Skin| -> Vec<DAffine3> {
            let joints = skin.joints.iter().zip(&skin.inverse_binds);
            joints.map(|(&joint, bind)| world_from_node[joint as usize] * *bind).collect()
        };
        let world_from_mesh = self.skins.iter().map(joints).collect();
        Pose { world_from_node, world_from_mesh }
    }

    /// The positions of all vertices in `pose`. `weights(index)` are the weights of the morph
    /// targets of the part with an index; missing ones are 0.
    ///
    /// # Panics
    /// Panics if `pose` is of another rig.
    #[must_use]
    pub fn posed_positions<'a>(
        &self,
        pose: &Pose,
        weights: impl Fn(usize) -> &'a [f32],
    ) -> Vec<[f64; 3]> {
        let mut positions = self.positions.clone();
        for (at, part) in self.parts.iter().enumerate() {
            part.morph(&mut positions, weights(at));
            for vertex in part.vertices.clone() {
                let position = &mut positions[vertex as usize];
                let transform = self.vertex_transform(pose, part, vertex);
                *position = transform.transform_point3(DVec3::from(*position)).to_array();
            }
        }
        positions
    }

    /// The index of the part of a vertex.
    #[must_use]
    pub(crate) fn part_of(&self, vertex: u32) -> usize {
        self.parts.partition_point(|part| part.vertices.end <= vertex)
    }

    /// Whether `pose` mirrors the vertices of `part`; their faces are reversed then. Skinned
    /// vertices are placed by their joints, not by their node.
    #[must_use]
    pub(crate) fn is_mirrored(&self, pose: &Pose, node: usize, skin: u32) -> bool {
        let joints = pose.world_from_mesh.get(skin as usize);
        let transform = match joints {
            Some(joints) => joints.first(),
            None => pose.world_from_node.get(node),
        };
        transform.is_some_and(|transform| transform.matrix3.determinant() < 0.0)
    }

    /// The transform of a vertex of `part` to the world.
    #[must_use]
    pub(crate) fn vertex_transform(&self, pose: &Pose, part: &RigPart, vertex: u32) -> DAffine3 {
        let influences = self.influences_of(vertex);
        if part.skin == NONE || influences.is_empty() {
            return pose.world_from_node[part.node as usize];
        }
        let joints = &pose.world_from_mesh[part.skin as usize];
        let mut linear = DMat3::ZERO;
        let mut translation = DVec3::ZERO;
        for influence in influences {
            let joint = &joints[influence.joint as usize];
            linear += joint.matrix3 * f64::from(influence.weight);
            translation += joint.translation * f64::from(influence.weight);
        }
        DAffine3::from_mat3_translation(linear, translation)
    }

    /// The influences of a vertex.
    #[must_use]
    pub(crate) fn influences_of(&self, vertex: u32) -> &[Influence] {
        let vertex = vertex as usize;
        let Some(&end) = self.influence_ends.get(vertex) else { return &[] };
        let start = vertex.checked_sub(1).map_or(0, |before| self.influence_ends[before]);
        &self.influences[start as usize..end as usize]
    }
}

impl RigPart {
    fn morph(&self, positions: &mut [[f64; 3]], weights: &[f32]) {
        for (target, &weight) in self.targets.iter().zip(weights) {
            if weight == 0.0 {
                continue;
            }
            for displacement in target {
                let position = &mut positions[displacement.vertex as usize];
                for (coordinate, offset) in position.iter_mut().zip(displacement.offset) {
                    *coordinate += f64::from(weight) * f64::from(offset);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moved(x: f64) -> NodeTransform {
        NodeTransform::Matrix(DAffine3::from_translation(DVec3::new(x, 0.0, 0.0)))
    }

    /// Node 1 hangs on node 0; vertices 0 and 1 hang on them by a skin, vertex 2
    /// is placed by node 1.
    fn arm() -> Rig {
        let part = |vertices, node, skin| RigPart {
            vertices,
            node,
            skin,
            weights: vec![0.0],
            targets: vec![vec![Displacement { vertex: 1, offset: [0.0, 2.0, 0.0] }]],
        };
        Rig {
            nodes: vec![
                RigNode { parent: NONE, transform: moved(1.0) },
                RigNode { parent: 0, transform: moved(10.0) },
            ],
            node_order: vec![0, 1],
            skins: vec![Skin { joints: vec![0, 1], inverse_binds: vec![DAffine3::IDENTITY; 2] }],
            parts: vec![
                part(0..2, 1, 0),
                RigPart { weights: vec![], targets: vec![], ..part(2..3, 1, NONE) },
            ],
            positions: vec![[0.0; 3]; 3],
            influence_ends: vec![1, 3, 3],
            influences: vec![
                Influence { joint: 0, weight: 1.0 },
                Influence { joint: 0, weight: 0.5 },
                Influence { joint: 1, weight: 0.5 },
            ],
        }
    }

    #[test]
    fn joints_blend_and_nodes_place() {
        let rig = arm();
        let positions = rig.posed_positions(&rig.rest_pose(), |part| &rig.parts[part].weights);
        assert_eq!(positions, [[1.0, 0.0, 0.0], [6.0, 0.0, 0.0], [11.0, 0.0, 0.0]]);
        assert!(rig.bends());
    }

    #[test]
    fn another_pose_moves_what_hangs_on_it() {
        let rig = arm();
        let pose = rig.pose(|node| moved(if node == 0 { 100.0 } else { 10.0 }));
        let positions = rig.posed_positions(&pose, |_| &[0.25]);
        assert_eq!(positions, [[100.0, 0.0, 0.0], [105.0, 0.5, 0.0], [110.0, 0.0, 0.0]]);
    }

    #[test]
    fn parts_of_a_transform_act_in_order() {
        let transform = NodeTransform::Parts {
            translation: DVec3::new(0.0, 0.0, 5.0),
            rotation: DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2),
            scale: DVec3::new(2.0, 1.0, 1.0),
        };
        let point = transform.parent_from_node().transform_point3(DVec3::X);
        assert!(point.distance(DVec3::new(0.0, 2.0, 5.0)) < 1e-15, "{point}");
    }
}
