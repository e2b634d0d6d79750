//! The camera: the eye, and the matrix from the world to clip space.
//!
//! Depth is reversed, 1 at the near plane and 0 far away: in a 32-bit float buffer this spreads the
//! precision evenly over the distance. In perspective there is no far plane, and the near plane lies
//! at a power of two: another one then scales all depths exactly, so no pixel changes with it.
//! Everything is computed in 64 bits and rounded once.
//!
//! Rejected: a near plane at a fixed part of the scene's radius. One stray triangle far away would
//! put it behind what the picture is of.

use glam::dcamera::rh::proj::directx;
use glam::dcamera::rh::view::look_to_mat4;
use glam::{DVec3, Mat4, Vec4};
use thiserror::Error;

use crate::edge_mesh::Bounds;

/// The default direction from the model to the eye.
pub const DEFAULT_DIRECTION: DVec3 = DVec3::new(1.0, 0.6, 1.2);

/// The default distance of the eye, in bounding radii; the picture then holds the whole bounding
/// sphere.
pub const DEFAULT_DISTANCE_RADII: f64 = 3.0;

/// The default vertical field of view, in degrees.
pub const DEFAULT_FOV_Y_DEG: f64 = 40.0;

/// The least distance of the near plane in bounding radii, if nothing is known of the scene but its
/// bounds. Nearer planes would be lost in the rounding of clipped triangles.
const MIN_NEAR_RADII: f64 = 1.0 / 1_048_576.0;

/// A camera in the units of the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// The eye. An orthographic view uses only its direction and distance from the target.
    pub eye: DVec3,
    /// The point in the middle of the picture.
    pub target: DVec3,
    /// The direction that points up in the picture.
    pub up: DVec3,
    /// Vertical field of view in radians. An orthographic picture is 2 d tan(fov / 2) high, where
    /// d is the distance from the eye to the target.
    pub fov_y_rad: f64,
    /// Whether the projection is orthographic.
    pub is_orthographic: bool,
}

/// A camera has no view.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum CameraError {
    /// The eye and the target are the same point.
    #[error("the eye lies on the target")]
    EyeOnTarget,
    /// The direction up lies along the line of sight.
    #[error("the direction up lies along the line of sight")]
    UpAlongSight,
}

/// A view, as the GPU and the oracle need it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Takes world positions to clip space; depth is 1 at the near plane, and 0 at the far plane or
    /// at infinity.
    pub clip_from_world: Mat4,
    /// The eye with w = 1, or the direction to the viewer with w = 0.
    pub eye: Vec4,
    /// The dot product with a point (w = 1) is its distance from the eye along the direction of
    /// sight.
    pub distance: Vec4,
}

impl View {
    /// The view of a program with another camera: `clip_from_world` with depth 1 at the near plane
    /// and 0 at the far plane or at infinity, and the eye with w = 1 or the direction to the viewer
    /// with w = 0.
    #[must_use]
    pub fn from_matrix(clip_from_world: Mat4, eye: Vec4) -> Self {
        // In perspective, w is a multiple of the distance along the direction of sight.
        let forward = match eye.w {
            0.0 => -eye.truncate(),
            _ => clip_from_world.row(3).truncate(),
        };
        let forward = forward.normalize_or_zero();
        let distance = forward.extend(-forward.dot(eye.truncate()) * eye.w);
        Self { clip_from_world, eye, distance }
    }

    /// The view with the near plane in front of everything at `nearest` or farther along the line
    /// of sight, and no far plane; a parallel view as it is.
    ///
    /// [`SightIndex::nearest`](crate::view::SightIndex::nearest) finds the nearest surface.
    #[must_use]
    pub fn with_nearest(&self, nearest: f64) -> Self {
        if self.eye.w == 0.0 {
            return *self;
        }
        let mut rows = self.clip_from_world.transpose();
        rows.z_axis = Vec4::new(0.0, 0.0, 0.0, near_before(nearest));
        Self { clip_from_world: rows.transpose(), ..*self }
    }
}

/// A power of two at half of `nearest` or before.
fn near_before(nearest: f64) -> f32 {
    let [least, most] = [f32::MIN_EXP - 1, f32::MAX_EXP - 1].map(f64::from);
    let exponent = (nearest / 2.0).log2().floor().clamp(least, most);
    #[expect(clippy::cast_possible_truncation, reason = "a power of two in the range of 32 bits")]
    let near = exponent.exp2() as f32;
    near
}

impl Camera {
    /// The default camera of all commands: from the direction (1, 0.6, 1.2), at 3 bounding radii,
    /// with +Y up and a field of view of 40 degrees.
    #[must_use]
    pub fn default_view(bounds: &Bounds) -> Self {
        let target = bounds.center();
        let distance = DEFAULT_DISTANCE_RADII * usable_radius(bounds);
        Self {
            eye: target + DEFAULT_DIRECTION.normalize_or_zero() * distance,
            target,
            up: DVec3::Y,
            fov_y_rad: DEFAULT_FOV_Y_DEG.to_radians(),
            is_orthographic: false,
        }
    }

    /// The view of a picture `aspect` times as wide as high. A parallel view has near and far planes
    /// around the bounding sphere of `bounds`, one in perspective has a near plane in front of it, or
    /// a millionth of its radius from an eye inside; see [`View::with_nearest`].
    #[must_use]
    pub fn view(&self, bounds: &Bounds, aspect: f64) -> View {
        let radius = usable_radius(bounds);
        let forward = (self.target - self.eye).try_normalize().unwrap_or(DVec3::NEG_Z);
        // Looking along `up` leaves the roll open; any other direction will do.
        let up = match forward.cross(self.up).try_normalize() {
            Some(_) => self.up,
            None => forward.any_orthonormal_vector(),
        };
        let view_from_world = look_to_mat4(self.eye, forward, up);
        let middle = (bounds.center() - self.eye).dot(forward);
        // With a margin, so that rounding does not cut the sphere.
        let near = middle - 1.01 * radius;
        let clip_from_view = if self.is_orthographic {
            let half_height = (self.target - self.eye).length() * (self.fov_y_rad / 2.0).tan();
            let half_width = half_height * aspect;
            // Swapping near and far reverses the depth.
            let far = middle + 1.01 * radius;
            directx::orthographic(-half_width, half_width, -half_height, half_height, far, near)
        } else {
            directx::perspective_infinite_reverse(self.fov_y_rad, aspect, 1.0)
        };
        let view = View {
            clip_from_world: (clip_from_view * view_from_world).as_mat4(),
            eye: self.eye_for_facing(forward),
            distance: forward.extend(-forward.dot(self.eye)).as_vec4(),
        };
        view.with_nearest(near.max(MIN_NEAR_RADII * radius))
    }

    fn eye_for_facing(&self, forward: DVec3) -> Vec4 {
        if self.is_orthographic {
            (-forward).as_vec3().extend(0.0)
        } else {
            self.eye.as_vec3().extend(1.0)
        }
    }
}

/// The bounding radius, or 1 for a model that is a single point.
fn usable_radius(bounds: &Bounds) -> f64 {
    let radius = bounds.radius();
    if radius > 0.0 { radius } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOUNDS: Bounds = Bounds { min: [-1.0, -2.0, -3.0], max: [3.0, 2.0, 1.0] };

    fn depth_and_x(view: &View, point: DVec3) -> (f32, f32) {
        let clip = view.clip_from_world * point.as_vec3().extend(1.0);
        (clip.z / clip.w, clip.x / clip.w)
    }

    #[test]
    fn depth_falls_from_near_to_far_and_the_sphere_fits() {
        let mut camera = Camera::default_view(&BOUNDS);
        for is_orthographic in [false, true] {
            camera.is_orthographic = is_orthographic;
            let view = camera.view(&BOUNDS, 1.0);
            let toward_eye = (camera.eye - camera.target).normalize_or_zero() * BOUNDS.radius();
            let (front, x) = depth_and_x(&view, camera.target + toward_eye);
            let (back, _) = depth_and_x(&view, camera.target - toward_eye);
            assert!(front < 1.0 && front > back && back > 0.0, "{front} {back}");
            assert!(x.abs() < 1e-5, "the target is in the middle");
        }
    }

    #[test]
    fn the_orthographic_height_is_the_perspective_one_at_the_target() {
        let mut camera = Camera::default_view(&BOUNDS);
        let right = (camera.target - camera.eye).cross(camera.up).normalize_or_zero();
        let (_, perspective) = depth_and_x(&camera.view(&BOUNDS, 1.0), camera.target + right);
        camera.is_orthographic = true;
        let (_, orthographic) = depth_and_x(&camera.view(&BOUNDS, 1.0), camera.target + right);
        assert!((perspective - orthographic).abs() < 1e-5);
        assert!(perspective > 0.0, "right is right");
    }

    #[test]
    fn a_nearer_near_plane_scales_all_depths_and_moves_nothing() {
        let view = Camera::default_view(&BOUNDS).view(&BOUNDS, 1.5);
        let (first, second) = (view.with_nearest(3.0), view.with_nearest(3.0 / 1024.0));
        for point in [DVec3::ZERO, DVec3::new(2.0, -1.0, -2.5), DVec3::new(0.3, 1.9, 0.7)] {
            let point = point.as_vec3().extend(1.0);
            let clips = [first, second].map(|view| view.clip_from_world * point);
            assert_eq!(clips[0].truncate().truncate(), clips[1].truncate().truncate());
            assert_eq!(clips[0].z / clips[0].w, 1024.0 * (clips[1].z / clips[1].w));
        }
        assert_eq!(first.clip_from_world.row(2), Vec4::new(0.0, 0.0, 0.0, 1.0));
        let camera = Camera { is_orthographic: true, ..Camera::default_view(&BOUNDS) };
        let parallel = camera.view(&BOUNDS, 1.5);
        assert_eq!(parallel.with_nearest(0.1), parallel);
    }

    #[test]
    fn looking_straight_down_is_a_view_too() {
        let mut camera = Camera::default_view(&BOUNDS);
        camera.eye = camera.target + DVec3::Y * 9.0;
        let view = camera.view(&BOUNDS, 1.5);
        assert!(view.clip_from_world.is_finite());
        camera.eye = camera.target;
        assert!(camera.view(&BOUNDS, 1.5).clip_from_world.is_finite());
    }
}
