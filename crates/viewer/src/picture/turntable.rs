//! A camera that turns around the scene, as numbered pictures or an animation.

use std::f64::consts::TAU;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use edgemesh::format::whole_file::write_file;
use edgemesh::view::Camera;
use glam::DQuat;
use image::RgbaImage;

use crate::error::Error;
use crate::picture::animation::{AnimationKind, encode_animation};
use crate::picture::png::{as_stored, encode_png};

/// The camera at `step` of `steps` around its target, turning left.
#[must_use]
pub(crate) fn camera_at(camera: &Camera, step: u32, steps: u32) -> Camera {
    let axis = camera.up.normalize_or_zero();
    let turn = DQuat::from_axis_angle(axis, TAU * f64::from(step) / f64::from(steps));
    Camera { eye: camera.target + turn * (camera.eye - camera.target), ..*camera }
}

/// Writes pictures that `draw` returns with premultiplied alpha: as an animation if the
/// ending of `path` names one, else as numbered PNG files.
///
/// # Errors
/// The first error of `draw`, [`Error::Encode`] or [`Error::Write`].
pub(crate) fn write(
    path: &Path,
    steps: u32,
    size: [u32; 2],
    is_transparent: bool,
    mut draw: impl FnMut(u32) -> Result<RgbaImage, Error>,
) -> Result<(), Error> {
    if let Some(kind) = AnimationKind::of(path) {
        let bytes = encode_animation(kind, steps, size, |step| {
            draw(step).map(|picture| as_stored(&picture, is_transparent))
        })?;
        return Ok(write_file(path, &bytes)?);
    }
    for step in 0..steps {
        let bytes = encode_png(&draw(step)?, is_transparent)?;
        write_file(&numbered(path, step, steps), &bytes)?;
    }
    Ok(())
}

/// `turn.png` becomes `turn-00.png`, with as many digits as the last number needs.
fn numbered(path: &Path, step: u32, steps: u32) -> PathBuf {
    let digits = (steps - 1).checked_ilog10().map_or(1, |log| log as usize + 1);
    let mut name = path.file_stem().unwrap_or(OsStr::new("picture")).to_owned();
    name.push(format!("-{step:0digits$}.png"));
    path.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turntable_names_sort_as_they_turn() {
        let names = [0, 9, 35].map(|step| numbered(Path::new("a/turn.png"), step, 36));
        assert_eq!(names[0], Path::new("a/turn-00.png"));
        assert_eq!(names[2], Path::new("a/turn-35.png"));
        assert!(names.is_sorted());
        assert_eq!(numbered(Path::new("t.png"), 0, 1), Path::new("t-0.png"));
    }
}
