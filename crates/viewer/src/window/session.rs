//! What the window shows and knows, without any of its pixels: panels read and change it,
//! the canvas draws it. Knows no GPU, so that panels are tested without one.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use edgemesh::load::DEMO;
use egui::util::undoer::{Settings, Undoer};

use super::error_text::error_text;
use super::inspection::Inspection;
use super::marking::Marking;
use super::messages::Messages;
use super::recipe::{Appearance, Recipe};
use super::remembered::Remembered;
use super::viewpoint::{NamedView, Viewpoint};
use crate::arguments::render_command;
use crate::error::Error;
use crate::picture::renderer::FrameStatistics;
use crate::scene::models::Scene;
use crate::scene::object_techniques::object_techniques;
use crate::scene::scene_file::SceneObject;
use crate::technique::Technique;
use crate::technique::library::Library;
use crate::technique::texture_format::PassTexture;

/// What the window shows and knows.
#[derive(Debug)]
pub struct Session {
    /// Techniques and components.
    pub library: Library,
    /// What is drawn.
    pub recipe: Recipe,
    /// The models, once they are there.
    pub scene: Option<Arc<Scene>>,
    /// The objects of scene files.
    pub objects: Vec<SceneObject>,
    /// What is remembered.
    pub remembered: Remembered,
    /// What there is to say.
    pub messages: Messages,
    /// Small pictures of techniques, by name.
    pub thumbnails: Thumbnails,
    /// What the last pictures drew and cost, the newest last.
    pub statistics: Vec<FrameStatistics>,
    /// The adapter that draws.
    pub adapter: String,
    /// Whether the keys are shown.
    pub shows_keys: bool,
    /// What is done meanwhile.
    pub work: Vec<Work>,
    /// What panels ask of the window.
    pub requests: Vec<Request>,
    /// The textures that the technique draws, once it is drawn.
    pub generated: Vec<PassTexture>,
    /// The one that is shown instead of the picture.
    pub inspection: Option<Inspection>,
    /// The appearance that a debug view has replaced, to go back to.
    pub before_debug_view: Option<Appearance>,
    /// The number of the cut that the hand moves; the last one where there are fewer.
    pub chosen_cut: usize,
    /// Edges that are marked by hand.
    pub marking: Marking,
    /// Another look beside this one.
    pub comparison: Option<Comparison>,
    undoer: Undoer<Appearance>,
}

/// Another look, at the right of a line across the picture.
#[derive(Debug, Clone)]
pub struct Comparison {
    /// The look.
    pub appearance: Appearance,
    /// Where the line is: 0 at the left, 1 at the right.
    pub share: f32,
}

/// Something that is done while the window goes on.
#[derive(Debug, Clone)]
pub struct Work {
    /// What.
    pub what: String,
    /// Since when.
    pub since: Instant,
    /// The number of the saving; none for loading.
    pub saving: Option<usize>,
}

impl Work {
    /// Whether models are loaded.
    #[must_use]
    pub const fn is_loading(&self) -> bool {
        self.saving.is_none()
    }
}

/// Small pictures of techniques, by name.
#[derive(Default)]
pub struct Thumbnails {
    /// Those that are there.
    pub textures: BTreeMap<String, egui::TextureHandle>,
    /// Whether they were asked for.
    pub are_wanted: bool,
}

impl std::fmt::Debug for Thumbnails {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_list().entries(self.textures.keys()).finish()
    }
}

/// What panels ask of the window.
#[derive(Debug, Clone, PartialEq)]
pub enum Request {
    /// Ask for files and open them.
    ChooseFiles,
    /// Open these files.
    Open(Vec<PathBuf>),
    /// Read the files again.
    Reload,
    /// Stop loading, or the saving of a number.
    Cancel(Option<usize>),
    /// Ask where to save the technique as it is, and save it.
    SaveTechnique,
    /// Draw the small pictures of the techniques.
    DrawThumbnails,
    /// Put this on the clipboard, and say so with the second text.
    Copy(String, &'static str),
    /// Go to a viewpoint smoothly.
    GoTo(Viewpoint),
    /// Ask where to save a picture, or so many around the target, and save it.
    SavePicture(Option<u32>),
    /// Ask where to save the window as it is, panels and all, and save it.
    SaveWindow,
    /// Close the window.
    Quit,
    /// Lose the graphics device, to see what happens.
    LoseDevice {
        /// Within a frame, or before one.
        is_within_frame: bool,
    },
}

/// The debug views: techniques that show what others are made of, with their labels.
pub(crate) const DEBUG_VIEWS: [(&str, &str); 5] = [
    ("debug_features", "Edge classes"),
    ("wireframe", "Wireframe"),
    ("debug_normals", "Normals"),
    ("debug_depth", "Depth"),
    ("debug_ids", "Regions"),
];

/// A pass that takes longer makes the window wait, in milliseconds.
const SLOW_MS: f64 = 2000.0;

/// The most frames whose times are kept.
pub const KEPT_FRAMES: usize = 120;

impl Session {
    /// A session before its models are there.
    #[must_use]
    pub fn new(library: Library, recipe: Recipe, remembered: Remembered) -> Self {
        let undoer = Undoer::with_settings(Settings {
            max_undos: 200,
            stable_time: 0.4,
            auto_save_interval: 30.0,
        });
        Self {
            library,
            recipe,
            scene: None,
            objects: Vec::new(),
            remembered,
            messages: Messages::default(),
            thumbnails: Thumbnails::default(),
            statistics: Vec::new(),
            adapter: String::new(),
            shows_keys: false,
            work: Vec::new(),
            requests: Vec::new(),
            generated: Vec::new(),
            inspection: None,
            before_debug_view: None,
            chosen_cut: 0,
            marking: Marking::default(),
            comparison: None,
            undoer,
        }
    }

    /// Goes on in another window, on another device: without what was that one's own. Its
    /// clock begins anew.
    pub fn move_on(&mut self) {
        self.thumbnails = Thumbnails::default();
        self.statistics.clear();
        self.generated.clear();
        self.work.clear();
        self.requests.clear();
        self.undoer.add_undo(&self.recipe.appearance);
    }

    /// Asks something of the window.
    pub fn ask(&mut self, request: Request) {
        self.requests.push(request);
    }

    /// Takes the models that were loaded.
    ///
    /// # Errors
    /// Where the camera of the command line looks nowhere.
    pub fn take_scene(
        &mut self,
        models: Vec<PathBuf>,
        scene: Arc<Scene>,
        objects: Vec<SceneObject>,
    ) -> Result<(), Error> {
        let is_first = self.recipe.viewpoint.is_none();
        let is_same = self.recipe.models == models && !is_first;
        self.remembered.opened(&models);
        self.recipe.models = models;
        let told = match (is_first, is_same) {
            // What was opened again is seen as it was.
            (_, true) => Ok(()),
            (true, _) => self.recipe.take_viewpoint(&scene.bounds, &scene.frame),
            (false, false) => {
                let up = self.remembered.up;
                self.recipe.viewpoint =
                    Some(Viewpoint::default_view(&scene.bounds, &scene.frame, up));
                Ok(())
            }
        };
        if told.is_err() || self.recipe.viewpoint.is_none() {
            let up = self.remembered.up;
            self.recipe.viewpoint = Some(Viewpoint::default_view(&scene.bounds, &scene.frame, up));
        }
        self.scene = Some(scene);
        self.objects = objects;
        self.statistics.clear();
        // Marks are of the models that were there.
        self.marking.forget();
        told
    }

    /// Reads techniques and components again, and the technique with what was changed in
    /// it.
    ///
    /// # Errors
    /// What is wrong with it; it stays as it was.
    pub fn read_again(&mut self) -> Result<(), Error> {
        let library = self.recipe.read_library();
        let mut appearance = self.recipe.appearance.clone();
        appearance.read_again(&library)?;
        self.library = library;
        self.recipe.appearance = appearance;
        Ok(())
    }

    /// The folders of the technique's files, and of the user's own.
    #[must_use]
    pub fn watched_folders(&self) -> Vec<PathBuf> {
        let mut folders = self.recipe.appearance.technique.folders.clone();
        folders.extend(self.recipe.shader_folder().map(Path::to_owned));
        folders
    }

    /// Takes the recipe of a picture: its technique with what was changed, its light, its
    /// camera. Where its models are there and are not open, all of that waits for them: the
    /// recipe is given back, to be taken once they are loaded.
    ///
    /// # Errors
    /// Where it cannot be read; everything stays as it was.
    pub fn take_words(&mut self, words: &[String]) -> Result<Option<Recipe>, Error> {
        let mut recipe = Recipe::of_words(words, &self.library)?;
        recipe.take_machine(&self.recipe);
        let is_there = recipe.models.iter().all(|path| path.is_file() || path == Path::new(DEMO));
        let is_open = recipe.models == self.recipe.models;
        if is_open || !is_there {
            if let Some(scene) = &self.scene {
                recipe.take_viewpoint(&scene.bounds, &scene.frame)?;
                self.recipe.viewpoint = recipe.viewpoint;
            }
            if is_open {
                self.recipe.take_arguments(&recipe);
            } else {
                // The models that are open were read as the arguments say that are here.
                let names = crate::window::remembered::name_of(&recipe.models);
                self.messages.note(format!("{names} is not there; the rest was taken"));
            }
            self.recipe.appearance = recipe.appearance;
            return Ok(None);
        }
        Ok(Some(recipe))
    }

    /// Compares with a technique, or with nothing any more; what is wrong with it is told.
    pub fn compare_with(&mut self, name: Option<&str>) {
        let Some(name) = name else {
            self.comparison = None;
            return;
        };
        let mut appearance = self.recipe.appearance.clone();
        match appearance.take_technique(&self.library, name) {
            Ok(()) => {
                let share = self.comparison.as_ref().map_or(0.5, |known| known.share);
                self.comparison = Some(Comparison { appearance, share });
            }
            Err(error) => self.messages.technique = Some(error_text(&error)),
        }
    }

    /// Changes sides with the look that this one is compared with.
    pub fn swap_sides(&mut self) {
        if let Some(comparison) = &mut self.comparison {
            let (own, other) = (&mut self.recipe.appearance, &mut comparison.appearance);
            std::mem::swap(own, other);
            // The light is that of the scene.
            std::mem::swap(&mut own.lighting, &mut other.lighting);
        }
    }

    /// Takes another technique; what is wrong with it is told, and the one before stays.
    pub fn take_technique(&mut self, name: &str) {
        let mut appearance = self.recipe.appearance.clone();
        match appearance.take_technique(&self.library, name) {
            Ok(()) => {
                self.recipe.appearance = appearance;
                self.messages.technique = None;
            }
            Err(error) => self.messages.technique = Some(error_text(&error)),
        }
    }

    /// Shows a debug view. The appearance before it is kept, with its changes.
    pub fn show_debug_view(&mut self, name: &str) {
        let before = self.recipe.appearance.clone();
        let was_debug_view = self.is_debug_view();
        self.take_technique(name);
        if self.recipe.appearance.technique_name == name && !was_debug_view {
            self.before_debug_view = Some(before);
        }
    }

    /// Whether a debug view is shown that can be left.
    #[must_use]
    pub fn is_debug_view(&self) -> bool {
        let name = self.recipe.appearance.technique_name.as_str();
        self.before_debug_view.is_some() && DEBUG_VIEWS.iter().any(|(view, _)| *view == name)
    }

    /// Goes back to the appearance before the debug view.
    pub fn leave_debug_view(&mut self) {
        let is_debug_view = self.is_debug_view();
        if let Some(before) = self.before_debug_view.take().filter(|_| is_debug_view) {
            let now = &self.recipe.appearance;
            // The light may have been moved meanwhile.
            let (lighting, is_transparent) = (now.lighting.clone(), now.is_transparent);
            self.recipe.appearance = Appearance { lighting, is_transparent, ..before };
        }
    }

    /// The techniques of single objects; empty if no object has one.
    ///
    /// # Errors
    /// If one of them has a mistake.
    pub fn object_overrides(&self) -> Result<Vec<Technique>, Error> {
        let technique = &self.recipe.appearance.technique;
        object_techniques(&self.objects, &self.library, technique, &mut |_| ())
    }

    /// Goes to one of the sides, and fits the models.
    pub fn go_to_side(&mut self, view: NamedView) {
        if let Some(from) = self.recipe.viewpoint {
            let up = self.remembered.up;
            self.ask(Request::GoTo(self.fitted(&from.from_side(view, up))));
        }
    }

    /// Goes back to where a model is seen from at first.
    pub fn go_home(&mut self) {
        if let Some(scene) = &self.scene {
            let up = self.remembered.up;
            let home = Viewpoint::default_view(&scene.bounds, &scene.frame, up);
            self.ask(Request::GoTo(home));
        }
    }

    /// A viewpoint from where all is seen.
    #[must_use]
    pub fn fitted(&self, view: &Viewpoint) -> Viewpoint {
        match &self.scene {
            Some(scene) => view.fitted(&scene.bounds, &scene.frame),
            None => *view,
        }
    }

    /// The command that draws this picture, at a size.
    #[must_use]
    pub fn command(&self, size: [u32; 2]) -> Option<String> {
        Some(render_command(self.recipe.words()?, size))
    }

    /// Sees what has changed since; to be called with every frame, at the window's time in
    /// seconds.
    pub fn watch_changes(&mut self, time: f64) {
        self.undoer.feed_state(time, &self.recipe.appearance);
    }

    /// Whether there is something to undo.
    #[must_use]
    pub fn has_undo(&self) -> bool {
        self.undoer.has_undo(&self.recipe.appearance)
    }

    /// Whether there is something to redo.
    #[must_use]
    pub fn has_redo(&self) -> bool {
        self.undoer.has_redo(&self.recipe.appearance)
    }

    /// Takes the last change back.
    pub fn undo(&mut self) {
        if let Some(before) = self.undoer.undo(&self.recipe.appearance).cloned() {
            self.recipe.appearance = before;
        }
    }

    /// Does again what was taken back.
    pub fn redo(&mut self) {
        if let Some(after) = self.undoer.redo(&self.recipe.appearance).cloned() {
            self.recipe.appearance = after;
        }
    }

    /// Keeps what a picture drew and cost; one that made the window wait is told.
    pub fn keep(&mut self, statistics: FrameStatistics) {
        let times = statistics.passes.iter().filter_map(|(name, ms)| Some((name, (*ms)?)));
        let slowest = times.max_by(|one, other| one.1.total_cmp(&other.1));
        if let Some((name, ms)) = slowest.filter(|(_, ms)| *ms > SLOW_MS) {
            let seconds = ms / 1e3;
            self.messages.note(format!(
                "the pass '{name}' took {seconds:.1} s, and the window had to wait for it; it can \
                 be switched off under Look"
            ));
        }
        if self.statistics.len() == KEPT_FRAMES {
            self.statistics.remove(0);
        }
        self.statistics.push(statistics);
    }
}
