//! Techniques: text files that describe a picture as a list of passes (NPRView thesis,
//! chapter 2). Nothing here uses the GPU.
//!
//! ```text
//!   component files --> descriptors --+
//!   technique file  ------------------+--> Technique: passes with values
//!   --set, the window ----------------+          |
//!   shader files  -------------------------------+--> Plan: checked, ready to build
//!                                                          |
//!                                              crate::pass_graph: pipelines, textures, pictures
//! ```
//!
//! - `value`, `texture_name`: types and values of variables.
//! - `descriptor`, `core`: components and their variables.
//! - `core_view`: the variables of a pass, typed, for the Rust code of its component.
//! - `library`: built-in files, and those in the user's folder.
//! - `error`: why a technique cannot be drawn.
//! - `mistake`: errors in a file, underlined in its text.
//! - `program`: shader programs, with their parameters by reflection.
//! - `loop_bound`: a limit for loops of user shaders.
//! - `plan`: a checked technique.
//! - `changes`, `write`: a changed technique as settings and as a file.

pub(crate) mod brush_file;
pub(crate) mod changes;
pub(crate) mod class_pass;
mod component_file;
pub mod core;
pub(crate) mod core_view;
pub(crate) mod descriptor;
pub(crate) mod error;
pub(crate) mod image_file;
pub mod library;
pub(crate) mod loop_bound;
pub(crate) mod mistake;
pub mod pass;
pub mod plan;
mod plan_params;
pub(crate) mod print;
pub mod program;
mod technique_file;
pub mod texture_format;
pub(crate) mod texture_name;
mod toml_file;
pub mod value;
pub(crate) mod word;
pub(crate) mod write;

use std::path::PathBuf;

pub use self::brush_file::{BrushFileError, shipped_brush};
pub use self::descriptor::{ComponentDescriptor, VariableDescriptor};
pub use self::error::{SettingError, TechniqueError};
use self::mistake::Mistake;
pub use self::mistake::Mistakes;
use self::pass::Pass;
pub use self::texture_name::TextureName;
pub use self::write::WriteTechniqueError;

/// A technique: a list of passes.
#[derive(Debug, Clone, PartialEq)]
pub struct Technique {
    /// Its name: that of its file, without the ending.
    pub name: String,
    /// What it shows, in one line for users.
    pub(crate) about: String,
    /// Its passes, in the order of drawing.
    pub passes: Vec<Pass>,
    /// The folders that are searched for its shaders and images, before the built-in ones.
    pub folders: Vec<PathBuf>,
}

impl Technique {
    /// The pass called `name`.
    #[must_use]
    pub fn pass(&self, name: &str) -> Option<&Pass> {
        self.passes.iter().find(|pass| pass.name == name)
    }

    /// Sets a variable from `PASS.VARIABLE=VALUE`, as on a command line; hyphens in names
    /// count as underscores. Returns warnings.
    ///
    /// `PASS` can also be a line class, such as `ridge` or `hidden-ridge`: the pass of
    /// strokes that draws it is split, and the new pass for this class is changed.
    ///
    /// # Errors
    /// The first mistake, with the possible names.
    pub fn set(&mut self, assignment: &str) -> Result<Mistakes, SettingError> {
        self.assign(assignment)
            .map_err(|what| SettingError { assignment: assignment.to_owned(), what })
    }

    fn assign(&mut self, assignment: &str) -> Result<Mistakes, String> {
        let parts = assignment.split_once('=').and_then(|(path, value)| {
            path.trim().split_once('.').map(|(pass, variable)| (pass, variable, value.trim()))
        });
        let Some((pass, variable, value)) = parts else {
            return Err("expected PASS.VARIABLE=VALUE".to_owned());
        };
        let (pass, variable) = (pass.replace('-', "_"), variable.replace('-', "_"));
        let targets = self.targets(&pass)?;
        let mut mistakes = Mistakes::default();
        for target in targets {
            let pass = &mut self.passes[target];
            let Some((index, descriptor)) = pass.component.variable(&variable) else {
                let message = format!("{} has no variable '{variable}'", pass.component.name);
                let mistake = Mistake::without_place(message);
                let shown = pass.component.variables.iter().filter(|known| !known.internal);
                let names: Vec<&str> = shown.map(|known| known.name.as_str()).collect();
                let mistake = mistake.names(&variable, names.iter().copied());
                return Err(one_line(&mistake, &variable, &names));
            };
            let value = descriptor.kind.parse(value)?;
            pass.set_value(index, value, None, &mut mistakes);
        }
        if let Some(error) = mistakes.list.iter().find(|m| m.severity == mistake::Severity::Error) {
            return Err(one_line(error, "", &[]));
        }
        Ok(mistakes)
    }

    /// Sets the brush of the pass `strokes`, and of passes split from it, to an image file
    /// with any ending.
    ///
    /// # Errors
    /// If there is no such pass.
    pub(crate) fn set_brush_file(&mut self, path: &str) -> Result<(), SettingError> {
        let wrong = |what| SettingError { assignment: format!("strokes.brush={path}"), what };
        let source = texture_name::TextureSource::File(path.to_owned());
        let name = texture_name::TextureName { source, is_filtered: None };
        for at in self.targets("strokes").map_err(wrong)? {
            let pass = &mut self.passes[at];
            if let Some((index, _)) = pass.component.variable("brush") {
                let value = value::Value::Texture(name.clone());
                pass.set_value(index, value, None, &mut Mistakes::default());
            }
        }
        Ok(())
    }

    /// The indices of the passes that a name in `--set` selects: the pass with this name and
    /// those split from it, or the pass of a class, which is made if there is none.
    fn targets(&mut self, name: &str) -> Result<Vec<usize>, String> {
        let is_target = |pass: &Pass| pass.name == name || pass.split_from.as_deref() == Some(name);
        let found: Vec<usize> =
            (0..self.passes.len()).filter(|&at| is_target(&self.passes[at])).collect();
        if !found.is_empty() {
            return Ok(found);
        }
        if let Some(split) = class_pass::split(&mut self.passes, name) {
            return Ok(split);
        }
        let names: Vec<&str> = self.passes.iter().map(|pass| pass.name.as_str()).collect();
        let message = match class_pass::is_class(name) {
            true => format!("no pass of {} draws '{name}'", self.name),
            false => format!("{} has no pass '{name}'", self.name),
        };
        let mistake = Mistake::without_place(message).names(name, names.iter().copied());
        Err(one_line(&mistake, name, &names))
    }
}

/// A mistake without a place, in one line.
fn one_line(mistake: &Mistake, wanted: &str, names: &[&str]) -> String {
    let guess = mistake::closest(wanted, names);
    let guess = guess.map_or_else(String::new, |name| format!(" (did you mean '{name}'?)"));
    let notes: String = mistake.notes.iter().map(|note| format!("; {note}")).collect();
    format!("{}{guess}{notes}", mistake.message)
}
