//! Meshes in several places, as nodes that share a mesh.
//!
//! Rejected: `EXT_mesh_gpu_instancing`, without which a program shows one place alone.

use glam::{DMat3, DMat4, DQuat};
use serde_json::{Value, json};

/// The node of a mesh in one place.
pub(super) fn placed_node(place: &DMat4, name: &str, mesh: usize) -> Value {
    let mut node = json!({"mesh": mesh, "name": name});
    if *place == DMat4::IDENTITY {
        return node;
    }
    let linear = DMat3::from_mat4(*place);
    // The scale is the same along all axes; a mirror is a negative one.
    let volume = linear.determinant();
    let scale = volume.abs().cbrt().copysign(volume);
    let turn = DQuat::from_mat3(&(linear * scale.recip())).normalize();
    node["translation"] = json!(place.w_axis.truncate().to_array());
    node["rotation"] = json!(turn.to_array());
    // Rounding alone is no scale.
    if (scale - 1.0).abs() > 1e-12 {
        node["scale"] = json!([scale, scale, scale]);
    }
    node
}

/// Adds `first` to the material of each primitive of a mesh.
pub(super) fn shift_materials(mesh: &mut Value, first: usize) {
    let primitives = mesh["primitives"].as_array_mut();
    for primitive in primitives.into_iter().flatten() {
        if let Some(material) = primitive.get("material").and_then(Value::as_u64) {
            primitive["material"] = json!(material + first as u64);
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    #[test]
    fn places_are_turns_moves_and_even_scales() {
        let turn = DQuat::from_rotation_y(0.7);
        let at = DVec3::new(1.0, 2.0, 3.0);
        for scale in [1.0, 2.5, -0.5] {
            let place = DMat4::from_scale_rotation_translation(DVec3::splat(scale), turn, at);
            let node = placed_node(&place, "n", 4);
            let numbers = |key: &str| -> Option<Vec<f64>> {
                Some(node.get(key)?.as_array()?.iter().filter_map(Value::as_f64).collect())
            };
            let again = DMat4::from_scale_rotation_translation(
                numbers("scale").map_or(DVec3::ONE, |s| DVec3::from_slice(&s)),
                DQuat::from_slice(&numbers("rotation").unwrap()),
                DVec3::from_slice(&numbers("translation").unwrap()),
            );
            assert!(again.abs_diff_eq(place, 1e-12), "{node}");
        }
        let first = json!({"mesh": 4, "name": "n"});
        assert_eq!(placed_node(&DMat4::IDENTITY, "n", 4), first);
    }

    #[test]
    fn materials_follow_those_of_other_meshes() {
        let mut mesh = json!({"primitives": [{"mode": 4, "material": 1}, {"mode": 1}]});
        shift_materials(&mut mesh, 3);
        assert_eq!(mesh, json!({"primitives": [{"mode": 4, "material": 4}, {"mode": 1}]}));
    }
}
