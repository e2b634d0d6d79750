//! The light and the cuts moved by hand: from directions in camera space and drags over the
//! picture to light and clip planes.

use glam::{DQuat, DVec2, DVec3};

use super::navigation::Canvas;
use super::viewpoint::Viewpoint;
use crate::scene::lighting::Light;
use crate::scene::models::Scene;

/// The direction to the light in camera space (right, up, toward the viewer), of length 1.
#[must_use]
pub(crate) fn in_camera(light: &Light, view: &Viewpoint, scene: &Scene) -> DVec3 {
    let [right, up, back] = view.axes();
    let of_world = |v: DVec3| DVec3::new(v.dot(right), v.dot(up), v.dot(back));
    let direction = match light {
        Light::Camera(direction) => *direction,
        Light::World(direction) => of_world(*direction),
        Light::Point(point) => of_world(*point - middle(scene)),
    };
    direction.normalize_or(DVec3::Z)
}

/// A direction of camera space in world space.
#[must_use]
pub(crate) fn in_world(in_camera: DVec3, view: &Viewpoint) -> DVec3 {
    let [right, up, back] = view.axes();
    right * in_camera.x + up * in_camera.y + back * in_camera.z
}

/// The light with another direction in camera space. A point light keeps its distance from
/// the center of the scene.
#[must_use]
pub(crate) fn shone_from(
    light: &Light,
    direction: DVec3,
    view: &Viewpoint,
    scene: &Scene,
) -> Light {
    match light {
        Light::Camera(_) => Light::Camera(rounded(direction)),
        Light::World(_) => Light::World(rounded(in_world(direction, view))),
        Light::Point(point) => {
            let distance = (*point - middle(scene)).length();
            Light::Point(rounded(middle(scene) + in_world(direction, view) * distance))
        }
    }
}

/// A point two scene radii from the center of the scene, in a direction of camera space.
#[must_use]
pub(crate) fn point_at(in_camera: DVec3, view: &Viewpoint, scene: &Scene) -> DVec3 {
    rounded(middle(scene) + in_world(in_camera, view) * (2.0 * radius(scene)))
}

/// The light after a drag by `pixels`: it turns around the scene, half a turn over the height
/// of the canvas, and can come behind the scene.
#[must_use]
pub(crate) fn light_dragged(
    light: &Light,
    view: &Viewpoint,
    scene: &Scene,
    canvas: &Canvas,
    pixels: DVec2,
) -> Light {
    let axis = DVec3::new(pixels.y, pixels.x, 0.0);
    let angle = axis.length() / canvas.size.y * std::f64::consts::PI;
    let Some(axis) = axis.try_normalize() else { return *light };
    let direction = DQuat::from_axis_angle(axis, angle) * in_camera(light, view, scene);
    shone_from(light, direction, view, scene)
}

/// A plane (n, d) after a drag by `pixels`: it moves along its normal, as far as the pointer
/// moves along the projected normal. If the normal points at the viewer, up moves it away.
#[must_use]
pub(crate) fn dragged_clip_plane(
    plane: [f64; 4],
    view: &Viewpoint,
    scene: &Scene,
    canvas: &Canvas,
    pixels: DVec2,
) -> [f64; 4] {
    let [x, y, z, d] = plane;
    let normal = DVec3::new(x, y, z);
    let length = normal.length();
    let (middle, radius) = (middle(scene), radius(scene));
    // The point of the plane nearest to the center of the scene.
    let on_plane = middle - normal * ((normal.dot(middle) + d) / (length * length));
    let step = normal / length * (0.01 * radius);
    let seen = |point: DVec3| canvas.pixel_of(view, point);
    let along = seen(on_plane).zip(seen(on_plane + step)).map(|(from, to)| (to - from) * 100.0);
    // The scene's radius in pixels, across the line of sight.
    let across = seen(middle).zip(seen(middle + view.axes()[1] * (0.01 * radius)));
    let radius_px = across.map_or(canvas.size.y, |(from, to)| (to - from).length() * 100.0);
    let moved = match along {
        Some(along) if along.length() > 0.2 * radius_px => {
            pixels.dot(along) / along.length_squared()
        }
        _ => -pixels.y / radius_px * normal.dot(view.forward()).signum(),
    };
    let d = d - moved * radius * length;
    [x, y, z, in_steps(d, step_of(radius * length) / 10.0)]
}

/// A vector with about four significant digits, for short command lines.
#[must_use]
pub(crate) fn rounded(vector: DVec3) -> DVec3 {
    let step = step_of(vector.abs().max_element());
    DVec3::from(vector.to_array().map(|number| in_steps(number, step)))
}

/// The power of ten between a thousandth and a ten-thousandth of a number.
fn step_of(number: f64) -> f64 {
    10_f64.powf(number.max(1e-12).log10().floor() - 3.0)
}

/// The nearest multiple of `step`, a power of ten.
fn in_steps(number: f64, step: f64) -> f64 {
    // Divided, so that the result is the nearest to its short decimal.
    let scale = (1.0 / step).round();
    match scale >= 1.0 {
        true => (number * scale).round() / scale,
        false => (number / step).round() * step,
    }
}

/// The center of the scene, in units of the files.
fn middle(scene: &Scene) -> DVec3 {
    scene.frame.to_file(scene.bounds.center())
}

/// Half the diagonal of the scene's box, in units of the files.
fn radius(scene: &Scene) -> f64 {
    scene.bounds.radius() / scene.frame.scale
}

#[cfg(test)]
mod tests {
    use edgemesh::edge_mesh::Bounds;

    use super::*;
    use crate::window::viewpoint::UpAxis;

    const CANVAS: Canvas = Canvas { size: DVec2::new(800.0, 600.0) };

    fn scene() -> (Scene, Viewpoint) {
        let scene = Scene { bounds: Bounds { min: [-1.0; 3], max: [1.0; 3] }, ..Scene::of(vec![]) };
        let mut view = Viewpoint::default_view(&scene.bounds, &scene.frame, UpAxis::Y);
        (view.eye, view.target) = (DVec3::Z * 10.0, DVec3::ZERO);
        (scene, view)
    }

    #[test]
    fn a_light_follows_the_hand_and_comes_around() {
        let (scene, view) = scene();
        let mut light = Light::Camera(DVec3::Z);
        light = light_dragged(&light, &view, &scene, &CANVAS, DVec2::new(100.0, 0.0));
        let Light::Camera(right) = light else { panic!() };
        assert!(right.x > 0.4 && right.y.abs() < 1e-9, "to the right: {right}");
        light = light_dragged(&light, &view, &scene, &CANVAS, DVec2::new(500.0, 0.0));
        let Light::Camera(behind) = light else { panic!() };
        assert!(behind.z < -0.9, "behind: {behind}");
        let up = Light::Camera(DVec3::Z);
        let up = light_dragged(&up, &view, &scene, &CANVAS, DVec2::new(0.0, -100.0));
        let Light::Camera(up) = up else { panic!() };
        assert!(up.y > 0.4, "up: {up}");
        // A point light keeps its distance.
        let point = Light::Point(DVec3::Z * 4.0);
        let moved = light_dragged(&point, &view, &scene, &CANVAS, DVec2::new(100.0, 40.0));
        let Light::Point(moved) = moved else { panic!() };
        assert!((moved.length() - 4.0).abs() < 0.01 && moved.x > 1.0, "{moved}");
    }

    #[test]
    fn a_cut_stays_under_the_hand() {
        let (scene, view) = scene();
        // The side with x > 0.5 is kept.
        let plane = [2.0, 0.0, 0.0, -1.0];
        let at = |plane: [f64; 4]| {
            let point = DVec3::X * (-plane[3] / plane[0]);
            CANVAS.pixel_of(&view, point).unwrap()
        };
        let moved = dragged_clip_plane(plane, &view, &scene, &CANVAS, DVec2::new(30.0, 17.0));
        assert_eq!(moved[..3], plane[..3]);
        let by = at(moved) - at(plane);
        assert!((by - DVec2::new(30.0, 0.0)).length() < 0.5, "{by}");
        // For a normal toward or away from the viewer, up is away.
        for z in [1.0, -1.0] {
            let plane = [0.0, 0.0, z, 0.0];
            let moved = dragged_clip_plane(plane, &view, &scene, &CANVAS, DVec2::new(0.0, -30.0));
            assert!(-moved[3] / z < -0.05, "{moved:?}");
        }
    }
}
