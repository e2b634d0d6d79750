//! Compares stroke textures: each brush in each parameterization along camera paths,
//! measured.
//!
//! The paper compares its two parameterizations in words (section 4): in object space the
//! brush sticks to the surface and breaks at every edge; in screen space it is whole in a
//! still picture and slides when the view moves. Here both are measured beside linked
//! strokes, on the same lines, frame by frame.
//!
//! ```text
//! model, brush, path --frames--> lines with u in each parameterization (samples)
//!     samples of a frame and of the frame before --> sums (measure) --> CSV, page
//! ```

pub(crate) mod measure;
pub(crate) mod page;
pub(crate) mod samples;

use std::f64::consts::TAU;

use edgemesh::edge_mesh::Bounds;
use edgemesh::view::Camera;
use glam::DQuat;

/// How a brush is mapped along strokes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Way {
    /// The paper's, along each edge from a random start.
    ObjectSpace,
    /// The paper's, by position on the screen.
    ScreenSpace,
    /// By arc length along linked strokes.
    Chained,
}

impl Way {
    /// All three.
    pub(crate) const ALL: [Self; 3] = [Self::ObjectSpace, Self::ScreenSpace, Self::Chained];

    /// The name in tables.
    #[must_use]
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::ObjectSpace => "object-space",
            Self::ScreenSpace => "screen-space",
            Self::Chained => "chained",
        }
    }

    /// The settings that select it in a technique.
    #[must_use]
    pub(crate) const fn settings(self) -> &'static [&'static str] {
        match self {
            Self::ObjectSpace => &["strokes.parameterization=object"],
            Self::ScreenSpace => &["strokes.parameterization=screen"],
            Self::Chained => &["strokes.linked=true"],
        }
    }
}

/// How the camera moves from frame to frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum CameraPath {
    /// One degree around the model.
    Turntable,
    /// Sideways, by half a percent of the distance.
    Pan,
    /// One percent of the distance toward the model.
    Dolly,
    /// One percent less field of view.
    Zoom,
    /// One degree around the line of sight.
    Roll,
}

impl CameraPath {
    /// All paths.
    pub(crate) const ALL: [Self; 5] =
        [Self::Turntable, Self::Pan, Self::Dolly, Self::Zoom, Self::Roll];

    /// The name in tables.
    #[must_use]
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Turntable => "turntable",
            Self::Pan => "pan",
            Self::Dolly => "dolly",
            Self::Zoom => "zoom",
            Self::Roll => "roll",
        }
    }

    /// The camera of a frame; frame 0 is the default view.
    #[must_use]
    pub(crate) fn camera(self, bounds: &Bounds, frame: u32) -> Camera {
        let start = Camera::default_view(bounds);
        let frame = f64::from(frame);
        let sight = start.target - start.eye;
        let turn = |axis: glam::DVec3| DQuat::from_axis_angle(axis, TAU / 360.0 * frame);
        match self {
            Self::Turntable => {
                let eye = start.target - turn(start.up) * sight;
                Camera { eye, ..start }
            }
            Self::Pan => {
                let right = sight.cross(start.up).normalize_or_zero();
                let moved = right * sight.length() * 0.005 * frame;
                Camera { eye: start.eye + moved, target: start.target + moved, ..start }
            }
            Self::Dolly => Camera { eye: start.target - sight * 0.99_f64.powf(frame), ..start },
            Self::Zoom => Camera { fov_y_rad: start.fov_y_rad * 0.99_f64.powf(frame), ..start },
            Self::Roll => {
                let axis = sight.normalize_or_zero();
                Camera { up: turn(axis) * start.up, ..start }
            }
        }
    }
}
