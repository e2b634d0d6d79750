//! Scene files: objects in their places, each with an optional technique.
//!
//! ```toml
//! [[object]]
//! model = "bunny.obj"            # from this file's folder
//! translate = [1.5, 0.0, 0.0]
//! rotate = [0.0, 90.0, 0.0]      # degrees around x, then y, then z
//! scale = 2.0                    # or one number an axis
//! technique = "pen"              # else the command line's
//! set = ["contour.color=#a03010"]
//! ```
//!
//! An object is scaled, then turned, then moved, in units of the files. Therefore models far
//! from the origin are not recentered if any object has a transform.

use std::ops::Range;
use std::path::{Path, PathBuf};

use glam::{DMat4, DQuat, DVec3, EulerRot};
use serde::Deserialize;
use toml::Spanned;

use crate::error::SceneFileError;

/// An object of a scene file.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneObject {
    /// The model's file.
    pub(crate) model: PathBuf,
    /// Transform from the model to the scene, in units of the files.
    pub(crate) scene_from_model: DMat4,
    /// Name or file of the technique; `None` for that of the command line.
    pub(crate) technique: Option<String>,
    /// Settings of the technique.
    pub(crate) settings: Vec<String>,
}

impl SceneObject {
    /// A model without a transform, with the technique of the command line.
    #[must_use]
    pub fn plain(model: &Path) -> Self {
        let model = model.to_owned();
        Self { model, scene_from_model: DMat4::IDENTITY, technique: None, settings: Vec::new() }
    }
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    object: Vec<Entry>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    model: Spanned<String>,
    #[serde(default)]
    translate: [f64; 3],
    #[serde(default)]
    rotate: [f64; 3],
    scale: Option<Spanned<Scale>>,
    technique: Option<String>,
    #[serde(default)]
    set: Vec<String>,
}

#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(untagged)]
enum Scale {
    Even(f64),
    Axes([f64; 3]),
}

/// Whether a path names a scene file.
#[must_use]
pub(crate) fn is_scene_file(path: &Path) -> bool {
    path.extension().is_some_and(|end| end.eq_ignore_ascii_case("toml"))
}

/// The objects of all models and scene files, in order.
///
/// # Errors
/// As [`read_scene_file`].
pub(crate) fn objects_of(paths: &[PathBuf]) -> Result<Vec<SceneObject>, SceneFileError> {
    let mut objects = Vec::new();
    for path in paths {
        if is_scene_file(path) {
            objects.extend(read_scene_file(path)?);
        } else {
            objects.push(SceneObject::plain(path));
        }
    }
    Ok(objects)
}

/// # Errors
/// [`SceneFileError`], if the file cannot be read, or for the first wrong line.
pub(crate) fn read_scene_file(path: &Path) -> Result<Vec<SceneObject>, SceneFileError> {
    let text = std::fs::read_to_string(path)
        .map_err(|reason| SceneFileError::Io { path: path.to_owned(), reason })?;
    parse(path, &text)
}

fn parse(path: &Path, text: &str) -> Result<Vec<SceneObject>, SceneFileError> {
    let wrong = |span: Option<Range<usize>>, what: &str| {
        let before = span.and_then(|span| text.get(..span.start)).unwrap_or_default();
        let line = 1 + before.matches('\n').count();
        SceneFileError::Line { path: path.to_owned(), line, what: what.to_owned() }
    };
    let file: File = toml::from_str(text)
        .map_err(|error| wrong(error.span(), error.message().lines().next().unwrap_or_default()))?;
    if file.object.is_empty() {
        return Err(wrong(None, "has no object; begin one with [[object]]"));
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    file.object
        .into_iter()
        .map(|entry| {
            if entry.model.get_ref().is_empty() {
                return Err(wrong(Some(entry.model.span()), "model needs a file name"));
            }
            let scale = entry.scale.as_ref().map_or(DVec3::ONE, |scale| match *scale.get_ref() {
                Scale::Even(scale) => DVec3::splat(scale),
                Scale::Axes(axes) => DVec3::from(axes),
            });
            let numbers = scale.to_array().into_iter().chain(entry.translate).chain(entry.rotate);
            if !numbers.into_iter().all(f64::is_finite) {
                let what = "translate, rotate and scale need finite numbers";
                return Err(wrong(Some(entry.model.span()), what));
            }
            if scale.abs().min_element() == 0.0 {
                let span = entry.scale.as_ref().map(Spanned::span);
                return Err(wrong(span, "scale must not be 0 along an axis"));
            }
            let [x, y, z] = entry.rotate.map(f64::to_radians);
            // Around x first: the last factor of the product.
            let turn = DQuat::from_euler(EulerRot::ZYX, z, y, x);
            let place = DMat4::from_scale_rotation_translation(scale, turn, entry.translate.into());
            Ok(SceneObject {
                model: folder.join(entry.model.into_inner()),
                scene_from_model: place,
                technique: entry.technique,
                settings: entry.set,
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> Result<Vec<SceneObject>, SceneFileError> {
        parse(Path::new("folder/scene.toml"), text)
    }

    #[test]
    fn objects_are_scaled_then_turned_then_moved() {
        let scene = parsed(
            "[[object]]\nmodel = \"a.obj\"\nscale = 2\nrotate = [0, 90, 0]\ntranslate = [1, 0, 0]\n",
        )
        .unwrap();
        assert_eq!(scene[0].model, Path::new("folder/a.obj"));
        let moved = scene[0].scene_from_model.transform_point3(DVec3::X);
        assert!(moved.distance(DVec3::new(1.0, 0.0, -2.0)) < 1e-12, "{moved}");
        let both = "[[object]]\nmodel = \"a\"\nrotate = [90, 90, 0]\n";
        let turned = parsed(both).unwrap()[0].scene_from_model.transform_point3(DVec3::Y);
        assert!(turned.distance(DVec3::X) < 1e-12, "x first: {turned}");
    }

    #[test]
    fn techniques_of_objects_are_kept() {
        let text = "[[object]]\nmodel = \"a\"\ntechnique = \"pen\"\nset = [\"ridge.width=4\"]\n\n[[object]]\nmodel = \"b\"\nscale = [1, -1, 1]\n";
        let scene = parsed(text).unwrap();
        assert_eq!(scene[0].technique.as_deref(), Some("pen"));
        assert_eq!(scene[0].settings, ["ridge.width=4"]);
        assert_eq!(scene[1].technique, None);
        assert!(scene[1].scene_from_model.determinant() < 0.0, "a mirror is fine");
    }

    #[test]
    fn mistakes_name_their_line() {
        for (text, place, word) in [
            ("[[object]]\nmodel = \"a\"\nsize = 2\n", ":3:", "size"),
            ("[[object]]\n\nmodel = 3\n", ":3:", "string"),
            ("[[object]]\nmodel = \"\"\n", ":2:", "model"),
            ("[[object]]\nmodel = \"a\"\nscale = 0\n", ":3:", "scale"),
            ("[[object]]\nmodel = \"a\"\ntranslate = [nan, 0, 0]\n", ":2:", "finite"),
            ("object = 3\n", ":1:", "sequence"),
            ("[[object]]\nmodel = \"a\n", ":2:", ""),
            ("", ":1:", "object"),
            ("object = []", ":1:", "[[object]]"),
        ] {
            let message = parsed(text).unwrap_err().to_string();
            assert!(message.contains(place) && message.contains(word), "{text:?}: {message}");
        }
    }
}
