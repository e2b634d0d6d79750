//! Arguments of the camera, for both commands.

use clap::Args;
use glam::DVec3;

use super::degrees::parse_degrees;
use crate::edge_mesh::{Bounds, MeshFrame};
use crate::view::{Camera, CameraError};

/// The camera. The default eye looks at the middle of the bounding box from the direction
/// (1, 0.6, 1.2), at three bounding radii.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Camera")]
pub struct CameraArguments {
    /// Position of the eye, in the units of the model
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    pub eye: Option<DVec3>,
    /// Point to look at [default: the middle of the bounding box]
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    pub target: Option<DVec3>,
    /// Direction that points up in the picture [default: 0,1,0]
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    pub up: Option<DVec3>,
    /// Vertical field of view in degrees [default: 40]
    #[arg(long, value_name = "DEG", value_parser = parse_fov, allow_hyphen_values = true)]
    pub fov: Option<f64>,
    /// Use an orthographic projection; the field of view then sets the height of the picture
    #[arg(long)]
    pub ortho: bool,
}

impl CameraArguments {
    /// The camera for a mesh within `bounds`, in the units of the mesh. The arguments are in the
    /// units of its file, which `frame` converts.
    ///
    /// # Errors
    /// Fails if the eye lies on the target, or the given direction up lies along the line of
    /// sight.
    pub fn camera(&self, bounds: &Bounds, frame: &MeshFrame) -> Result<Camera, CameraError> {
        let mut camera = Camera::default_view(bounds);
        if let Some(target) = self.target.map(|target| frame.to_mesh(target)) {
            camera.eye += target - camera.target;
            camera.target = target;
        }
        if let Some(eye) = self.eye.map(|eye| frame.to_mesh(eye)) {
            camera.eye = eye;
        }
        if camera.eye == camera.target {
            return Err(CameraError::EyeOnTarget);
        }
        if let Some(up) = self.up {
            if (camera.target - camera.eye).cross(up).length() <= 0.0 {
                return Err(CameraError::UpAlongSight);
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
        let options = CameraArguments { target: Some(DVec3::X), ..CameraArguments::default() };
        let camera = options.camera(&bounds, &MeshFrame::default()).unwrap();
        let default = Camera::default_view(&bounds);
        assert!((camera.eye - default.eye - DVec3::X).length() < 1e-12);
        let same = CameraArguments { eye: Some(DVec3::ZERO), ..CameraArguments::default() };
        assert!(same.camera(&bounds, &MeshFrame::default()).is_err());
    }
}
