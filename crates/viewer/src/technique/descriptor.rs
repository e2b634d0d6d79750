//! Component descriptors: the variables of a component (NPRView thesis, section 2.2.1).
//!
//! ```text
//!   core component (in Rust) <-- descriptor: its variables, their types and limits
//!                                    ^
//!                                    | inherits, modifies
//!                                descriptor of a component without Rust code
//! ```

use std::sync::Arc;

use super::core::CoreComponent;
use super::core_view::RunMode;
use super::mistake::Place;
use super::texture_name::{TextureName, TextureSource};
use super::value::{Value, VariableType};
use super::word::Word as _;

/// A variable of a component.
#[derive(Debug, Clone, PartialEq)]
pub struct VariableDescriptor {
    /// Its name.
    pub name: String,
    /// Its type.
    pub kind: VariableType,
    /// What it does, in one line for users.
    pub(crate) about: String,
    /// Its value in passes that do not set it; without a default every pass must set it.
    pub default: Option<Value>,
    /// The smallest value, per component of a vector.
    pub(crate) minimum: Option<Value>,
    /// The largest value, per component of a vector.
    pub(crate) maximum: Option<Value>,
    /// The low end of sliders; the minimum if it is not set.
    pub(crate) ui_minimum: Option<Value>,
    /// The high end of sliders; the maximum if it is not set.
    pub(crate) ui_maximum: Option<Value>,
    /// Whether the window shows it without a way to change it.
    pub(crate) read_only: bool,
    /// Whether the window hides it.
    pub internal: bool,
    /// Whether its value goes to the field of this name in the vertex program's `Params`.
    pub(crate) vertex_parameter: bool,
    /// Whether its value goes to the field of this name in the fragment program's
    /// `Params`.
    pub(crate) fragment_parameter: bool,
    /// The allowed values of a string; empty if all are allowed. A shader gets the index.
    pub(crate) one_of: Vec<String>,
    /// The image directory that bare image names are searched in.
    pub(crate) directory: Option<String>,
    /// The place of its description.
    pub(crate) place: Place,
}

impl VariableDescriptor {
    /// A variable with a name and a type and no other properties.
    #[must_use]
    pub(crate) fn new(name: &str, kind: VariableType, place: Place) -> Self {
        Self {
            name: name.to_owned(),
            kind,
            about: String::new(),
            default: None,
            minimum: None,
            maximum: None,
            ui_minimum: None,
            ui_maximum: None,
            read_only: false,
            internal: false,
            vertex_parameter: false,
            fragment_parameter: false,
            one_of: Vec::new(),
            directory: None,
            place,
        }
    }

    /// Whether its value goes to a shader.
    #[must_use]
    pub(crate) const fn is_parameter(&self) -> bool {
        self.vertex_parameter || self.fragment_parameter
    }

    /// Adds the variable's directory to an image without one and returns all other values
    /// unchanged. Returns none for such an image if the variable has no directory.
    #[must_use]
    pub(crate) fn in_directory(&self, value: Value) -> Option<Value> {
        let Value::Texture(TextureName {
            source: TextureSource::Image { directory: None, image },
            is_filtered,
        }) = value
        else {
            return Some(value);
        };
        let source = TextureSource::Image { directory: Some(self.directory.clone()?), image };
        Some(Value::Texture(TextureName { source, is_filtered }))
    }

    /// The index of a word in [`Self::one_of`].
    #[must_use]
    pub(crate) fn word_index(&self, word: &str) -> Option<usize> {
        self.one_of.iter().position(|known| known == word)
    }
}

/// A component: its variables and the core component that implements it.
#[derive(Debug, Clone, PartialEq)]
pub struct ComponentDescriptor {
    /// Its name.
    pub(crate) name: String,
    /// What it does, in one line for users.
    pub(crate) about: String,
    /// The core component that implements it.
    pub core: CoreComponent,
    /// The component that it modifies; none for core components.
    pub(crate) inherits: Option<String>,
    /// Its variables: inherited ones first.
    pub variables: Vec<VariableDescriptor>,
    /// The place of its description.
    pub(crate) place: Place,
}

impl ComponentDescriptor {
    /// A variable by its name, with its index.
    #[must_use]
    pub fn variable(&self, name: &str) -> Option<(usize, &VariableDescriptor)> {
        self.variables.iter().enumerate().find(|(_, variable)| variable.name == name)
    }

    /// The names of all variables, in order.
    pub(crate) fn variable_names(&self) -> impl Iterator<Item = &str> {
        self.variables.iter().map(|variable| variable.name.as_str())
    }

    /// The variables whose values go to shaders, with their indices.
    pub(crate) fn parameters(&self) -> impl Iterator<Item = (usize, &VariableDescriptor)> {
        self.variables.iter().enumerate().filter(|(_, variable)| variable.is_parameter())
    }

    /// The texture variables, with their indices.
    pub(crate) fn textures(&self) -> impl Iterator<Item = (usize, &VariableDescriptor)> {
        let all = self.variables.iter().enumerate();
        all.filter(|(_, variable)| variable.kind == VariableType::Texture)
    }
}

/// The variable of every pass that switches it on.
pub(super) const RENDER: &str = "render";

/// The variables of every pass, whatever its component: `render`, which switches it on,
/// and `run`, a [`RunMode`].
#[must_use]
pub(crate) fn automatic_variables(place: &Place) -> Vec<VariableDescriptor> {
    let mut render = VariableDescriptor::new(RENDER, VariableType::Bool, place.clone());
    render.about = "draw this pass".into();
    render.default = Some(Value::Bool(true));
    let mut run = VariableDescriptor::new(RunMode::VARIABLE, VariableType::String, place.clone());
    run.about = "always, once, or when a variable of the pass has changed".into();
    run.default = Some(Value::String(RunMode::Always.word().to_owned()));
    run.one_of = RunMode::WORDS.iter().map(|(word, _)| (*word).to_owned()).collect();
    run.internal = true;
    vec![render, run]
}

/// A descriptor that passes share.
pub(crate) type SharedDescriptor = Arc<ComponentDescriptor>;
