//! The state of the window without pixels: panels read and change it, the canvas draws it. It
//! knows no GPU, so that panels are tested without one.

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

/// The state of the window.
#[derive(Debug)]
pub struct Session {
    /// Techniques and components.
    pub library: Library,
    /// What the picture is made of.
    pub recipe: Recipe,
    /// The models, once they are loaded.
    pub scene: Option<Arc<Scene>>,
    /// The objects of scene files.
    pub(crate) objects: Vec<SceneObject>,
    /// Settings kept from one run to the next.
    pub remembered: Remembered,
    /// Messages to show.
    pub messages: Messages,
    /// Thumbnails of techniques.
    pub(crate) thumbnails: Thumbnails,
    /// Statistics of the last pictures, the newest last; at most [`KEPT_FRAMES`].
    pub(crate) statistics: Vec<FrameStatistics>,
    /// Name of the adapter.
    pub(crate) adapter: String,
    /// Whether the sheet of keys is shown.
    pub shows_keys: bool,
    /// Work on other threads.
    pub work: Vec<Work>,
    /// Requests of panels, which the window carries out.
    pub requests: Vec<Request>,
    /// The textures between passes, once the technique is drawn.
    pub generated: Vec<PassTexture>,
    /// The texture shown in place of the picture.
    pub inspection: Option<Inspection>,
    /// The appearance that a debug view has replaced, to go back to.
    pub(crate) before_debug_view: Option<Appearance>,
    /// Index of the cut that drags move, if there are that many; else the last cut moves.
    pub(crate) chosen_cut: usize,
    /// Edges marked by hand.
    pub(crate) marking: Marking,
    /// Another appearance shown beside this one.
    pub comparison: Option<Comparison>,
    undoer: Undoer<Appearance>,
}

/// Another appearance, to the right of a line across the picture.
#[derive(Debug, Clone)]
pub struct Comparison {
    /// The appearance.
    pub appearance: Appearance,
    /// Position of the line: 0 at the left, 1 at the right.
    pub(crate) share: f32,
}

/// Work on another thread.
#[derive(Debug, Clone)]
pub struct Work {
    /// Its current stage.
    pub what: String,
    /// When it started.
    pub since: Instant,
    /// Index of the save; `None` for a load.
    pub saving: Option<usize>,
}

impl Work {
    /// Whether models are being loaded.
    #[must_use]
    pub(crate) const fn is_loading(&self) -> bool {
        self.saving.is_none()
    }
}

/// Thumbnails of techniques.
#[derive(Default)]
pub(crate) struct Thumbnails {
    /// Textures by technique name.
    pub(crate) textures: BTreeMap<String, egui::TextureHandle>,
    /// Whether they were requested.
    pub(crate) are_wanted: bool,
}

impl std::fmt::Debug for Thumbnails {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_list().entries(self.textures.keys()).finish()
    }
}

/// A request of a panel, which the window carries out.
#[derive(Debug, Clone, PartialEq)]
pub enum Request {
    /// Choose files and open them.
    ChooseFiles,
    /// Open files.
    Open(Vec<PathBuf>),
    /// Read the open files again.
    Reload,
    /// Cancel the save with this index, or the load if `None`.
    Cancel(Option<usize>),
    /// Choose a file and save the technique with its changes.
    SaveTechnique,
    /// Draw the thumbnails of the techniques.
    DrawThumbnails,
    /// Copy the text to the clipboard and show the note.
    Copy(String, &'static str),
    /// Fly to a viewpoint.
    GoTo(Viewpoint),
    /// Choose a file and save a picture, or a turntable of this many pictures.
    SavePicture(Option<u32>),
    /// Choose a file and save the window with its panels.
    SaveWindow,
    /// Close the window.
    Quit,
    /// Lose the graphics device on purpose.
    LoseDevice {
        /// Whether within a frame; else before one.
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

/// A pass that takes longer than this, in milliseconds, is reported.
const SLOW_MS: f64 = 2000.0;

/// The number of frames whose statistics are kept.
pub(crate) const KEPT_FRAMES: usize = 120;

impl Session {
    /// A session without models.
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

    /// Prepares the session for another window and device: drops textures, statistics and
    /// work. The undo history starts a new clock.
    pub(crate) fn move_on(&mut self) {
        self.thumbnails = Thumbnails::default();
        self.statistics.clear();
        self.generated.clear();
        self.work.clear();
        self.requests.clear();
        self.undoer.add_undo(&self.recipe.appearance);
    }

    /// Adds a request.
    pub(crate) fn ask(&mut self, request: Request) {
        self.requests.push(request);
    }

    /// Takes loaded models.
    ///
    /// # Errors
    /// If the camera of the command line sees nothing; the default view is taken then.
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
            // Models that are loaded again keep their view.
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
        // Marks belong to the models before.
        self.marking.forget();
        told
    }

    /// Reads techniques and components again, and applies the changes of the technique again.
    ///
    /// # Errors
    /// All mistakes in the technique, which then stays as it was.
    pub(crate) fn read_again(&mut self) -> Result<(), Error> {
        let library = self.recipe.read_library();
        let mut appearance = self.recipe.appearance.clone();
        appearance.read_again(&library)?;
        self.library = library;
        self.recipe.appearance = appearance;
        Ok(())
    }

    /// The folders of the technique's files and of the user's shaders.
    #[must_use]
    pub(crate) fn watched_folders(&self) -> Vec<PathBuf> {
        let mut folders = self.recipe.appearance.technique.folders.clone();
        folders.extend(self.recipe.shader_folder().map(Path::to_owned));
        folders
    }

    /// Takes the recipe of a picture: its technique with changes, its light, its camera. If
    /// its models exist and are not open, the recipe is returned, to be taken once they are
    /// loaded.
    ///
    /// # Errors
    /// If the words cannot be read; nothing changes then.
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
                // The arguments stay, since the open models were read with them.
                let names = crate::window::remembered::name_of(&recipe.models);
                self.messages
                    .note(format!("{names} was not found; the other settings were applied"));
            }
            self.recipe.appearance = recipe.appearance;
            return Ok(None);
        }
        Ok(Some(recipe))
    }

    /// Compares with a technique, or ends the comparison if `None`. Mistakes are reported.
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

    /// Swaps the two sides of the comparison.
    pub(crate) fn swap_sides(&mut self) {
        if let Some(comparison) = &mut self.comparison {
            let (own, other) = (&mut self.recipe.appearance, &mut comparison.appearance);
            std::mem::swap(own, other);
            // Both sides have the light of the scene.
            std::mem::swap(&mut own.lighting, &mut other.lighting);
        }
    }

    /// Takes another technique. If it has mistakes, they are reported and the technique
    /// stays.
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
    pub(crate) fn show_debug_view(&mut self, name: &str) {
        let before = self.recipe.appearance.clone();
        let was_debug_view = self.is_debug_view();
        self.take_technique(name);
        if self.recipe.appearance.technique_name == name && !was_debug_view {
            self.before_debug_view = Some(before);
        }
    }

    /// Whether a debug view is shown that can be left.
    #[must_use]
    pub(crate) fn is_debug_view(&self) -> bool {
        let name = self.recipe.appearance.technique_name.as_str();
        self.before_debug_view.is_some() && DEBUG_VIEWS.iter().any(|(view, _)| *view == name)
    }

    /// Goes back to the appearance before the debug view.
    pub(crate) fn leave_debug_view(&mut self) {
        let is_debug_view = self.is_debug_view();
        if let Some(before) = self.before_debug_view.take().filter(|_| is_debug_view) {
            let now = &self.recipe.appearance;
            // The light may have changed since.
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

    /// Shows a side, and fits the models into the picture.
    pub(crate) fn go_to_side(&mut self, view: NamedView) {
        if let Some(from) = self.recipe.viewpoint {
            let up = self.remembered.up;
            self.ask(Request::GoTo(self.fitted(&from.from_side(view, up))));
        }
    }

    /// Goes to the default view.
    pub(crate) fn go_home(&mut self) {
        if let Some(scene) = &self.scene {
            let up = self.remembered.up;
            let home = Viewpoint::default_view(&scene.bounds, &scene.frame, up);
            self.ask(Request::GoTo(home));
        }
    }

    /// The viewpoint moved so that all models are visible.
    #[must_use]
    pub fn fitted(&self, view: &Viewpoint) -> Viewpoint {
        match &self.scene {
            Some(scene) => view.fitted(&scene.bounds, &scene.frame),
            None => *view,
        }
    }

    /// The command line that draws this picture in a size; `None` as for [`Recipe::words`].
    #[must_use]
    pub fn command(&self, size: [u32; 2]) -> Option<String> {
        Some(render_command(self.recipe.words()?, size))
    }

    /// Records changes for undo; called in every frame with the window's time in seconds.
    pub fn watch_changes(&mut self, time: f64) {
        self.undoer.feed_state(time, &self.recipe.appearance);
    }

    /// Whether a change can be undone.
    #[must_use]
    pub(crate) fn has_undo(&self) -> bool {
        self.undoer.has_undo(&self.recipe.appearance)
    }

    /// Whether an undone change can be redone.
    #[must_use]
    pub(crate) fn has_redo(&self) -> bool {
        self.undoer.has_redo(&self.recipe.appearance)
    }

    /// Undoes the last change.
    pub(crate) fn undo(&mut self) {
        if let Some(before) = self.undoer.undo(&self.recipe.appearance).cloned() {
            self.recipe.appearance = before;
        }
    }

    /// Redoes the last undone change.
    pub(crate) fn redo(&mut self) {
        if let Some(after) = self.undoer.redo(&self.recipe.appearance).cloned() {
            self.recipe.appearance = after;
        }
    }

    /// Keeps the statistics of a picture; a slow pass is reported.
    pub fn keep(&mut self, statistics: FrameStatistics) {
        let times = statistics.passes.iter().filter_map(|(name, ms)| Some((name, (*ms)?)));
        let slowest = times.max_by(|one, other| one.1.total_cmp(&other.1));
        if let Some((name, ms)) = slowest.filter(|(_, ms)| *ms > SLOW_MS) {
            let seconds = ms / 1e3;
            self.messages.note(format!(
                "the pass '{name}' took {seconds:.1} s, which blocked the window; it can be \
                 switched off under Look"
            ));
        }
        if self.statistics.len() == KEPT_FRAMES {
            self.statistics.remove(0);
        }
        self.statistics.push(statistics);
    }
}
