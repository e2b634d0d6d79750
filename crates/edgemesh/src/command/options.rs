//! Options that both commands know: the camera and the crease thresholds.

use clap::Args;
use glam::DVec3;

use super::Failure;
use crate::build::BuildOptions;
use crate::edge_mesh::{Bounds, MeshFrame};
use crate::view::camera::Camera;

/// Where the eye is. Without any of these it looks at the middle of the model
/// from the direction (1, 0.6, 1.2), at three bounding radii.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Camera")]
pub struct CameraOptions {
    /// The eye, in the units of the model
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    pub eye: Option<DVec3>,
    /// The point to look at [default: the middle of the bounding box]
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    pub target: Option<DVec3>,
    /// The direction that points up in the picture [default: 0,1,0]
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    pub up: Option<DVec3>,
    /// Vertical field of view in degrees [default: 40]
    #[arg(long, value_name = "DEG", value_parser = parse_fov)]
    pub fov: Option<f64>,
    /// Parallel lines of sight; the field of view then gives the picture's height
    #[arg(long)]
    pub ortho: bool,
}

impl CameraOptions {
    /// The camera for a mesh within `bounds`, in the mesh's own units; points of
    /// the command line are in those of its file.
    ///
    /// # Errors
    /// Where the eye lies on the target, or up points along the line of sight.
    pub fn camera(&self, bounds: &Bounds, frame: &MeshFrame) -> Result<Camera, Failure> {
        let mut camera = Camera::default_view(bounds);
        if let Some(target) = self.target.map(|target| frame.to_mesh(target)) {
            camera.eye += target - camera.target;
            camera.target = target;
        }
        if let Some(eye) = self.eye.map(|eye| frame.to_mesh(eye)) {
            camera.eye = eye;
        }
        if camera.eye == camera.target {
            return Err(Failure::usage("--eye and --target are the same point; move one of them"));
        }
        if let Some(up) = self.up {
            if (camera.target - camera.eye).cross(up).length() <= 0.0 {
                return Err(Failure::usage("--up points along the line of sight; give another"));
            }
            camera.up = up;
        }
        if let Some(fov) = self.fov {
            camera.fov_y_rad = fov.to_radians();
        }
        camera.is_orthographic = self.ortho;
        Ok(camera)
    }
}

/// How much the commands say on standard error.
#[derive(Debug, Clone, Copy, Default, Args)]
pub struct MessageOptions {
    /// No warnings
    #[arg(short, long, global = true)]
    pub quiet: bool,
    /// More messages; twice for still more
    #[arg(short, long, global = true, action = clap::ArgAction::Count)]
    pub verbose: u8,
}

impl MessageOptions {
    /// Sets up log messages: `RUST_LOG` decides, else these options.
    pub fn start_logging(self) {
        let level = match (self.quiet, self.verbose) {
            (true, _) => "off",
            // What libraries log at this level, they report as errors too.
            (false, 0) => "edgemesh=error,strokes=error,viewer=error",
            (false, 1) => "info",
            (false, _) => "debug",
        };
        let environment = env_logger::Env::default().default_filter_or(level);
        // Fails only where a logger is set already, which then serves as well.
        let _ = env_logger::Builder::from_env(environment).try_init();
    }
}

/// From which angle on an edge is a crease.
#[derive(Debug, Clone, Copy, Default, Args)]
#[command(next_help_heading = "Creases")]
pub struct CreaseOptions {
    /// Edges whose faces turn by more than this are creases [default: 30]
    #[arg(long, value_name = "DEG", value_parser = parse_crease, conflicts_with_all = ["ridge", "valley"])]
    pub crease: Option<f64>,
    /// The same for convex edges only
    #[arg(long, value_name = "DEG", value_parser = parse_crease)]
    pub ridge: Option<f64>,
    /// The same for concave edges only
    #[arg(long, value_name = "DEG", value_parser = parse_crease)]
    pub valley: Option<f64>,
}

impl CreaseOptions {
    /// Whether any threshold was given.
    #[must_use]
    pub const fn is_given(&self) -> bool {
        self.crease.is_some() || self.ridge.is_some() || self.valley.is_some()
    }

    /// The thresholds as the builder takes them.
    #[must_use]
    pub fn build_options(&self) -> BuildOptions {
        let default = BuildOptions::default();
        let radians = |degrees: Option<f64>, default: f64| {
            degrees.or(self.crease).map_or(default, f64::to_radians)
        };
        BuildOptions {
            ridge_angle_rad: radians(self.ridge, default.ridge_angle_rad),
            valley_angle_rad: radians(self.valley, default.valley_angle_rad),
            ..default
        }
    }
}

fn parse_vector(text: &str) -> Result<DVec3, String> {
    let parts: Vec<f64> = text
        .split(',')
        .map(|part| part.trim().parse().ok().filter(|number: &f64| number.is_finite()))
        .collect::<Option<_>>()
        .ok_or("needs three numbers, as 1,0.6,1.2")?;
    match parts[..] {
        [x, y, z] => Ok(DVec3::new(x, y, z)),
        _ => Err(format!("needs three numbers, as 1,0.6,1.2; this has {}", parts.len())),
    }
}

fn parse_fov(text: &str) -> Result<f64, String> {
    parse_degrees(text, 0.001, 179.0)
}

fn parse_crease(text: &str) -> Result<f64, String> {
    parse_degrees(text, 0.0, 180.0)
}

fn parse_degrees(text: &str, low: f64, high: f64) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(degrees) if (low..=high).contains(&degrees) => Ok(degrees),
        _ => Err(format!("needs a number of degrees from {low} to {high}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_and_degrees_say_what_is_wrong() {
        assert_eq!(parse_vector("1, -2,3e1"), Ok(DVec3::new(1.0, -2.0, 30.0)));
        for text in ["1,2", "1,2,3,4", "1,2,x", "nan,0,0", ""] {
            assert!(parse_vector(text).is_err(), "{text}");
        }
        assert!(parse_fov("0").is_err() && parse_fov("180").is_err() && parse_fov("40").is_ok());
    }

    #[test]
    fn a_target_alone_carries_the_eye_along() {
        let bounds = Bounds { min: [-1.0; 3], max: [1.0; 3] };
        let options = CameraOptions { target: Some(DVec3::X), ..CameraOptions::default() };
        let camera = options.camera(&bounds, &MeshFrame::default()).unwrap();
        let default = Camera::default_view(&bounds);
        assert!((camera.eye - default.eye - DVec3::X).length() < 1e-12);
        let same = CameraOptions { eye: Some(DVec3::ZERO), ..CameraOptions::default() };
        assert!(same.camera(&bounds, &MeshFrame::default()).is_err());
    }
}
