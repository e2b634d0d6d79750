//! The places of a mesh that is read once.
//!
//! Copies of a mesh share their edges if one place can be reached from the other by a turn, a
//! move, a mirror and a scale that is the same along all axes: these keep all angles, so the
//! copies have the same creases. The mesh is read in the first place of such a group, because
//! there its lengths are those of the scene.
//!
//! With linear parts L and M, such a transform from one place to the other exists if
//! transpose(L) L and transpose(M) M are equal up to a factor.

use glam::{DAffine3, DMat3, DMat4};

use crate::model::NodeTransform;

/// Entries of two shapes that differ by less are equal; nodes and instances have 32 bits.
const SHAPE_TOLERANCE: f64 = 1e-5;

/// A transform whose volume is below this part of that of an even scale flattens a mesh.
const LEAST_VOLUME: f64 = 1e-6;

/// A place of a mesh.
#[derive(Debug, Clone, Copy)]
pub(super) struct Placed {
    /// The node that has the mesh.
    pub(super) node: usize,
    /// The instance of the node, if it has any.
    pub(super) instance: Option<NodeTransform>,
    /// The transform from the mesh to the scene.
    pub(super) world: DAffine3,
}

/// Sorts places into groups whose copies have the same angles, in order. A place that flattens the
/// mesh, or is not finite, is alone.
pub(super) fn similar_groups(all: Vec<Placed>) -> Vec<Vec<Placed>> {
    let mut groups: Vec<(Option<DMat3>, Vec<Placed>)> = Vec::new();
    for placed in all {
        let shape = shape(&placed.world);
        let is_same = |(other, _): &&mut (Option<DMat3>, Vec<Placed>)| {
            other.zip(shape).is_some_and(|(a, b)| a.abs_diff_eq(b, SHAPE_TOLERANCE))
        };
        match groups.iter_mut().find(is_same) {
            Some((_, group)) => group.push(placed),
            None => groups.push((shape, vec![placed])),
        }
    }
    groups.into_iter().map(|(_, group)| group).collect()
}

/// What is the same for all transforms that stretch a mesh alike; `None` for one that flattens it.
fn shape(world: &DAffine3) -> Option<DMat3> {
    let linear = world.matrix3;
    let gram = linear.transpose() * linear;
    let even = (gram.x_axis.x + gram.y_axis.y + gram.z_axis.z) / 3.0;
    let is_full = linear.determinant().abs() > LEAST_VOLUME * even.powf(1.5);
    let shape = gram * even.recip();
    (is_full && world.is_finite() && shape.is_finite()).then_some(shape)
}

/// The transforms from the first place of a group to each.
pub(super) fn relative(group: &[Placed]) -> Vec<DMat4> {
    let mesh_from_first = group.first().map_or(DAffine3::IDENTITY, |first| first.world.inverse());
    let mut placements: Vec<DMat4> =
        group.iter().map(|placed| DMat4::from(placed.world * mesh_from_first)).collect();
    if let Some(first) = placements.first_mut() {
        *first = DMat4::IDENTITY;
    }
    placements
}

#[cfg(test)]
mod tests {
    use glam::{DQuat, DVec3};

    use super::*;

    fn placed(scale: DVec3, angle: f64, x: f64) -> Placed {
        let turn = DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), angle);
        let place = DVec3::new(x, 2.0, -1.0);
        let world = DAffine3::from_scale_rotation_translation(scale, turn, place);
        Placed { node: 0, instance: None, world }
    }

    #[test]
    fn places_that_keep_angles_are_one_group() {
        let stretched = DVec3::new(1.0, 3.0, 1.0);
        let groups = similar_groups(vec![
            placed(DVec3::ONE, 0.0, 0.0),
            placed(stretched, 0.3, 1.0),
            placed(DVec3::splat(2.5), 1.0, 2.0),
            placed(DVec3::new(1.0, -1.0, 1.0), 2.0, 3.0),
            placed(stretched * 0.1, -0.3, 4.0),
            placed(DVec3::new(3.0, 1.0, 1.0), 0.0, 5.0),
            placed(DVec3::new(1.0, 1.0, 0.0), 0.0, 6.0),
            placed(DVec3::new(1.0, 1.0, 0.0), 0.0, 7.0),
            placed(DVec3::NAN, 0.0, 8.0),
            placed(DVec3::ZERO, 0.0, 9.0),
        ]);
        let places: Vec<Vec<f64>> = groups
            .iter()
            .map(|group| group.iter().map(|placed| placed.world.translation.x).collect())
            .collect();
        assert_eq!(
            places,
            [&[0., 2., 3.][..], &[1., 4.], &[5.], &[6.], &[7.], &[8.], &[9.]],
            "even scales and mirrors; another stretch; flat and not finite ones alone"
        );
    }

    #[test]
    fn the_first_place_is_where_the_mesh_is() {
        let group = [placed(DVec3::splat(2.0), 0.4, 5.0), placed(DVec3::splat(-4.0), 1.4, 7.0)];
        let [first, second] = relative(&group)[..] else { panic!("two places") };
        assert_eq!(first, DMat4::IDENTITY);
        let corner = DVec3::new(0.3, -0.2, 0.9);
        let [in_first, in_second] = [0, 1].map(|at| group[at].world.transform_point3(corner));
        assert!(second.transform_point3(in_first).distance(in_second) < 1e-12);
    }
}
