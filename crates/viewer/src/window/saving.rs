//! Pictures and turntables, drawn and written on another thread.
//!
//! They are drawn as by `viewer render`, by another renderer from a copy of the recipe, so
//! that changes in the window do not affect them.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use edgemesh::format::whole_file::write_file;
use strokes::Gpu;

use super::background::Tell;
use super::recipe::Recipe;
use crate::error::Error;
use crate::picture::png::{encode_png, encode_png_with_text, read_png_text};
use crate::picture::renderer::PictureInput;
use crate::picture::tiles::AnySizeRenderer;
use crate::picture::turntable;
use crate::scene::models::Scene;
use crate::technique::Technique;

/// The keyword of the text chunk with the recipe.
const KEYWORD: &str = "Edgemesh";

/// A picture or turntable to save.
#[derive(Debug, Clone)]
pub struct Order {
    /// The recipe.
    pub recipe: Recipe,
    /// Its models.
    pub scene: Arc<Scene>,
    /// The techniques of single objects.
    pub overrides: Vec<Technique>,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The file to write.
    pub path: PathBuf,
    /// Number of pictures of a turntable; `None` for a single picture.
    pub turntable: Option<u32>,
    /// The device that draws.
    pub gpu: Gpu,
}

/// Draws and writes; returns a note about what was written.
///
/// # Errors
/// If it cannot be drawn or written; [`Error::Canceled`] if `tell` returns false.
pub fn save(order: &Order, tell: Tell) -> Result<String, Error> {
    let Order { recipe, scene, overrides, size, path, turntable, gpu } = order;
    let tell = |what: &str| match tell(what) {
        true => Ok(()),
        false => Err(Error::Canceled),
    };
    tell(&format!("drawing {}", path.display()))?;
    let viewpoint = recipe.viewpoint.ok_or_else(|| Error::NoModel)?;
    let camera = viewpoint.camera(&scene.frame);
    let options = recipe.picture_options(*size);
    let technique = &recipe.appearance.technique;
    let input = PictureInput { scene, technique, overrides };
    let mut renderer = AnySizeRenderer::new(gpu, input, &options)?;
    if let &Some(steps) = turntable {
        let is_transparent = options.is_transparent;
        crate::picture::turntable::write(path, steps, *size, is_transparent, |step| {
            let stage = format!("drawing picture {} of {steps}", step + 1);
            tell(&stage)?;
            let camera = turntable::camera_at(&camera, step, steps);
            Ok(renderer.render(&camera, &mut |_, _| tell(&stage))?.0)
        })?;
    } else {
        let (picture, _) = renderer.render(&camera, &mut |done, total| {
            tell(&format!("drawing {}: tile {done} of {total}", path.display()))
        })?;
        tell(&format!("writing {}", path.display()))?;
        let text = recipe.words().and_then(|words| serde_json::to_string(&words).ok());
        let text = text.as_deref().map(|text| (KEYWORD, text));
        write_file(path, &encode_png_with_text(&picture, options.is_transparent, text)?)?;
    }
    Ok(format!("saved as {}", path.display()))
}

/// Writes the pixels of the window; returns a note about what was written.
///
/// # Errors
/// If they cannot be written.
pub(crate) fn save_window(
    path: &Path,
    pixels: &egui::ColorImage,
    tell: Tell,
) -> Result<String, Error> {
    tell(&format!("writing {}", path.display()));
    let [width, height] = pixels.size.map(edgemesh::index::to_u32);
    let texels = pixels.pixels.iter().flat_map(egui::Color32::to_array).collect();
    let picture = image::RgbaImage::from_raw(width, height, texels);
    let picture = picture.ok_or_else(|| Error::Window("the window gave too few pixels".into()))?;
    write_file(path, &encode_png(&picture, false)?)?;
    Ok(format!("saved as {}", path.display()))
}

/// The recipe's words in a picture written by [`save`]; `None` for any other file.
#[must_use]
pub fn words_in(path: &Path) -> Option<Vec<String>> {
    serde_json::from_str(&read_png_text(path, KEYWORD)?).ok()
}
