//! Drags and keys to viewpoints.
//!
//! Plain geometry: drags are in pixels, viewpoints in units of the files. Turning follows the
//! pointer; panning and zooming keep the point under the pointer in place.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DQuat, DVec2, DVec3};

use super::viewpoint::{UpAxis, Viewpoint};

/// How a drag turns the eye.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub enum TurnMode {
    /// Around the up axis, and not over the poles, so that the horizon stays level.
    #[default]
    Turntable,
    /// Around any axis.
    Trackball,
}

/// The smallest angle between a turntable's line of sight and its axis, in radians.
const POLE_RAD: f64 = 1e-3;

/// The area of the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Canvas {
    /// Width and height in pixels.
    pub size: DVec2,
}

impl Canvas {
    /// A position relative to the center, right and up, in half heights.
    fn offset_from_middle(&self, position: DVec2) -> DVec2 {
        let half = self.size / 2.0;
        DVec2::new(position.x - half.x, half.y - position.y) / half.y
    }

    /// The point under a pixel (from the upper left) on the plane through the target across
    /// the line of sight.
    #[must_use]
    pub fn point_on_target_plane(&self, view: &Viewpoint, position: DVec2) -> DVec3 {
        let [right, up, _] = view.axes();
        let at = self.offset_from_middle(position) * half_height(view);
        view.target + right * at.x + up * at.y
    }

    /// The pixel (from the upper left) of a point; `None` behind the eye.
    #[must_use]
    pub(crate) fn pixel_of(&self, view: &Viewpoint, point: DVec3) -> Option<DVec2> {
        let [right, up, back] = view.axes();
        let from_eye = point - view.eye;
        let depth = if view.is_orthographic { view.distance() } else { -from_eye.dot(back) };
        let half = self.size / 2.0;
        let scale = half.y / (depth * (view.fov_y_deg.to_radians() / 2.0).tan());
        let at = DVec2::new(from_eye.dot(right), -from_eye.dot(up)) * scale;
        (depth > 0.0 && at.is_finite()).then_some(half + at)
    }

    /// The ray under a pixel: its start and direction.
    #[must_use]
    pub(crate) fn ray(&self, view: &Viewpoint, position: DVec2) -> (DVec3, DVec3) {
        let point = self.point_on_target_plane(view, position);
        if view.is_orthographic {
            // From far enough back that the whole model lies in front of it.
            let forward = view.forward();
            (point - forward * view.distance(), forward)
        } else {
            (view.eye, (point - view.eye).normalize_or(view.forward()))
        }
    }
}

/// Half of the visible height at the target.
fn half_height(view: &Viewpoint) -> f64 {
    view.distance() * (view.fov_y_deg.to_radians() / 2.0).tan()
}

/// Turns the eye around the target for a drag by `pixels` (right and down): half a turn over
/// the height of the canvas.
#[must_use]
pub fn turned(
    view: &Viewpoint,
    mode: TurnMode,
    up: UpAxis,
    canvas: Canvas,
    pixels: DVec2,
) -> Viewpoint {
    let angle = pixels * (PI / canvas.size.y);
    let [right, above, _] = view.axes();
    let rotation = match mode {
        TurnMode::Trackball => {
            DQuat::from_axis_angle(above, -angle.x) * DQuat::from_axis_angle(right, -angle.y)
        }
        TurnMode::Turntable => {
            let axis = up.direction();
            // In a view that is upside down, a drag to the right still turns to the right.
            let sign = if above.dot(axis) < 0.0 { -1.0 } else { 1.0 };
            let elevation = (-view.forward()).dot(axis).clamp(-1.0, 1.0).asin();
            let most = FRAC_PI_2 - POLE_RAD;
            let wanted = elevation + sign * angle.y;
            // A view at the pole, such as the top view, may leave it.
            let tilt = wanted.clamp(-most, most) - elevation;
            DQuat::from_axis_angle(axis, -sign * angle.x)
                * DQuat::from_axis_angle(right, -sign * tilt)
        }
    };
    let eye = view.target + rotation * (view.eye - view.target);
    Viewpoint { eye, up: (rotation * above).normalize_or(view.up), ..*view }
}

/// Rolls the picture counterclockwise by an angle in radians.
#[must_use]
pub(crate) fn rolled(view: &Viewpoint, angle_rad: f64) -> Viewpoint {
    let [_, above, back] = view.axes();
    Viewpoint { up: DQuat::from_axis_angle(back, -angle_rad) * above, ..*view }
}

/// Moves eye and target so that the target follows a drag by `pixels`.
#[must_use]
pub fn panned(view: &Viewpoint, canvas: Canvas, pixels: DVec2) -> Viewpoint {
    let [right, above, _] = view.axes();
    let unit = 2.0 * half_height(view) / canvas.size.y;
    let by = -right * (pixels.x * unit) + above * (pixels.y * unit);
    Viewpoint { eye: view.eye + by, target: view.target + by, ..*view }
}

/// Scales the distance by `factor`; the point `toward` stays in place in the picture.
#[must_use]
pub fn zoomed(view: &Viewpoint, factor: f64, toward: DVec3) -> Viewpoint {
    let moved = |point: DVec3| toward + (point - toward) * factor;
    Viewpoint { eye: moved(view.eye), target: moved(view.target), ..*view }
}

/// Makes a point the target, seen from the same direction and distance.
#[must_use]
pub(crate) fn focused(view: &Viewpoint, point: DVec3) -> Viewpoint {
    let by = point - view.target;
    Viewpoint { eye: view.eye + by, target: point, ..*view }
}

/// Moves to the right, up and forward, in distances to the target.
#[must_use]
pub(crate) fn flown(view: &Viewpoint, steps: DVec3) -> Viewpoint {
    let [right, above, back] = view.axes();
    let by = (right * steps.x + above * steps.y - back * steps.z) * view.distance();
    Viewpoint { eye: view.eye + by, target: view.target + by, ..*view }
}

/// Turns the line of sight around the eye.
#[must_use]
pub(crate) fn looked_around(
    view: &Viewpoint,
    up: UpAxis,
    canvas: Canvas,
    pixels: DVec2,
) -> Viewpoint {
    // The target turns around the eye as the eye would around the target.
    let turned = turned(view, TurnMode::Turntable, up, canvas, pixels);
    let by = view.eye - turned.eye;
    Viewpoint { eye: view.eye, target: turned.target + by, ..turned }
}

/// A view between two, at `share` from 0 to 1. The eye goes around the model, not through it.
#[must_use]
pub(crate) fn between(from: &Viewpoint, to: &Viewpoint, share: f64) -> Viewpoint {
    if share >= 1.0 {
        return *to;
    }
    let rotation = |view: &Viewpoint| {
        let [x, y, z] = view.axes();
        DQuat::from_mat3(&glam::DMat3::from_cols(x, y, z)).normalize()
    };
    let turned = rotation(from).slerp(rotation(to), share);
    let target = from.target.lerp(to.target, share);
    // Distances are interpolated geometrically.
    let distance = from.distance() * (to.distance() / from.distance()).powf(share);
    Viewpoint {
        eye: target + turned * DVec3::Z * distance,
        target,
        up: turned * DVec3::Y,
        fov_y_deg: from.fov_y_deg + (to.fov_y_deg - from.fov_y_deg) * share,
        is_orthographic: to.is_orthographic,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CANVAS: Canvas = Canvas { size: DVec2::new(800.0, 600.0) };

    fn view() -> Viewpoint {
        Viewpoint {
            eye: DVec3::new(3.0, 2.0, 5.0),
            target: DVec3::new(0.5, 0.0, 0.0),
            up: DVec3::Y,
            fov_y_deg: 40.0,
            is_orthographic: false,
        }
    }

    fn pixel_of(view: &Viewpoint, point: DVec3) -> DVec2 {
        CANVAS.pixel_of(view, point).unwrap()
    }

    #[test]
    fn what_is_under_the_pointer_stays_under_it() {
        for is_orthographic in [false, true] {
            let view = Viewpoint { is_orthographic, ..view() };
            let pointer = DVec2::new(650.0, 120.0);
            let point = CANVAS.point_on_target_plane(&view, pointer);
            assert!(pixel_of(&view, point).distance(pointer) < 1e-9);
            let (start, direction) = CANVAS.ray(&view, pointer);
            let along = start + direction * (point - start).dot(direction);
            assert!(along.distance(point) < 1e-9, "the ray goes through it");
            let zoomed = zoomed(&view, 0.4, point);
            assert!(pixel_of(&zoomed, point).distance(pointer) < 1e-6, "zoom");
            assert!((zoomed.distance() - 0.4 * view.distance()).abs() < 1e-9);
            let by = DVec2::new(-33.0, 71.0);
            let panned = panned(&view, CANVAS, by);
            assert!(pixel_of(&panned, point).distance(pointer + by) < 1e-6, "pan");
        }
    }

    #[test]
    fn a_turntable_stays_upright_and_stops_at_the_pole() {
        let start = view();
        let mut at = start;
        for _ in 0..50 {
            at = turned(&at, TurnMode::Turntable, UpAxis::Y, CANVAS, DVec2::new(13.0, 40.0));
            assert!(at.axes()[0].y.abs() < 1e-9, "the horizon is level");
            assert!((at.distance() - start.distance()).abs() < 1e-9);
        }
        assert!(at.forward().y < -0.999, "dragging down looks from above");
        let down = turned(&at, TurnMode::Turntable, UpAxis::Y, CANVAS, DVec2::new(0.0, -300.0));
        assert!(down.forward().y.abs() < 0.1, "and comes back");
        // From the top, too.
        let top = start.from_side(super::super::viewpoint::NamedView::Top, UpAxis::Y);
        let left = turned(&top, TurnMode::Turntable, UpAxis::Y, CANVAS, DVec2::new(0.0, -300.0));
        assert!(left.forward().distance(DVec3::NEG_Z) < 0.1, "to the front");
    }

    #[test]
    fn dragging_right_shows_more_of_the_left_side() {
        for mode in [TurnMode::Turntable, TurnMode::Trackball] {
            let turned = turned(&view(), mode, UpAxis::Y, CANVAS, DVec2::new(50.0, 0.0));
            let [right, ..] = view().axes();
            assert!((turned.eye - view().eye).dot(right) < 0.0, "{mode:?}");
        }
    }

    #[test]
    fn a_trackball_goes_all_the_way_around() {
        let mut at = view();
        for _ in 0..60 {
            at = turned(&at, TurnMode::Trackball, UpAxis::Y, CANVAS, DVec2::new(0.0, 20.0));
        }
        // 1200 pixels over 600 are a whole turn.
        assert!(at.eye.distance(view().eye) < 1e-9);
    }

    #[test]
    fn looking_around_and_flying_move_what_they_should() {
        let around = looked_around(&view(), UpAxis::Y, CANVAS, DVec2::new(40.0, -20.0));
        assert_eq!(around.eye, view().eye);
        assert!((around.distance() - view().distance()).abs() < 1e-9);
        let flown = flown(&view(), DVec3::new(0.0, 0.0, 0.5));
        assert!((flown.eye - view().eye).normalize_or_zero().distance(view().forward()) < 1e-9);
        assert!((flown.distance() - view().distance()).abs() < 1e-9);
    }

    #[test]
    fn views_between_two_begin_and_end_there() {
        let to = rolled(&focused(&view(), DVec3::new(9.0, 1.0, 2.0)), 1.0);
        assert!(between(&view(), &to, 0.0).eye.distance(view().eye) < 1e-9);
        assert_eq!(between(&view(), &to, 1.0), to);
        let half = between(&view(), &to, 0.5);
        assert!((half.distance() - view().distance()).abs() < 1e-9);
    }
}
