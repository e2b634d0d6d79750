//! The point under the pointer: a ray against every triangle of the scene.
//!
//! Brute force on all cores: a million triangles take some ten milliseconds, once a click.
//! Rejected: a tree of boxes, which would be faster but must be built for every model.

use glam::DVec3;
use rayon::prelude::*;

use crate::scene::models::Scene;

/// The first intersection of a ray with the scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Hit {
    /// Index of the object.
    pub(crate) object: usize,
    /// Index of the triangle in the object's mesh.
    pub(crate) triangle: usize,
    /// The point, in units of the files.
    pub(crate) point: DVec3,
    distance: f64,
}

/// The first triangle that a ray meets, from either side. Start and direction are in units of
/// the files.
#[must_use]
pub(crate) fn hit(scene: &Scene, start: DVec3, direction: DVec3) -> Option<Hit> {
    let start = scene.frame.to_mesh(start);
    let hits = scene.objects.iter().enumerate().filter_map(|(at, object)| {
        let mesh = &scene.models[object.model].mesh;
        // The ray is transformed to the mesh, since the mesh has many points.
        let mesh_from_world = object.world_from_object.inverse();
        if !mesh_from_world.is_finite() {
            return None;
        }
        let start = mesh_from_world.transform_point3(start);
        let direction = mesh_from_world.transform_vector3(direction);
        let found = mesh.triangles.par_iter().enumerate().filter_map(|(triangle, corners)| {
            let corners =
                corners.map(|corner| DVec3::from(mesh.positions[corner as usize].map(f64::from)));
            let distance = distance_to(corners, start, direction)?;
            Some((distance, triangle))
        });
        let nearest = found.reduce_with(|one, other| if other.0 < one.0 { other } else { one });
        let (distance, triangle) = nearest?;
        let point = object.world_from_object.transform_point3(start + direction * distance);
        Some(Hit { object: at, triangle, point: scene.frame.to_file(point), distance })
    });
    hits.min_by(|one, other| one.distance.total_cmp(&other.distance))
}

/// The distance along a ray to a triangle (Möller and Trumbore 1997), in lengths of the
/// direction.
fn distance_to([a, b, c]: [DVec3; 3], start: DVec3, direction: DVec3) -> Option<f64> {
    let (ab, ac) = (b - a, c - a);
    let p = direction.cross(ac);
    let determinant = ab.dot(p);
    let from_a = start - a;
    let u = from_a.dot(p) / determinant;
    let q = from_a.cross(ab);
    let v = direction.dot(q) / determinant;
    let distance = ac.dot(q) / determinant;
    // An edge-on triangle gives a division by zero, and no hit.
    let is_inside = u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0;
    (is_inside && distance.is_finite()).then_some(distance)
}

#[cfg(test)]
mod tests {
    use edgemesh::load::{DEMO, LoadOptions, NoProgress};

    use super::*;
    use crate::scene::scene_file::SceneObject;

    #[test]
    fn a_ray_meets_the_nearest_side_of_the_demo() {
        let object = SceneObject::plain(DEMO.as_ref());
        let scene = Scene::load(&[object], &LoadOptions::default(), &NoProgress).unwrap();
        // Toward a vertex of the model, from outside.
        let mesh = &scene.models[0].mesh;
        let [x, y, z] = mesh.positions[0];
        let at = scene.frame.to_file(DVec3::new(x.into(), y.into(), z.into()));
        let [nx, ny, nz] = mesh.vertex_normals[0];
        let normal = DVec3::new(nx.into(), ny.into(), nz.into());
        let start = at + normal * 0.05;
        let hit = hit(&scene, start, -normal).unwrap();
        assert!(hit.point.distance(at) < 0.01, "{hit:?} {at}");
        assert!(mesh.triangles[hit.triangle].contains(&0));
        assert_eq!(super::hit(&scene, start, DVec3::ZERO), None);
        assert_eq!(super::hit(&scene, at + normal * 50.0, normal), None, "it is behind");
    }

    #[test]
    fn a_triangle_from_its_side_is_not_met() {
        let triangle = [DVec3::ZERO, DVec3::X, DVec3::Y];
        assert_eq!(distance_to(triangle, DVec3::new(-1.0, 0.2, 0.0), DVec3::X), None);
        let above = DVec3::new(0.2, 0.2, 2.0);
        assert_eq!(distance_to(triangle, above, DVec3::NEG_Z), Some(2.0));
        assert_eq!(distance_to(triangle, above, DVec3::Z), None);
    }
}
