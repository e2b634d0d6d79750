//! Everything that makes a picture except its pixels: the models, the technique with its
//! changes, the camera, the light, the cuts.
//!
//! ```text
//!   command line --> Recipe <--> panels
//!                      |  ^
//!     viewer render ...v  | text in a PNG, undo
//! ```
//!
//! A recipe can be written as arguments of `viewer render` and read from them.

use std::path::{Path, PathBuf};

use edgemesh::edge_mesh::MeshFrame;
use edgemesh::load::{DEMO, LoadOptions};

use super::viewpoint::Viewpoint;
use crate::arguments::{PictureArguments, PictureWords, read_words};
use crate::error::Error;
use crate::picture::renderer::PictureOptions;
use crate::scene::lighting::Lighting;
use crate::technique::Technique;
use crate::technique::changes::changes;
use crate::technique::library::Library;

/// Everything that makes a picture except its pixels.
#[derive(Debug, Clone)]
pub struct Recipe {
    /// The files, as named on the command line.
    pub models: Vec<PathBuf>,
    /// The part that undo and redo change.
    pub appearance: Appearance,
    /// The viewpoint; `None` until the models are loaded.
    pub viewpoint: Option<Viewpoint>,
    /// The command line's values of what the window does not change, and of how models are
    /// read.
    arguments: PictureArguments,
}

/// Technique, light and background: the part that undo and redo change.
#[derive(Debug, Clone, PartialEq)]
pub struct Appearance {
    /// Name or file of the technique.
    pub technique_name: String,
    /// The technique as in its file.
    pub(crate) original: Technique,
    /// The technique with the changes made in the window.
    pub technique: Technique,
    /// Light and clip planes.
    pub lighting: Lighting,
    /// Whether the background is transparent.
    pub(crate) is_transparent: bool,
}

impl Recipe {
    /// The recipe of a command line; without models, that of the demo.
    ///
    /// # Errors
    /// If the technique, its settings or the light have mistakes.
    pub(crate) fn new(
        models: &[PathBuf],
        arguments: PictureArguments,
        library: &Library,
    ) -> Result<Self, Error> {
        let original = technique(library, &arguments.technique)?;
        let mut changed = original.clone();
        arguments.change(&mut changed, &mut |_| ())?;
        let appearance = Appearance {
            technique_name: arguments.technique.clone(),
            original,
            technique: changed,
            lighting: arguments.lighting.lighting()?,
            is_transparent: arguments.transparent,
        };
        let demo = || vec![PathBuf::from(DEMO)];
        let models = if models.is_empty() { demo() } else { models.to_owned() };
        Ok(Self { models, appearance, viewpoint: None, arguments })
    }

    /// Reads the words of [`Self::words`].
    ///
    /// # Errors
    /// [`Error::CommandLine`], or if the technique, its settings or the light have mistakes.
    pub fn of_words(words: &[String], library: &Library) -> Result<Self, Error> {
        let (models, arguments) = read_words(words)?;
        Self::new(&models, arguments, library)
    }

    /// Takes the viewpoint of the command line, for models in `frame`.
    ///
    /// # Errors
    /// [`Error::Camera`].
    pub(crate) fn take_viewpoint(
        &mut self,
        bounds: &edgemesh::edge_mesh::Bounds,
        frame: &MeshFrame,
    ) -> Result<(), Error> {
        let options = &self.arguments.camera;
        let camera = options.camera(bounds, frame)?;
        let mut view = Viewpoint::of_camera(&camera, frame, options.fov);
        // The exact numbers of the command line.
        view.eye = options.eye.unwrap_or(view.eye);
        view.target = options.target.unwrap_or(view.target);
        self.viewpoint = Some(view);
        Ok(())
    }

    /// The arguments of `viewer render` for this picture, without its size and file. `None`
    /// if the changes of the technique cannot be written as settings.
    #[must_use]
    pub fn words(&self) -> Option<Vec<String>> {
        let appearance = &self.appearance;
        let words = PictureWords {
            models: &self.models,
            technique: &appearance.technique_name,
            settings: changes(&appearance.original, &appearance.technique)?,
            lighting: &appearance.lighting,
            is_transparent: appearance.is_transparent,
            camera: self.viewpoint.as_ref().map(Viewpoint::arguments),
        };
        Some(words.words(&self.arguments))
    }

    /// Options of a picture of a size in pixels.
    #[must_use]
    pub(crate) fn picture_options(&self, size: [u32; 2]) -> PictureOptions {
        PictureOptions {
            is_transparent: self.appearance.is_transparent,
            ..self.arguments.picture_options(size, self.appearance.lighting.clone())
        }
    }

    /// How the models are read and built.
    #[must_use]
    pub(crate) fn load_options(&self) -> LoadOptions {
        LoadOptions { with_instances: true, ..self.arguments.input.load_options() }
    }

    /// The file of marks, if one is named.
    #[must_use]
    pub(crate) fn marks_file(&self) -> Option<&Path> {
        self.arguments.input.marks.as_deref()
    }

    /// A part of the adapter's name, if one is given.
    #[must_use]
    pub(crate) fn adapter(&self) -> Option<&str> {
        self.arguments.adapter.as_deref()
    }

    /// The folder that replaces the shipped shaders.
    #[must_use]
    pub(crate) fn shader_folder(&self) -> Option<&Path> {
        self.arguments.library.shaders.as_deref()
    }

    /// Reads techniques and components from their folders.
    #[must_use]
    pub(crate) fn read_library(&self) -> Library {
        self.arguments.library.load()
    }

    /// Takes the folders and the adapter of another recipe, which belong to the machine and
    /// not to a picture.
    pub(super) fn take_machine(&mut self, other: &Self) {
        self.arguments.library = other.arguments.library.clone();
        self.arguments.adapter.clone_from(&other.arguments.adapter);
    }

    /// Takes the arguments of another recipe, except those that the window changes.
    pub(super) fn take_arguments(&mut self, other: &Self) {
        self.arguments = other.arguments.clone();
    }

    /// The name of the models, for the title of the window.
    #[must_use]
    pub(crate) fn title(&self) -> String {
        let name = |path: &PathBuf| {
            path.file_name().map_or_else(
                || path.display().to_string(),
                |name| name.to_string_lossy().into_owned(),
            )
        };
        match &self.models[..] {
            [demo] if demo == Path::new(DEMO) => "Demo".to_owned(),
            [one] => name(one),
            [first, rest @ ..] => format!("{} and {} more", name(first), rest.len()),
            [] => String::new(),
        }
    }
}

impl Appearance {
    /// Takes another technique, without changes.
    ///
    /// # Errors
    /// All mistakes in it.
    pub(crate) fn take_technique(&mut self, library: &Library, name: &str) -> Result<(), Error> {
        self.original = technique(library, name)?;
        self.technique = self.original.clone();
        name.clone_into(&mut self.technique_name);
        Ok(())
    }

    /// Reads the technique's file again. Changes are applied again; those that no longer fit
    /// are dropped.
    ///
    /// # Errors
    /// All mistakes in it.
    pub(crate) fn read_again(&mut self, library: &Library) -> Result<(), Error> {
        let settings = changes(&self.original, &self.technique).unwrap_or_default();
        let name = self.technique_name.clone();
        self.take_technique(library, &name)?;
        for setting in settings {
            if let Err(error) = self.technique.set(&setting) {
                log::info!("dropped a setting: {error}");
            }
        }
        Ok(())
    }

    /// Whether the technique differs from its file.
    #[must_use]
    pub fn is_changed(&self) -> bool {
        self.technique != self.original
    }
}

fn technique(library: &Library, name: &str) -> Result<Technique, Error> {
    Ok(library.technique(name)?.0)
}

#[cfg(test)]
mod tests {
    use edgemesh::edge_mesh::Bounds;
    use glam::DVec3;

    use super::*;

    fn words(line: &str) -> Vec<String> {
        line.split_whitespace().map(str::to_owned).collect()
    }

    #[test]
    fn a_recipe_is_its_own_command_line() {
        let library = Library::shipped();
        let line = "a.obj b.stl --technique anime --set strokes.width=3.3 --set \
                    silhouette.color=#ff0000 --light point:1,2,3 --light-color #ffeedd --clip \
                    0,1,0,-0.5 --clip 1,0,0,0.25 --transparent --eye 3,2,5.5 --target 0,0,0.1 \
                    --up 0,1,0 --fov 33.3 --ortho --layout replicated-f32 --samples 1 --weld 0.001 \
                    --crease 25";
        let mut recipe = Recipe::of_words(&words(line), &library).unwrap();
        let bounds = Bounds { min: [-1.0; 3], max: [1.0; 3] };
        let frame = MeshFrame { origin: DVec3::new(0.3, 7.0, 0.0), scale: 0.5 };
        recipe.take_viewpoint(&bounds, &frame).unwrap();
        let said = recipe.words().unwrap();
        let sorted = |mut words: Vec<String>| {
            words.sort();
            words
        };
        assert_eq!(sorted(said.clone()), sorted(words(line)));
        let mut again = Recipe::of_words(&said, &library).unwrap();
        again.take_viewpoint(&bounds, &frame).unwrap();
        assert_eq!(again.appearance, recipe.appearance);
        assert_eq!((again.viewpoint, again.models), (recipe.viewpoint, recipe.models));
    }

    #[test]
    fn without_a_model_there_is_the_demo() {
        let recipe = Recipe::of_words(&[], &Library::shipped()).unwrap();
        assert_eq!(
            (recipe.models, recipe.appearance.technique_name.as_str()),
            (vec![PathBuf::from(DEMO)], "ink")
        );
        assert!(Recipe::of_words(&words("--technique inc"), &Library::shipped()).is_err());
        assert!(Recipe::of_words(&words("--output a.png"), &Library::shipped()).is_err());
    }
}
