//! Instances of a node's mesh.
//!
//! Based on: `EXT_mesh_gpu_instancing`. Each instance is placed by a translation, then a
//! rotation, then a scale in its node, as if it were a child of the node with the same
//! mesh.
//!
//! ```text
//! attributes   TRANSLATION VEC3   ROTATION VEC4   SCALE VEC3   _NAME: ignored
//! ```

use std::collections::BTreeMap;

use glam::{DQuat, DVec3};
use gltf_json as json;
use serde::Deserialize;

use super::super::error::{ReadError, ReadErrorKind};
use super::accessor::Accessor;
use super::asset::Asset;
use crate::model::NodeTransform;

const NAME: &str = "EXT_mesh_gpu_instancing";

/// The members of the extension.
#[derive(Debug, Deserialize)]
struct Instancing {
    /// The accessor of each attribute.
    attributes: BTreeMap<String, usize>,
}

fn instancing(node: &json::Node) -> Option<Result<Instancing, serde_json::Error>> {
    node.extensions.as_ref()?.others.get(NAME).map(Instancing::deserialize)
}

/// The number of times that a node draws its mesh, as the file states it; 1 without
/// the extension, or if it is malformed.
pub(super) fn stated_count(asset: &Asset, node: &json::Node) -> u64 {
    let Some(Ok(Instancing { attributes })) = instancing(node) else { return 1 };
    let accessor = attributes.values().find_map(|&index| asset.document.accessors.get(index));
    accessor.map_or(1, |accessor| accessor.count.0)
}

/// The transforms from the instances of a node to the node; `None` without the extension.
///
/// # Errors
/// Syntax: the extension is malformed, or its accessors differ in length; and the errors
/// of its accessors.
pub(super) fn instances(
    asset: &Asset,
    index: usize,
    node: &json::Node,
) -> Result<Option<Vec<NodeTransform>>, ReadError> {
    let Some(parsed) = instancing(node) else { return Ok(None) };
    let part = || format!("nodes[{index}].extensions.{NAME}");
    let fail = |what: String| asset.error(ReadErrorKind::Syntax, part(), what);
    if node.skin.is_some() {
        return Err(fail("is of no use to a skin, whose joints place the mesh".into()));
    }
    let Instancing { attributes } = parsed.map_err(|error| fail(error.to_string()))?;
    let mut count = None;
    let mut accessor = |name: &str| -> Result<Option<Accessor<'_>>, ReadError> {
        let Some(&index) = attributes.get(name) else { return Ok(None) };
        let accessor = asset.accessor(index, part)?;
        let found = accessor.count();
        match *count.get_or_insert(found) {
            count if count == found => Ok(Some(accessor)),
            count => Err(fail(format!("has {found} of {name} for {count} instances"))),
        }
    };
    let translations = accessor("TRANSLATION")?.map(|found| found.numbers::<3>()).transpose()?;
    // Integers stand for -1 to 1, even if the file does not say so.
    let rotations =
        accessor("ROTATION")?.map(|found| found.normalized().numbers::<4>()).transpose()?;
    let scales = accessor("SCALE")?.map(|found| found.numbers::<3>()).transpose()?;
    let Some(count) = count else {
        return Err(fail("has no TRANSLATION, ROTATION or SCALE".into()));
    };
    let vector = |list: &Option<Vec<[f32; 3]>>, at: usize, default| {
        let found = list.as_ref().and_then(|list| list.get(at));
        found.map_or(default, |vector| DVec3::from_array(vector.map(f64::from)))
    };
    let rotation = |at: usize| {
        let found = rotations.as_ref().and_then(|list| list.get(at));
        let rotation = DQuat::from_array(found?.map(f64::from));
        let length = rotation.length();
        (length > 0.0).then(|| rotation / length)
    };
    let transform = |at| NodeTransform::Parts {
        translation: vector(&translations, at, DVec3::ZERO),
        rotation: rotation(at).unwrap_or(DQuat::IDENTITY),
        scale: vector(&scales, at, DVec3::ONE),
    };
    Ok(Some((0..count).map(transform).collect()))
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::super::sample::{SQUARE, Sample, one_mesh};
    use super::*;
    use crate::model::Model;
    use crate::report::{Place, Report, WarningCode};

    /// A triangle on a node with these members and the attributes that `make` returns.
    fn triangle(node: &Value, make: impl FnOnce(&mut Sample) -> Value) -> (Model, Report) {
        let mut sample = Sample::default();
        let positions = sample.floats("VEC3", &SQUARE[..3]);
        let mut rest = one_mesh(&json!({"attributes": {"POSITION": positions}}));
        let extension = json!({NAME: {"attributes": make(&mut sample)}});
        rest["nodes"][0] = super::super::sample::joined(rest["nodes"][0].take(), node);
        rest["nodes"][0]["extensions"] = extension;
        rest["extensionsUsed"] = json!([NAME]);
        rest["extensionsRequired"] = json!([NAME]);
        sample.read(&rest).unwrap()
    }

    #[test]
    fn instances_are_placed_in_their_node() {
        let node = json!({"translation": [0, 0, 5], "scale": [2, 2, 2], "name": "leaf"});
        let (model, report) = triangle(&node, |sample| {
            let half = 0.5_f32.sqrt();
            json!({
                "TRANSLATION": sample.floats("VEC3", &[[1.0, 0.0, 0.0], [0.0; 3], [0.0; 3]]),
                "ROTATION": sample.floats(
                    "VEC4", &[[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, half, half], [0.0, 0.0, 0.0, 3.0]]
                ),
                "SCALE": sample.floats("VEC3", &[[1.0; 3], [1.0; 3], [-1.0, 1.0, 1.0]]),
                "_COLOR": 99
            })
        });
        assert!(report.warnings().is_empty(), "{report:?}");
        // The corners (0 0), (1 0), (1 1): moved by 1, turned by 90 degrees, mirrored;
        // then doubled and lifted by 5.
        let expected = [
            [[2., 0.], [4., 0.], [4., 2.]],
            [[0., 0.], [0., 2.], [-2., 2.]],
            [[0., 0.], [-2., 0.], [-2., 2.]],
        ];
        for (found, [x, y]) in model.positions.iter().zip(expected.as_flattened()) {
            let distance = DVec3::from_array(*found).distance(DVec3::new(*x, *y, 5.0));
            assert!(distance < 1e-6, "{found:?} {x} {y}");
        }
        assert_eq!(model.corner_positions, [0, 1, 2, 3, 4, 5, 6, 8, 7], "the last is mirrored");
        assert_eq!(model.groups, ["leaf"; 3]);
        assert_eq!(model.per_polygon(|run| run.group), [0, 1, 2]);
    }

    #[test]
    fn rotations_may_be_integers() {
        let (model, _) = triangle(&json!({}), |sample| {
            // 90 degrees around z: 0.7071 of 127 is 89.8, which normalizes.
            let view = sample.view(&[0, 0, 90, 90], &json!({}));
            json!({"ROTATION": sample.accessor(json!({
                "bufferView": view, "componentType": 5120, "count": 1, "type": "VEC4",
                "normalized": true
            }))})
        });
        let [x, y, _] = model.positions[1];
        assert!(x.abs() < 1e-12 && (y - 1.0).abs() < 1e-12, "{x} {y}");
    }

    #[test]
    fn malformed_instances_are_left_out_and_the_mesh_is_drawn_once() {
        let place = Place::Part(format!("nodes[0].extensions.{NAME}"));
        for (make, what) in [
            ((|_: &mut Sample| json!({})) as fn(&mut Sample) -> Value, "has no TRANSLATION"),
            (|_| json!({"TRANSLATION": "all"}), "invalid type"),
            (|_| json!({"TRANSLATION": 9}), "accessors[9]"),
            (
                |sample| {
                    let one = sample.floats("VEC3", &[[0.0; 3]]);
                    json!({"TRANSLATION": one, "SCALE": sample.floats("VEC3", &[[1.0; 3]; 2])})
                },
                "has 2 of SCALE for 1 instances",
            ),
        ] {
            let (model, report) = triangle(&json!({}), make);
            assert_eq!(model.polygon_count(), 1);
            let [warning] = report.warnings() else { panic!("{report:?}") };
            assert_eq!((warning.code, warning.place.as_ref()), (WarningCode::Syntax, Some(&place)));
            assert!(warning.message.contains(what), "{warning:?}");
        }
    }
}
