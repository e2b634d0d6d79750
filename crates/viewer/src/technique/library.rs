//! Built-in techniques and components, and those in the user's folder.
//!
//! ```text
//!   user's folder             built into the program
//!     components/*.toml         techniques/components/*.toml
//!     techniques/*.toml         techniques/*.toml
//!     shaders/*.wgsl            shaders/programs/*.wgsl
//!     images/DIRECTORY/*.png    brushes/DIRECTORY/*.png
//! ```
//!
//! A file of the user replaces a built-in one with the same name. Shaders and images of a
//! technique file that is given by its path are searched in its folder first.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use edgemesh_techniques::{COMPONENTS, TECHNIQUES};

use super::component_file::{self, ComponentDraft};
use super::descriptor::SharedDescriptor;
use super::mistake::{Mistake, Mistakes, SourceText};
use super::plan::Plan;
use super::program::ShaderFiles;
use super::{Technique, technique_file, toml_file};

/// Components and techniques by name.
#[derive(Debug, Clone)]
pub struct Library {
    components: BTreeMap<String, SharedDescriptor>,
    techniques: BTreeMap<String, Arc<SourceText>>,
    /// The user's folder.
    folder: Option<PathBuf>,
    mistakes: Mistakes,
}

impl Library {
    /// The built-in files alone.
    #[must_use]
    pub fn shipped() -> Self {
        Self::load(None)
    }

    /// The built-in files and those in `folder`. Mistakes in the user's component files are
    /// in [`Self::mistakes`]; all other components can be used.
    #[must_use]
    pub(crate) fn load(folder: Option<&Path>) -> Self {
        let mut mistakes = Mistakes::default();
        let shipped = COMPONENTS.iter().map(|(name, text)| {
            SourceText::new(format!("techniques/components/{name}.toml"), *text)
        });
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

    /// The user's folder by default: `edgemesh` in `$XDG_CONFIG_HOME` or `~/.config`; `None`
    /// if it does not exist.
    #[must_use]
    pub(crate) fn default_folder() -> Option<PathBuf> {
        let config = std::env::var_os("XDG_CONFIG_HOME").filter(|path| !path.is_empty());
        let home = || Some(PathBuf::from(std::env::var_os("HOME")?).join(".config"));
        let folder = config.map(PathBuf::from).or_else(home)?.join("edgemesh");
        folder.is_dir().then_some(folder)
    }

    /// The mistakes in component files.
    #[must_use]
    pub(crate) const fn mistakes(&self) -> &Mistakes {
        &self.mistakes
    }

    /// All components by name.
    #[must_use]
    pub const fn components(&self) -> &BTreeMap<String, SharedDescriptor> {
        &self.components
    }

    /// The names of all techniques, sorted.
    pub fn technique_names(&self) -> impl Iterator<Item = &str> {
        self.techniques.keys().map(String::as_str)
    }

    /// Reads a technique by its name (with hyphens or underscores) or by the path of its
    /// file. Returns warnings too.
    ///
    /// # Errors
    /// An unknown name, or all mistakes in the file.
    pub fn technique(&self, name: &str) -> Result<(Technique, Mistakes), Mistakes> {
        let is_path = name.ends_with(".toml") || name.contains(std::path::MAIN_SEPARATOR);
        if is_path {
            return self.technique_file(Path::new(name));
        }
        let known = name.replace('-', "_");
        let Some(source) = self.techniques.get(&known) else {
            let mistake = Mistake::without_place(format!("unknown technique '{name}'"));
            let note = "give your own technique as a file, such as mine.toml";
            return Err(Mistakes::of(mistake.names(name, self.technique_names()).note(note)));
        };
        self.read(&known, source, None)
    }

    /// Reads a technique from a file. Returns warnings too.
    ///
    /// # Errors
    /// If the file cannot be read, or all mistakes in it.
    pub fn technique_file(&self, path: &Path) -> Result<(Technique, Mistakes), Mistakes> {
        let source = SourceText::read(path).map_err(Mistakes::of)?;
        let name = path.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
        let folder = path.parent().map_or_else(PathBuf::new, Path::to_owned);
        self.read(&name, &source, Some(folder))
    }

    /// All mistakes in a technique file, in its shaders and in its images; `shaders` is a
    /// folder that replaces the built-in shaders.
    #[must_use]
    pub fn check(&self, path: &Path, shaders: Option<&Path>) -> Mistakes {
        let source = match SourceText::read(path) {
            Ok(source) => source,
            Err(mistake) => return Mistakes::of(mistake),
        };
        let mut mistakes = Mistakes::default();
        let (mut technique, is_complete) =
            technique_file::read("", &source, &self.components, &mut mistakes);
        let folder = path.parent().map_or_else(PathBuf::new, Path::to_owned);
        technique.folders = std::iter::once(folder).chain(self.folder.clone()).collect();
        // Without all passes, further mistakes would only follow from the first ones.
        if is_complete {
            let shaders = ShaderFiles::new(&technique.folders, shaders.map(Path::to_owned));
            mistakes.append(match Plan::of(&technique, &shaders) {
                Ok(plan) => plan.warnings,
                Err(mistakes) => mistakes,
            });
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
            // An unknown component can be one with a mistake in its file.
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
                let message = format!("unknown key '{}' in a component file", entry.key);
                let mistake = Mistake::error(&entry.place, message);
                mistakes.add(mistake.names(&entry.key, ["component"]));
            }
        }
    }
    drafts
}

/// The TOML files in a folder by their names without the ending, sorted; none if there is
/// no such folder.
fn toml_texts(folder: &Path, mistakes: &mut Mistakes) -> Vec<(String, Arc<SourceText>)> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
    paths.sort();
    let mut texts = Vec::new();
    for path in paths {
        match SourceText::read(&path) {
            Ok(source) => {
                let name = path.file_stem().unwrap_or_default().to_string_lossy();
                texts.push((name.replace('-', "_"), source));
            }
            Err(mistake) => mistakes.add(mistake),
        }
    }
    texts
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
            assert!(!technique.about.is_empty(), "{name} has a description");
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
        assert_eq!(program(&simple), None, "every pass must set it");
        assert_eq!(program(&phong), Some(Value::String("phong:phong".into())));
        let deep = component("edge_detect_normals_5_taps");
        let threshold = deep.variable("threshold").unwrap().1;
        assert_eq!(threshold.default, Some(Value::Numbers(vec![0.85])));
        assert_eq!(threshold.minimum, Some(Value::Numbers(vec![-1.0])), "inherited");
        assert_eq!(threshold.ui_minimum, threshold.minimum, "a limit is also that of sliders");
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
