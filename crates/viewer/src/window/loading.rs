//! Models, read and uploaded while the window goes on with what it has.
//!
//! ```text
//!   files --read, build--> Scene --upload--> PictureRenderer --> the window takes both
//! ```

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;

use edgemesh::load::{LoadOptions, Stage};
use strokes::Gpu;

use super::background::{Background, Tell};
use super::recipe::Recipe;
use crate::error::Error;
use crate::picture::renderer::{PictureOptions, PictureRenderer};
use crate::scene::models::Scene;
use crate::scene::object_techniques::object_techniques;
use crate::scene::scene_file::{SceneObject, objects_of};
use crate::technique::Technique;
use crate::technique::library::Library;

/// Models that are wanted.
#[derive(Debug, Clone)]
pub(super) struct ToLoad {
    pub(super) models: Vec<PathBuf>,
    /// How they are to be seen; none where that stays as it is.
    pub(super) recipe: Option<Recipe>,
}

/// Models that are being loaded.
pub(super) struct Loading {
    pub(super) what: ToLoad,
    pub(super) work: Background<LoadedScene>,
}

/// What is loaded, and what it is to be drawn with at first.
#[derive(Debug, Clone)]
pub struct Request {
    /// Models and scene files.
    pub models: Vec<PathBuf>,
    /// How they are read.
    pub load: LoadOptions,
    /// The device to upload to; none where nothing is drawn.
    pub gpu: Option<Gpu>,
    /// Techniques and components.
    pub library: Library,
    /// What they are drawn with at first.
    pub built: Built,
    /// How it is drawn.
    pub options: PictureOptions,
}

/// What a renderer was built for; all else can change while it goes on.
#[derive(Debug, Clone, PartialEq)]
pub struct Built {
    /// The technique.
    pub technique: Technique,
    /// Whether there is no paper behind the scene.
    pub is_transparent: bool,
}

/// Models that are there.
#[derive(Debug)]
pub struct LoadedScene {
    /// The request's models.
    pub models: Vec<PathBuf>,
    /// What they are.
    pub scene: Arc<Scene>,
    /// The objects of scene files.
    pub objects: Vec<SceneObject>,
    /// Ready to draw, where there is a device, and for what.
    pub renderer: Option<(PictureRenderer, Built)>,
}

/// Reads the models of a request, and uploads them.
///
/// # Errors
/// For the first model that cannot be loaded or is too large, or if `tell` cancels.
pub fn load(request: Request, tell: Tell) -> Result<LoadedScene, Error> {
    let go_on = |what: &str| match tell(what) {
        true => ControlFlow::Continue(()),
        false => ControlFlow::Break(()),
    };
    let objects = objects_of(&request.models)?;
    let scene = Scene::load(&objects, &request.load, &|stage: Stage| go_on(&stage.to_string()))?;
    let renderer = match &request.gpu {
        None => None,
        Some(gpu) => {
            if go_on("uploading").is_break() {
                return Err(Error::Canceled);
            }
            let Request { built, options, library, .. } = &request;
            let technique = &built.technique;
            let looks = object_techniques(&objects, library, technique, &mut |_| ())?;
            match PictureRenderer::new(gpu, &scene, technique, &looks, options) {
                Ok(made) => Some((made, built.clone())),
                // The models are not at fault: the window reports the technique's mistakes.
                Err(Error::Technique(_)) => None,
                Err(error) => return Err(error),
            }
        }
    };
    Ok(LoadedScene { models: request.models, scene: Arc::new(scene), objects, renderer })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn start(model: &str) -> Background<LoadedScene> {
        let library = Library::shipped();
        let recipe = Recipe::of_words(&[model.to_owned()], &library).unwrap();
        let load = recipe.load_options();
        let technique = recipe.appearance.technique;
        let request = Request {
            models: recipe.models,
            load,
            gpu: None,
            library,
            built: Built { technique, is_transparent: false },
            options: PictureOptions::default(),
        };
        Background::start(|| {}, |tell| super::load(request, tell))
    }

    #[test]
    fn models_come_with_what_was_done() {
        let loading = start("demo:");
        assert_eq!(loading.wait().unwrap().scene.models.len(), 1);
        assert!(loading.stage().starts_with("building"), "{}", loading.stage());
        let error = start("no such.obj").wait().unwrap_err().to_string();
        assert!(error.contains("no such.obj"), "{error}");
    }
}
