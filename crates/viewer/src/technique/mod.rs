//! Techniques: how a picture is made, as passes of components (NPRView thesis,
//! chapter 2).
//!
//! ```text
//!   component files --> descriptors --+
//!   technique file  ------------------+--> Technique: passes with values
//!   --set, the window ----------------+          |
//!   shader files  -------------------------------+--> Plan: checked, nothing run yet
//!                                                          |
//!                                              crate::pass_graph: pipelines, textures, pictures
//! ```
//!
//! - [`value`], [`texture_name`]: types and values of variables.
//! - [`descriptor`], [`core`]: the interface of a component, and what is in Rust.
//! - [`library`]: the files that are shipped, and the user's own.
//! - [`error`]: why a technique cannot be drawn.
//! - [`mistake`]: everything that is wrong with a file, underlined.
//! - [`loop_bound`]: loops of shaders that end.
//! - [`program`]: what a shader wants to be given.
//! - [`plan`]: a technique with everything checked.
//! - [`changes`], [`mod@write`]: a technique that was changed, as settings and as a file.

pub mod brush_file;
pub mod changes;
pub(crate) mod class_pass;
mod component_file;
pub mod core;
pub(crate) mod curve;
pub mod descriptor;
pub mod error;
pub mod image_file;
pub mod library;
pub mod loop_bound;
pub mod mistake;
pub mod pass;
pub mod plan;
mod plan_params;
pub mod print;
pub mod program;
mod technique_file;
pub mod texture_format;
pub mod texture_name;
mod toml_file;
pub mod value;
pub mod write;

use std::path::PathBuf;

use self::error::SettingError;
use self::mistake::{Mistake, Mistakes};
use self::pass::Pass;

/// A technique: passes in order.
#[derive(Debug, Clone, PartialEq)]
pub struct Technique {
    /// Its name: that of its file.
    pub name: String,
    /// What it shows.
    pub about: String,
    /// Its passes, in the order in which they are done.
    pub passes: Vec<Pass>,
    /// Where its shaders and images are looked for, before those that are shipped.
    pub folders: Vec<PathBuf>,
}

impl Technique {
    /// The pass of a name.
    #[must_use]
    pub fn pass(&self, name: &str) -> Option<&Pass> {
        self.passes.iter().find(|pass| pass.name == name)
    }

    /// Sets a variable from `PASS.VARIABLE=VALUE`, as command lines have it; a hyphen
    /// is as good as an underscore.
    ///
    /// A class of edges (`ridge`, `hidden-ridge`) is given a pass of its own, which is
    /// that of the strokes it was drawn by, and changed there.
    ///
    /// # Errors
    /// [`SettingError`], with the names that exist.
    pub fn set(&mut self, assignment: &str) -> Result<Mistakes, SettingError> {
        self.assign(assignment)
            .map_err(|what| SettingError { assignment: assignment.to_owned(), what })
    }

    fn assign(&mut self, assignment: &str) -> Result<Mistakes, String> {
        let parts = assignment.split_once('=').and_then(|(path, value)| {
            path.trim().split_once('.').map(|(pass, variable)| (pass, variable, value.trim()))
        });
        let Some((pass, variable, value)) = parts else {
            return Err("needs the form PASS.VARIABLE=VALUE".to_owned());
        };
        let (pass, variable) = (pass.replace('-', "_"), variable.replace('-', "_"));
        let targets = self.targets(&pass)?;
        let mut mistakes = Mistakes::default();
        for target in targets {
            let pass = &mut self.passes[target];
            let Some((index, descriptor)) = pass.component.variable(&variable) else {
                let list = Mistake::without_place(format!(
                    "{} has no variable '{variable}'",
                    pass.component.name
                ));
                let shown = pass.component.variables.iter().filter(|known| !known.internal);
                let names: Vec<&str> = shown.map(|known| known.name.as_str()).collect();
                return Err(told(&list.names(&variable, names.iter().copied()), &variable, &names));
            };
            let value = descriptor.kind.parse(value)?;
            pass.set_value(index, value, None, &mut mistakes);
        }
        if let Some(error) = mistakes.list.iter().find(|m| m.severity == mistake::Severity::Error) {
            return Err(told(error, "", &[]));
        }
        Ok(mistakes)
    }

    /// Lays a picture file on all visible strokes, whatever its name ends in.
    ///
    /// # Errors
    /// [`SettingError`], if no pass has visible strokes.
    pub fn set_brush_file(&mut self, path: &str) -> Result<(), SettingError> {
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

    /// The passes that a name of `--set` stands for: that of the name and those split
    /// from it, or the one that a class is given.
    fn targets(&mut self, name: &str) -> Result<Vec<usize>, String> {
        let is_meant = |pass: &Pass| pass.name == name || pass.split_from.as_deref() == Some(name);
        let found: Vec<usize> =
            (0..self.passes.len()).filter(|&at| is_meant(&self.passes[at])).collect();
        if !found.is_empty() {
            return Ok(found);
        }
        if let Some(split) = class_pass::split(&mut self.passes, name) {
            return Ok(split);
        }
        let names: Vec<&str> = self.passes.iter().map(|pass| pass.name.as_str()).collect();
        let what = match class_pass::is_class(name) {
            true => format!("no pass of {} draws '{name}'", self.name),
            false => format!("{} has no pass '{name}'", self.name),
        };
        let mistake = Mistake::without_place(what).names(name, names.iter().copied());
        Err(told(&mistake, name, &names))
    }
}

/// A mistake of a command line in one line.
fn told(mistake: &Mistake, wanted: &str, names: &[&str]) -> String {
    let guess = mistake::closest(wanted, names);
    let guess = guess.map_or_else(String::new, |name| format!(" (did you mean '{name}'?)"));
    let notes: String = mistake.notes.iter().map(|note| format!("; {note}")).collect();
    format!("{}{guess}{notes}", mistake.message)
}
