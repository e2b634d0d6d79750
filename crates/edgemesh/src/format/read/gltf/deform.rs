//! Skins and morph targets, as a [`Rig`].
//!
//! Based on: glTF 2.0, sections 3.7.2.2 (morph targets) and 3.7.3 (skins).

use std::collections::BTreeSet;

use glam::{DAffine3, DMat4};
use gltf_json as json;
use json::mesh::Semantic;

use super::super::error::{ReadError, ReadErrorKind};
use super::asset::Asset;
use super::primitive::Primitive;
use super::scene::{NodeHierarchy, node_transform};
use crate::index::to_u32;
use crate::model::{Displacement, Influence, Rig, RigNode, Skin};
use crate::report::{Report, WarningCode};

/// A rig with all nodes and the skins that nodes use, without vertices.
///
/// # Errors
/// `Syntax` if a skin is malformed, `Bounds` if it has too few matrices, and the
/// errors of its accessor.
pub(super) fn new_rig(asset: &Asset, hierarchy: &NodeHierarchy) -> Result<Rig, ReadError> {
    let nodes = asset.document.nodes.iter();
    let used: BTreeSet<usize> =
        nodes.clone().filter_map(|node| node.skin).map(|skin| skin.value()).collect();
    let skins = (0..asset.document.skins.len()).map(|skin| match used.contains(&skin) {
        true => read_skin(asset, skin),
        false => Ok(Skin::default()),
    });
    let node = |(node, &parent)| RigNode { parent, transform: node_transform(node) };
    Ok(Rig {
        nodes: nodes.zip(&hierarchy.parents).map(node).collect(),
        node_order: hierarchy.order.iter().map(|&node| to_u32(node)).collect(),
        skins: skins.collect::<Result<_, _>>()?,
        ..Rig::default()
    })
}

fn read_skin(asset: &Asset, index: usize) -> Result<Skin, ReadError> {
    let document = asset.document;
    let part = || format!("skins[{index}]");
    let json = asset.get(&document.skins, index, "skins", part)?;
    for joint in &json.joints {
        asset.get(&document.nodes, joint.value(), "nodes", || format!("{}.joints", part()))?;
    }
    let count = json.joints.len();
    let inverse_binds = match json.inverse_bind_matrices {
        None => vec![DAffine3::IDENTITY; count],
        Some(accessor) => {
            let matrices = asset.accessor(accessor.value(), part)?.numbers::<16>()?;
            if matrices.len() < count {
                let what = format!("has {} matrices for {count} joints", matrices.len());
                return Err(asset.error(ReadErrorKind::Bounds, part(), what));
            }
            let matrix = |matrix: &[f32; 16]| {
                DAffine3::from_mat4(DMat4::from_cols_array(&matrix.map(f64::from)))
            };
            matrices.iter().take(count).map(matrix).collect()
        }
    };
    let joints = json.joints.iter().map(|joint| to_u32(joint.value())).collect();
    Ok(Skin { joints, inverse_binds })
}

/// Adds the influences of the next `count` vertices of `rig`, from the joints and
/// weights of a primitive, whose skin has `joint_count` joints. Returns whether the
/// primitive has any.
///
/// # Errors
/// `Index` if the skin does not have a joint, `Syntax` if the counts differ, and the
/// errors of the accessors.
pub(super) fn add_influences(
    rig: &mut Rig,
    primitive: Primitive,
    joint_count: usize,
    count: usize,
    report: &mut Report,
) -> Result<bool, ReadError> {
    let sets = joint_sets(primitive, count)?;
    if sets.is_empty() {
        return Ok(false);
    }
    let Rig { influences, influence_ends, positions, .. } = rig;
    // Vertices without influences have an empty range.
    influence_ends.resize(positions.len(), to_u32(influences.len()));
    for vertex in 0..count {
        let of_vertex = sets.iter().filter_map(|set| set.get(vertex));
        let of_vertex = of_vertex.flat_map(|(joints, weights)| joints.iter().zip(weights));
        let start = influences.len();
        influences.extend(of_vertex.clone().filter_map(influence));
        if influences.len() == start {
            let first = of_vertex.map(|(&joint, _)| joint).next().unwrap_or_default();
            influences.push(Influence { joint: first, weight: 1.0 });
            report.warn(WarningCode::Syntax, primitive.place(), || {
                format!("vertex {vertex} has no weights; it follows its first joint")
            });
        }
        let sum: f32 = influences[start..].iter().map(|influence| influence.weight).sum();
        for Influence { joint, weight } in &mut influences[start..] {
            *weight /= sum;
            if *joint as usize >= joint_count {
                let what = format!("vertex {vertex} names joint {joint}; there are {joint_count}");
                return Err(primitive.error(ReadErrorKind::Index, what));
            }
        }
        influence_ends.push(to_u32(influences.len()));
    }
    Ok(true)
}

/// Four joints and their weights for each vertex.
type JointSet = Vec<([u32; 4], [f32; 4])>;

/// The joint sets of a primitive: none, one or two.
fn joint_sets(primitive: Primitive, count: usize) -> Result<Vec<JointSet>, ReadError> {
    let mut sets = Vec::new();
    for set in 0..2 {
        let joints = primitive.attribute(Semantic::Joints(set))?;
        let weights = primitive.attribute(Semantic::Weights(set))?;
        let (Some(joints), Some(weights)) = (joints, weights) else { break };
        if joints.count() != count || weights.count() != count {
            let (joints, weights) = (joints.count(), weights.count());
            let what = format!("has {joints} joints and {weights} weights for {count} vertices");
            return Err(primitive.error(ReadErrorKind::Syntax, what));
        }
        let weights = weights.normalized().numbers()?;
        sets.push(joints.unsigned()?.into_iter().zip(weights).collect());
    }
    Ok(sets)
}

/// An influence; `None` for a weight of 0, which is padding.
fn influence((&joint, &weight): (&u32, &f32)) -> Option<Influence> {
    (weight > 0.0 && weight.is_finite()).then_some(Influence { joint, weight })
}

/// The displacements of each morph target of a primitive with `count` vertices, of
/// which the first has index `first_vertex`.
///
/// # Errors
/// `Syntax` if the counts differ, and the errors of the accessors.
pub(super) fn morph_targets(
    primitive: Primitive,
    first_vertex: u32,
    count: usize,
) -> Result<Vec<Vec<Displacement>>, ReadError> {
    let read = |(at, target): (usize, &json::mesh::MorphTarget)| {
        let Some(index) = target.positions else { return Ok(Vec::new()) };
        let part = || format!("{}.targets[{at}]", primitive.part());
        let accessor = primitive.asset.accessor(index.value(), part)?;
        if accessor.count() != count {
            let what = format!("moves {} vertices of {count}", accessor.count());
            return Err(primitive.asset.error(ReadErrorKind::Syntax, part(), what));
        }
        let offsets = (first_vertex..).zip(accessor.numbers()?);
        let moved = offsets.filter(|(_, offset)| *offset != [0.0; 3]);
        Ok(moved.map(|(vertex, offset)| Displacement { vertex, offset }).collect())
    };
    primitive.json.targets.iter().flatten().enumerate().map(read).collect()
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::super::sample::{SQUARE, Sample};
    use super::*;
    use crate::index::NONE;
    use crate::model::Model;

    /// A triangle with two joints: node 1 at x = 10, and node 2 above it at y = 1.
    fn skinned(joints: &[[u8; 4]; 3], weights: &[[f32; 4]; 3]) -> (Sample, Value) {
        let mut sample = Sample::default();
        let attributes = json!({
            "POSITION": sample.floats("VEC3", &SQUARE[..3]),
            "JOINTS_0": sample.bytes("VEC4", joints),
            "WEIGHTS_0": sample.floats("VEC4", weights)
        });
        let mut bind = [0.0; 16];
        [bind[0], bind[5], bind[10], bind[15], bind[13]] = [1.0, 1.0, 1.0, 1.0, -1.0];
        let lowered = bind;
        bind[13] = 0.0;
        let binds = sample.floats("MAT4", &[bind, lowered]);
        let rest = json!({
            "nodes": [
                {"mesh": 0, "skin": 0, "translation": [500, 0, 0]},
                {"translation": [10, 0, 0], "children": [2]},
                {"translation": [0, 1, 0], "rotation": [0, 0, 1, 0]}
            ],
            "skins": [{"joints": [1, 2], "inverseBindMatrices": binds}],
            "meshes": [{"primitives": [{"attributes": attributes}]}]
        });
        (sample, rest)
    }

    #[test]
    fn skinned_vertices_follow_their_joints_not_their_node() {
        let joints = [[0, 1, 0, 0], [1, 0, 0, 0], [0, 1, 9, 9]];
        let weights = [[1.0, 0.0, 0.0, 0.0], [2.0, 0.0, 0.0, 0.0], [0.5, 0.5, 0.0, 0.0]];
        let (sample, rest) = skinned(&joints, &weights);
        let (model, report) = sample.read(&rest).unwrap();
        assert!(report.warnings().is_empty(), "{report:?}");
        // Joint 1 turns by half around (10, 1); the last vertex is half of each.
        assert_eq!(model.positions, [[10.0, 0.0, 0.0], [9.0, 2.0, 0.0], [10.0, 1.0, 0.0]]);
        let rig = model.rig.unwrap();
        assert_eq!(rig.positions, SQUARE[..3].iter().map(|p| p.map(f64::from)).collect::<Vec<_>>());
        assert_eq!(rig.influence_ends, [1, 2, 4], "no weight, no influence");
        assert_eq!(rig.influences[1], Influence { joint: 1, weight: 1.0 }, "weights sum to 1");
        assert_eq!((rig.parts[0].skin, rig.parts[0].vertices.clone()), (0, 0..3));
        assert_eq!(rig.skins[0].joints, [1, 2]);
    }

    #[test]
    fn faults_in_skins_are_errors() {
        let sound = [[1.0, 0.0, 0.0, 0.0]; 3];
        let refusal = |(sample, rest): (Sample, Value)| sample.read(&rest).unwrap_err();
        let error = refusal(skinned(&[[0; 4], [0; 4], [2, 0, 0, 0]], &sound));
        assert_eq!(error.kind, ReadErrorKind::Index);
        assert!(error.what.contains("vertex 2 names joint 2; there are 2"), "{error}");
        let (sample, mut rest) = skinned(&[[0; 4]; 3], &sound);
        rest["skins"][0]["joints"] = json!([1, 2, 2]);
        assert_eq!(refusal((sample, rest)).kind, ReadErrorKind::Bounds, "a matrix too few");
        let (sample, mut rest) = skinned(&[[0; 4]; 3], &sound);
        rest["skins"] = json!([rest["skins"][0], {"joints": [77]}]);
        assert!(sample.read(&rest).is_ok(), "a skin that no node uses");
        rest["nodes"][0]["skin"] = 5.into();
        assert_eq!(refusal((sample, rest)).kind, ReadErrorKind::Syntax);
        let (sample, rest) = skinned(&[[1; 4]; 3], &[[0.0; 4]; 3]);
        let (model, report) = sample.read(&rest).unwrap();
        assert_eq!(model.positions[0], [10.0, 2.0, 0.0], "the first joint");
        assert_eq!(report.count(WarningCode::Syntax), 3);
    }

    #[test]
    fn a_node_places_a_skinned_mesh_without_joints() {
        let (sample, mut rest) = skinned(&[[0; 4]; 3], &[[1.0, 0.0, 0.0, 0.0]; 3]);
        let attributes = rest["meshes"][0]["primitives"][0]["attributes"].as_object_mut().unwrap();
        attributes.retain(|name, _| name == "POSITION");
        let (model, report) = sample.read(&rest).unwrap();
        assert_eq!(model.positions[0], [500.0, 0.0, 0.0]);
        assert_eq!(report.count(WarningCode::Syntax), 1);
        assert!(model.rig.is_none());
    }

    fn morphed(mesh: Value, node: Value) -> Result<(Model, Report), ReadError> {
        let mut sample = Sample::default();
        let positions = sample.floats("VEC3", &SQUARE[..3]);
        let up = sample.floats("VEC3", &[[0.0; 3], [0.0, 0.0, 4.0], [0.0; 3]]);
        let short = sample.floats("VEC3", &[[0.0; 3]]);
        let targets = match mesh["short"].as_bool() {
            Some(true) => json!([{"POSITION": short}]),
            _ => json!([{"POSITION": up}, {"NORMAL": up}]),
        };
        let mut rest = json!({"nodes": [node], "meshes": [mesh]});
        rest["meshes"][0]["primitives"] =
            json!([{"attributes": {"POSITION": positions}, "targets": targets}]);
        rest["nodes"][0]["mesh"] = 0.into();
        sample.read(&rest)
    }

    #[test]
    fn morph_targets_move_by_the_rest_weights() {
        let height = |mesh, node| morphed(mesh, node).unwrap().0.positions[1][2];
        assert_eq!(height(json!({}), json!({})), 0.0);
        assert_eq!(height(json!({"weights": [0.5, 1]}), json!({})), 2.0);
        assert_eq!(height(json!({"weights": [0.5, 1]}), json!({"weights": [1, 1]})), 4.0);
        let (model, _) = morphed(json!({"weights": [0.5, 1]}), json!({})).unwrap();
        let rig = model.rig.unwrap();
        assert_eq!(rig.parts[0].weights, [0.5, 1.0]);
        let displaced = Displacement { vertex: 1, offset: [0.0, 0.0, 4.0] };
        assert_eq!(rig.parts[0].targets, [vec![displaced], vec![]]);
        assert_eq!((rig.parts[0].skin, rig.positions[1][2]), (NONE, 0.0));
        assert!(rig.influence_ends.is_empty());
    }

    #[test]
    fn morph_targets_need_all_vertices() {
        let error = morphed(json!({"short": true}), json!({})).unwrap_err();
        assert_eq!(error.kind, ReadErrorKind::Syntax);
        assert!(error.what.contains("1 vertices of 3"), "{error}");
    }
}
