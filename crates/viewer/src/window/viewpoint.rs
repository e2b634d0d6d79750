//! The camera of the window, in units of the files, so that a copied command has exactly the
//! numbers that the window draws with.

use edgemesh::edge_mesh::{Bounds, MeshFrame};
use edgemesh::view::{
    Camera, CameraError, DEFAULT_DIRECTION, DEFAULT_DISTANCE_RADII, DEFAULT_FOV_Y_DEG,
};
use glam::DVec3;

use crate::arguments::{CameraArguments, read_camera};
use crate::error::Error;

/// Position and direction of the eye, in units of the files.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Viewpoint {
    /// Position of the eye.
    pub eye: DVec3,
    /// The point looked at, around which the eye turns.
    pub(crate) target: DVec3,
    /// The direction that points up in the picture, perpendicular to the line of sight.
    pub(crate) up: DVec3,
    /// Vertical field of view in degrees.
    pub(crate) fov_y_deg: f64,
    /// Whether the projection is orthographic.
    pub is_orthographic: bool,
}

/// The up axis of the models.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub enum UpAxis {
    /// +Y, as in most pictures and games.
    #[default]
    Y,
    /// +Z, as in most technical drawings.
    Z,
}

impl UpAxis {
    /// The axis as a unit vector.
    #[must_use]
    pub(crate) const fn direction(self) -> DVec3 {
        match self {
            Self::Y => DVec3::Y,
            Self::Z => DVec3::Z,
        }
    }

    /// Turns a direction from a model whose up axis is +Y to one with this axis.
    fn turned(self, with_y_up: DVec3) -> DVec3 {
        match self {
            Self::Y => with_y_up,
            // Front (+Z) becomes -Y, the convention of technical drawing.
            Self::Z => DVec3::new(with_y_up.x, -with_y_up.z, with_y_up.y),
        }
    }
}

/// A view with a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NamedView {
    /// From +Z if +Y is up, from -Y if +Z is.
    Front,
    /// From the side opposite to the front.
    Back,
    /// From -X.
    Left,
    /// From +X.
    Right,
    /// From above.
    Top,
    /// From below.
    Bottom,
    /// From (1, 1, 1), which shortens all axes equally.
    Isometric,
}

impl NamedView {
    /// All named views.
    pub(crate) const ALL: [Self; 7] = [
        Self::Front,
        Self::Back,
        Self::Left,
        Self::Right,
        Self::Top,
        Self::Bottom,
        Self::Isometric,
    ];

    /// The name in menus.
    #[must_use]
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Front => "Front",
            Self::Back => "Back",
            Self::Left => "Left",
            Self::Right => "Right",
            Self::Top => "Top",
            Self::Bottom => "Bottom",
            Self::Isometric => "Isometric",
        }
    }

    /// Direction from the target to the eye, and the up direction, in a model whose up axis
    /// is +Y.
    const fn directions(self) -> (DVec3, DVec3) {
        match self {
            Self::Front => (DVec3::Z, DVec3::Y),
            Self::Back => (DVec3::NEG_Z, DVec3::Y),
            Self::Left => (DVec3::NEG_X, DVec3::Y),
            Self::Right => (DVec3::X, DVec3::Y),
            Self::Top => (DVec3::Y, DVec3::NEG_Z),
            Self::Bottom => (DVec3::NEG_Y, DVec3::Z),
            Self::Isometric => (DVec3::ONE, DVec3::Y),
        }
    }
}

impl Viewpoint {
    /// The view that all commands use by default.
    #[must_use]
    pub(crate) fn default_view(bounds: &Bounds, frame: &MeshFrame, up: UpAxis) -> Self {
        let first = Self {
            eye: up.turned(DEFAULT_DIRECTION),
            target: DVec3::ZERO,
            up: up.direction(),
            fov_y_deg: DEFAULT_FOV_Y_DEG,
            is_orthographic: false,
        };
        first.fitted(bounds, frame)
    }

    /// The camera with the same view of a scene in `frame`.
    #[must_use]
    pub fn camera(&self, frame: &MeshFrame) -> Camera {
        Camera {
            eye: frame.to_mesh(self.eye),
            target: frame.to_mesh(self.target),
            up: self.up,
            fov_y_rad: self.fov_y_deg.to_radians(),
            is_orthographic: self.is_orthographic,
        }
    }

    /// The viewpoint of a camera of a scene in `frame`; `fov_y_deg` replaces its field of
    /// view.
    #[must_use]
    pub(crate) fn of_camera(camera: &Camera, frame: &MeshFrame, fov_y_deg: Option<f64>) -> Self {
        Self {
            eye: frame.to_file(camera.eye),
            target: frame.to_file(camera.target),
            up: camera.up,
            fov_y_deg: fov_y_deg.unwrap_or(DEFAULT_FOV_Y_DEG),
            is_orthographic: camera.is_orthographic,
        }
    }

    /// The unit vector from the eye to the target.
    #[must_use]
    pub fn forward(&self) -> DVec3 {
        (self.target - self.eye).try_normalize().unwrap_or(DVec3::NEG_Z)
    }

    /// Right, up and toward the viewer, as orthogonal unit vectors.
    #[must_use]
    pub(crate) fn axes(&self) -> [DVec3; 3] {
        let back = -self.forward();
        let right = self.up.cross(back).try_normalize();
        let right = right.unwrap_or_else(|| back.any_orthonormal_vector());
        [right, back.cross(right), back]
    }

    /// Distance from the eye to the target.
    #[must_use]
    pub(crate) fn distance(&self) -> f64 {
        self.eye.distance(self.target)
    }

    /// The same direction of sight, from where the whole scene is visible.
    #[must_use]
    pub(crate) fn fitted(&self, bounds: &Bounds, frame: &MeshFrame) -> Self {
        let radius = bounds.radius() / frame.scale;
        let radius = if radius > 0.0 { radius } else { 1.0 / frame.scale };
        // At the distance of the default view, scaled for the field of view.
        let half = |degrees: f64| (degrees.to_radians() / 2.0).tan();
        let distance =
            DEFAULT_DISTANCE_RADII * radius * half(DEFAULT_FOV_Y_DEG) / half(self.fov_y_deg);
        let target = frame.to_file(bounds.center());
        Self { eye: target - self.forward() * distance, target, ..*self }
    }

    /// The same target and distance, seen from a side.
    #[must_use]
    pub fn from_side(&self, view: NamedView, up: UpAxis) -> Self {
        let (from, above) = view.directions();
        let eye = self.target + up.turned(from.normalize_or_zero()) * self.distance();
        Self { eye, up: up.turned(above), ..*self }
    }

    /// The camera options of a command line.
    pub(crate) const fn arguments(&self) -> CameraArguments {
        CameraArguments {
            eye: Some(self.eye),
            target: Some(self.target),
            up: Some(self.up),
            fov: Some(self.fov_y_deg),
            ortho: self.is_orthographic,
        }
    }

    /// Reads the camera options in a text, such as a copied command; other words are ignored.
    /// Options that the text does not name stay.
    ///
    /// # Errors
    /// [`Error::CommandLine`], if there are none or one is wrong; [`Error::Camera`], if the
    /// camera sees nothing.
    pub(crate) fn pasted(&self, text: &str) -> Result<Self, Error> {
        let read = read_camera(text)?;
        let pasted = Self {
            eye: read.eye.unwrap_or(self.eye),
            target: read.target.unwrap_or(self.target),
            up: read.up.unwrap_or(self.up),
            fov_y_deg: read.fov.unwrap_or(self.fov_y_deg),
            is_orthographic: read.ortho,
        };
        let sight = pasted.target - pasted.eye;
        if sight == DVec3::ZERO {
            return Err(CameraError::EyeOnTarget.into());
        }
        if sight.cross(pasted.up).length() <= 0.0 {
            return Err(CameraError::UpAlongSight.into());
        }
        Ok(pasted)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arguments::camera_words;

    const BOUNDS: Bounds = Bounds { min: [-1.0, -2.0, -3.0], max: [3.0, 2.0, 1.0] };

    #[test]
    fn the_default_view_is_that_of_the_commands() {
        let frame = MeshFrame { origin: DVec3::new(1000.0, 5.0, -7.0), scale: 0.25 };
        let view = Viewpoint::default_view(&BOUNDS, &frame, UpAxis::Y);
        let (ours, theirs) = (view.camera(&frame), Camera::default_view(&BOUNDS));
        assert!(ours.eye.distance(theirs.eye) < 1e-9 && ours.target.distance(theirs.target) < 1e-9);
        assert_eq!((ours.up, ours.is_orthographic), (theirs.up, false));
    }

    #[test]
    fn what_is_copied_is_pasted_to_the_last_digit() {
        let first = Viewpoint::default_view(&BOUNDS, &MeshFrame::default(), UpAxis::Y);
        let copied = Viewpoint {
            eye: DVec3::new(0.1 + 0.2, -1.0 / 3.0, 1e-17),
            fov_y_deg: 33.3,
            is_orthographic: true,
            ..first
        };
        let text = format!(
            "viewer render 'a b.obj' {} -o out.png",
            camera_words(&copied.arguments()).join(" ")
        );
        assert_eq!(first.pasted(&text).unwrap(), copied);
        assert_eq!(first.pasted("--fov=20").unwrap().fov_y_deg.to_bits(), 20_f64.to_bits());
        for wrong in ["", "viewer render a.obj", "--eye 1,2", "--eye 0,0,1 --target 0,0,1"] {
            assert!(first.pasted(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn named_views_look_along_the_axes_whichever_is_up() {
        let view = Viewpoint::default_view(&BOUNDS, &MeshFrame::default(), UpAxis::Y);
        for up in [UpAxis::Y, UpAxis::Z] {
            for named in NamedView::ALL {
                let seen = view.from_side(named, up);
                assert!((seen.distance() - view.distance()).abs() < 1e-9);
                let [right, above, _] = seen.axes();
                assert!(right.dot(seen.forward()).abs() < 1e-12);
                assert!(above.dot(seen.up) > 0.5, "{named:?} {up:?}");
            }
        }
        let forward = |named, up| view.from_side(named, up).forward();
        assert!(forward(NamedView::Front, UpAxis::Z).distance(DVec3::Y) < 1e-12);
        assert!(forward(NamedView::Top, UpAxis::Z).distance(DVec3::NEG_Z) < 1e-12);
        assert!(forward(NamedView::Right, UpAxis::Y).distance(DVec3::NEG_X) < 1e-12);
    }
}
