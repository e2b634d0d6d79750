//! Thumbnails of all techniques, drawn on another thread when their list is first opened,
//! with the demo model.

use std::sync::mpsc::Sender;

use edgemesh::load::{DEMO, LoadOptions, NoProgress};
use edgemesh::view::Camera;
use image::RgbaImage;
use strokes::Gpu;

use super::background::Tell;
use crate::error::Error;
use crate::picture::png::as_stored;
use crate::picture::renderer::{PictureInput, PictureOptions, PictureRenderer};
use crate::scene::models::Scene;
use crate::scene::scene_file::SceneObject;
use crate::technique::library::Library;

/// Width and height in pixels: twice the size in points.
pub(crate) const SIZE: [u32; 2] = [144, 108];

/// The name of a technique, and its picture.
pub(crate) type Thumbnail = (String, RgbaImage);

/// Draws each technique of the library and sends it with its name. A technique that cannot be
/// drawn is left out.
///
/// # Errors
/// If the model cannot be loaded, or `tell` cancels.
pub(crate) fn draw(
    gpu: &Gpu,
    library: &Library,
    sender: &Sender<Thumbnail>,
    tell: Tell,
) -> Result<(), Error> {
    let object = SceneObject::plain(DEMO.as_ref());
    let scene = Scene::load(&[object], &LoadOptions::default(), &NoProgress)?;
    let camera = Camera::default_view(&scene.bounds);
    // A little closer than the whole bounding sphere needs.
    let camera = Camera { eye: camera.target + (camera.eye - camera.target) * 0.72, ..camera };
    let options = PictureOptions { size: SIZE, ..PictureOptions::default() };
    let mut renderer: Option<PictureRenderer> = None;
    for name in library.technique_names() {
        if !tell(&format!("drawing {name}")) {
            return Err(Error::Canceled);
        }
        let Ok((technique, _)) = library.technique(name) else { continue };
        let made = match &mut renderer {
            Some(renderer) => renderer.reload(PictureInput::new(&scene, &technique), &options),
            None => PictureRenderer::new(gpu, PictureInput::new(&scene, &technique), &options)
                .map(|made| renderer = Some(made)),
        };
        let drawn = made.ok().and(renderer.as_mut());
        let Some(Ok((picture, _))) = drawn.map(|renderer| renderer.render(&camera)) else {
            continue;
        };
        if sender.send((name.to_owned(), as_stored(&picture, false))).is_err() {
            return Ok(());
        }
    }
    Ok(())
}
