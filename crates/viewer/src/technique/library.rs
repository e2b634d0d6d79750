//! The files of techniques, components, shaders and images: those that are shipped, and
//! the user's own beside them.
//!
//! ```text
//!   own folder                shipped (in the program)
//!     components/*.toml         techniques/components/*.toml
//!     techniques/*.toml         techniques/*.toml
//!     shaders/*.wgsl            shaders/programs/*.wgsl
//!     images/DIRECTORY/*.png    brushes/DIRECTORY/*.png
//! ```
//!
//! What the user has wins over what is shipped under the same name. Beside a technique
//! file that is named by its path, shaders and images are looked for first.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::component_file::{self, ComponentDraft};
use super::descriptor::SharedDescriptor;
use super::mistake::{Mistake, Mistakes, SourceText};
use super::plan::Plan;
use super::program::ShaderFiles;
use super::{Technique, technique_file, toml_file};

macro_rules! shipped {
    ($($path:literal),* $(,)?) => {
        &[$(($path, include_str!(concat!("../../../../techniques/", $path, ".toml")))),*]
    };
}

/// The component files that are shipped, and their texts.
const COMPONENTS: &[(&str, &str)] =
    shipped!["components/core", "components/detectors", "components/fills", "components/lines",];

/// The techniques that are shipped, and their texts.
const TECHNIQUES: &[(&str, &str)] = shipped![
    "anime",
    "blueprint",
    "cartoon",
    "charcoal",
    "debug_depth",
    "debug_features",
    "debug_ids",
    "debug_normals",
    "fins",
    "fur",
    "gooch",
    "hatching",
    "hidden_line",
    "ink",
    "linked",
    "outline_combined",
    "outline_depth",
    "outline_ids",
    "outline_laplacian",
    "outline_normals",
    "outline_planes",
    "outline_thick",
    "outline_wide",
    "pen",
    "phong",
    "sobel",
    "toon",
    "toon_image",
    "watercolour",
    "wireframe",
];

/// Components and techniques by name.
#[derive(Debug, Clone)]
pub struct Library {
    components: BTreeMap<String, SharedDescriptor>,
    techniques: BTreeMap<String, Arc<SourceText>>,
    /// The user's own folder.
    folder: Option<PathBuf>,
    mistakes: Mistakes,
}

impl Library {
    /// What is shipped.
    #[must_use]
    pub fn shipped() -> Self {
        Self::load(None)
    }

    /// What is shipped, and what `folder` has. What is wrong with the user's component
    /// files is in [`Self::mistakes`]; their other components can be used.
    #[must_use]
    pub fn load(folder: Option<&Path>) -> Self {
        let mut mistakes = Mistakes::default();
        let shipped = COMPONENTS
            .iter()
            .map(|(name, text)| SourceText::new(format!("techniques/{name}.toml"), *text));
        let drafts = drafts(&shipped.collect::<Vec<_>>(), &mut mistakes);
        let made = component_file::resolve(&drafts, &BTreeMap::new(), &mut mistakes);
        let sound = |made: BTreeMap<String, Option<SharedDescriptor>>| {
            made.into_iter().filter_map(|(name, made)| Some((name, made?)))
        };
        let mut components: BTreeMap<String, SharedDescriptor> = sound(made).collect();
        let mut techniques: BTreeMap<String, Arc<SourceText>> = TECHNIQUES
            .iter()
            .map(|(name, text)| {
                let source = SourceText::new(format!("techniques/{name}.toml"), *text);
                ((*name).to_owned(), source)
            })
            .collect();
        if let Some(folder) = folder {
            let own = toml_texts(&folder.join("components"), &mut mistakes);
            let own: Vec<Arc<SourceText>> = own.into_iter().map(|(_, source)| source).collect();
            let drafts = self::drafts(&own, &mut mistakes);
            let own = component_file::resolve(&drafts, &components, &mut mistakes);
            components.extend(sound(own));
            techniques.extend(toml_texts(&folder.join("techniques"), &mut mistakes));
        }
        Self { components, techniques, folder: folder.map(Path::to_owned), mistakes }
    }

    /// The user's own folder where nothing else is said: `edgemesh` in the folder for
    /// settings, by `XDG_CONFIG_HOME`, or `.config` at home.
    #[must_use]
    pub fn default_folder() -> Option<PathBuf> {
        let config = std::env::var_os("XDG_CONFIG_HOME").filter(|path| !path.is_empty());
        let home = || Some(PathBuf::from(std::env::var_os("HOME")?).join(".config"));
        let folder = config.map(PathBuf::from).or_else(home)?.join("edgemesh");
        folder.is_dir().then_some(folder)
    }

    /// What is wrong with the component files.
    #[must_use]
    pub const fn mistakes(&self) -> &Mistakes {
        &self.mistakes
    }

    /// The user's own folder.
    #[must_use]
    pub fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// All components by name.
    #[must_use]
    pub const fn components(&self) -> &BTreeMap<String, SharedDescriptor> {
        &self.components
    }

    /// The names of all techniques.
    pub fn technique_names(&self) -> impl Iterator<Item = &str> {
        self.techniques.keys().map(String::as_str)
    }

    /// A technique by its name (with hyphens or underscores), or by the path of its file.
    ///
    /// # Errors
    /// Where there is none, or something in its file is wrong.
    pub fn technique(&self, name: &str) -> Result<(Technique, Mistakes), Mistakes> {
        let is_path = name.ends_with(".toml") || name.contains(std::path::MAIN_SEPARATOR);
        if is_path {
            return self.technique_file(Path::new(name));
        }
        let known = name.replace('-', "_");
        let Some(source) = self.techniques.get(&known) else {
            let mistake = Mistake::without_place(format!("there is no technique '{name}'"));
            let note = "a technique of your own is named by its file, as mine.toml";
            return Err(Mistakes::of(mistake.names(name, self.technique_names()).note(note)));
        };
        self.read(&known, source, None)
    }

    /// A technique from a file.
    ///
    /// # Errors
    /// Where it cannot be read, or something in it is wrong.
    pub fn technique_file(&self, path: &Path) -> Result<(Technique, Mistakes), Mistakes> {
        let source = text_of(path).map_err(Mistakes::of)?;
        let name = path.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
        let folder = path.parent().map_or_else(PathBuf::new, Path::to_owned);
        self.read(&name, &source, Some(folder))
    }

    /// Everything that is wrong with a technique file, its shaders and its images;
    /// `shaders` stands for the folder of those that ship.
    #[must_use]
    pub fn check(&self, path: &Path, shaders: Option<&Path>) -> Mistakes {
        let source = match text_of(path) {
            Ok(source) => source,
            Err(mistake) => return Mistakes::of(mistake),
        };
        let mut mistakes = Mistakes::default();
        let (mut technique, is_whole) =
            technique_file::read("", &source, &self.components, &mut mistakes);
        let folder = path.parent().map_or_else(PathBuf::new, Path::to_owned);
        technique.folders = std::iter::once(folder).chain(self.folder.clone()).collect();
        // What lacks a pass would only have mistakes that follow from that.
        if is_whole {
            let shaders = ShaderFiles::new(&technique.folders, shaders.map(Path::to_owned));
            if let Err(others) = Plan::of(&technique, &shaders) {
                mistakes.append(others);
            }
        }
        mistakes
    }

    fn read(
        &self,
        name: &str,
        source: &Arc<SourceText>,
        folder: Option<PathBuf>,
    ) -> Result<(Technique, Mistakes), Mistakes> {
        let mut mistakes = Mistakes::default();
        let (mut technique, _) =
            technique_file::read(name, source, &self.components, &mut mistakes);
        technique.folders = folder.into_iter().chain(self.folder.clone()).collect();
        if mistakes.has_errors() {
            // A component that is missing may be one that could not be read.
            mistakes.append(self.mistakes.clone());
        }
        mistakes.or(technique)
    }
}

fn drafts(sources: &[Arc<SourceText>], mistakes: &mut Mistakes) -> Vec<ComponentDraft> {
    let mut drafts = Vec::new();
    for source in sources {
        for entry in toml_file::parse(source, mistakes) {
            if entry.key == "component" {
                drafts.extend(component_file::drafts(&entry.node, mistakes));
            } else {
                let message = format!("a component file has no '{}'", entry.key);
                let mistake = Mistake::error(&entry.place, message);
                mistakes.add(mistake.names(&entry.key, ["component"]));
            }
        }
    }
    drafts
}

/// The TOML files of a folder by their names without the ending, in order; none where
/// there is no such folder.
fn toml_texts(folder: &Path, mistakes: &mut Mistakes) -> Vec<(String, Arc<SourceText>)> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
    paths.sort();
    let mut texts = Vec::new();
    for path in paths {
        match text_of(&path) {
            Ok(source) => {
                let name = path.file_stem().unwrap_or_default().to_string_lossy();
                texts.push((name.replace('-', "_"), source));
            }
            Err(mistake) => mistakes.add(mistake),
        }
    }
    texts
}

/// The text of a file.
pub(crate) fn text_of(path: &Path) -> Result<Arc<SourceText>, Mistake> {
    let name = path.display().to_string();
    let failed = |error: &dyn std::fmt::Display| {
        Mistake::without_place(format!("{name}: cannot be read: {error}"))
    };
    let bytes = std::fs::read(path).map_err(|error| failed(&error))?;
    let text = String::from_utf8(bytes).map_err(|_| failed(&"it is not text in UTF-8"))?;
    Ok(SourceText::new(name, text))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::technique::value::Value;

    #[test]
    fn everything_that_ships_is_sound() {
        let library = Library::shipped();
        assert_eq!(library.mistakes(), &Mistakes::default());
        let names: Vec<&str> = library.technique_names().collect();
        assert!(names.len() >= 30, "{names:?}");
        for name in names {
            let (technique, warnings) =
                library.technique(name).unwrap_or_else(|mistakes| panic!("{mistakes}"));
            assert_eq!(warnings, Mistakes::default(), "{name}");
            assert!(!technique.about.is_empty(), "{name} says what it shows");
            Plan::of(&technique, &ShaderFiles::default())
                .unwrap_or_else(|mistakes| panic!("{name}: {mistakes}"));
        }
    }

    #[test]
    fn components_inherit_variables_and_what_they_modify() {
        let library = Library::shipped();
        let component = |name: &str| library.components()[name].clone();
        let (phong, simple) = (component("render_phong"), component("simple_render"));
        assert_eq!((phong.core, phong.inherits.as_deref()), (simple.core, Some("simple_render")));
        let program =
            |of: &SharedDescriptor| of.variable("fragment_program").unwrap().1.default.clone();
        assert_eq!(program(&simple), None, "each pass must set it");
        assert_eq!(program(&phong), Some(Value::String("phong:phong".into())));
        let deep = component("edge_detect_normals_5_taps");
        let threshold = deep.variable("threshold").unwrap().1;
        assert_eq!(threshold.default, Some(Value::Numbers(vec![0.85])));
        assert_eq!(threshold.minimum, Some(Value::Numbers(vec![-1.0])), "of its parent");
        assert_eq!(threshold.ui_minimum, threshold.minimum, "a limit is that of the slider");
        assert_eq!(threshold.ui_maximum, Some(Value::Numbers(vec![1.0])), "unless it is set");
        for name in ["render", "run"] {
            assert!(deep.variable(name).is_some(), "every pass has {name}");
        }
    }

    #[test]
    fn passes_without_a_name_have_that_of_their_component() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("two.toml");
        let pass = "[[pass]]\ncomponent = \"render_flat\"\n";
        std::fs::write(&path, [pass, pass].concat()).unwrap();
        let technique = Library::shipped().technique_file(&path).unwrap().0;
        let names: Vec<&str> = technique.passes.iter().map(|pass| pass.name.as_str()).collect();
        assert_eq!((technique.name.as_str(), names), ("two", vec!["render_flat", "render_flat_2"]));
    }
}
