//! Models are read and uploaded on another thread.
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
use crate::picture::renderer::{PictureInput, PictureOptions, PictureRenderer};
use crate::scene::models::Scene;
use crate::scene::object_techniques::object_techniques;
use crate::scene::scene_file::{SceneObject, objects_of};
use crate::technique::Technique;
use crate::technique::library::Library;

/// Models to load.
#[derive(Debug, Clone)]
pub(super) struct LoadOrder {
    pub(super) models: Vec<PathBuf>,
    /// The recipe to take with them; `None` to keep the current one.
    pub(super) recipe: Option<Recipe>,
}

/// Models that are being loaded.
pub(super) struct Loading {
    pub(super) what: LoadOrder,
    pub(super) work: Background<LoadedScene>,
}

/// The input of [`load`].
#[derive(Debug, Clone)]
pub(crate) struct Request {
    /// Models and scene files.
    pub(crate) models: Vec<PathBuf>,
    /// How the models are read.
    pub(crate) load: LoadOptions,
    /// The device to upload to; `None` to only read the models.
    pub(crate) gpu: Option<Gpu>,
    /// Techniques and components.
    pub(crate) library: Library,
    /// What the renderer is built for.
    pub(crate) build_key: BuildKey,
    /// Options of the first picture.
    pub(crate) options: PictureOptions,
}

/// What a renderer is built for. All else can change without building again.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct BuildKey {
    /// The technique.
    pub(crate) technique: Technique,
    /// Whether the background is transparent.
    pub(crate) is_transparent: bool,
}

/// Models that were loaded.
#[derive(Debug)]
pub(crate) struct LoadedScene {
    /// The files of the request.
    pub(crate) models: Vec<PathBuf>,
    /// The models in memory.
    pub(crate) scene: Arc<Scene>,
    /// The objects of scene files.
    pub(crate) objects: Vec<SceneObject>,
    /// The renderer with what it was built for; `None` without a device, or if the technique
    /// has mistakes.
    pub(crate) renderer: Option<(PictureRenderer, BuildKey)>,
}

/// Reads the models of a request and uploads them.
///
/// # Errors
/// For the first model that cannot be loaded or is too large, or if `tell` cancels.
pub(crate) fn load(request: Request, tell: Tell) -> Result<LoadedScene, Error> {
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
            let Request { build_key, options, library, .. } = &request;
            let technique = &build_key.technique;
            let overrides = &object_techniques(&objects, library, technique, &mut |_| ())?;
            let input = PictureInput { scene: &scene, technique, overrides };
            match PictureRenderer::new(gpu, input, options) {
                Ok(made) => Some((made, build_key.clone())),
                // The models are not at fault: the canvas reports the mistakes of the
                // technique.
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
            build_key: BuildKey { technique, is_transparent: false },
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
