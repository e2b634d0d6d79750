//! Component descriptors: the interface to a component (NPRView thesis, section
//! 2.2.1).
//!
//! ```text
//!   core component (in Rust) <-- descriptor: its variables, their types and limits
//!                                    ^
//!                                    | inherits, modifies
//!                                descriptor of a component that has no Rust of its own
//! ```

use std::sync::Arc;

use super::core::CoreComponent;
use super::mistake::Place;
use super::texture_name::{TextureName, TextureSource};
use super::value::{Value, VariableType};

/// What is known of a variable of a component.
#[derive(Debug, Clone, PartialEq)]
pub struct VariableDescriptor {
    /// Its name.
    pub name: String,
    /// Its type.
    pub kind: VariableType,
    /// What it does.
    pub about: String,
    /// Its value where a pass sets none; without one every pass must set it.
    pub default: Option<Value>,
    /// The least value, component by component.
    pub minimum: Option<Value>,
    /// The largest value.
    pub maximum: Option<Value>,
    /// Where sliders begin; the minimum, unless it is set.
    pub ui_minimum: Option<Value>,
    /// Where sliders end; the maximum, unless it is set.
    pub ui_maximum: Option<Value>,
    /// Shown and not to be changed.
    pub read_only: bool,
    /// Not shown.
    pub internal: bool,
    /// Bound to the field of this name in the parameters of the vertex program.
    pub vertex_parameter: bool,
    /// Bound to the field of this name in the parameters of the fragment program.
    pub fragment_parameter: bool,
    /// The words that a string can be; empty where any will do. As a parameter, the
    /// number of the word.
    pub one_of: Vec<String>,
    /// The directory of images that bare names are taken from.
    pub directory: Option<String>,
    /// Where it was described.
    pub place: Place,
}

impl VariableDescriptor {
    /// A variable without any properties.
    #[must_use]
    pub fn new(name: &str, kind: VariableType, place: Place) -> Self {
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

    /// Whether a shader is given its value.
    #[must_use]
    pub const fn is_parameter(&self) -> bool {
        self.vertex_parameter || self.fragment_parameter
    }

    /// A value with the variable's own directory, where it is an image without one;
    /// `None` where the variable has none.
    #[must_use]
    pub fn in_directory(&self, value: Value) -> Option<Value> {
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

    /// The number of a word among those that the string can be.
    #[must_use]
    pub fn word_index(&self, word: &str) -> Option<usize> {
        self.one_of.iter().position(|known| known == word)
    }
}

/// The interface to a component.
#[derive(Debug, Clone, PartialEq)]
pub struct ComponentDescriptor {
    /// Its name.
    pub name: String,
    /// What it does.
    pub about: String,
    /// What implements it.
    pub core: CoreComponent,
    /// The component that it modifies; `None` for the descriptors of core components.
    pub inherits: Option<String>,
    /// Its variables: those it inherits, then its own.
    pub variables: Vec<VariableDescriptor>,
    /// Where it was described.
    pub place: Place,
}

impl ComponentDescriptor {
    /// A variable and its number.
    #[must_use]
    pub fn variable(&self, name: &str) -> Option<(usize, &VariableDescriptor)> {
        self.variables.iter().enumerate().find(|(_, variable)| variable.name == name)
    }

    /// The names of the variables.
    pub fn variable_names(&self) -> impl Iterator<Item = &str> {
        self.variables.iter().map(|variable| variable.name.as_str())
    }

    /// The variables whose values shaders are given.
    pub fn parameters(&self) -> impl Iterator<Item = (usize, &VariableDescriptor)> {
        self.variables.iter().enumerate().filter(|(_, variable)| variable.is_parameter())
    }

    /// The variables that are textures to read.
    pub fn textures(&self) -> impl Iterator<Item = (usize, &VariableDescriptor)> {
        let all = self.variables.iter().enumerate();
        all.filter(|(_, variable)| variable.kind == VariableType::Texture)
    }
}

/// The variables that every pass has, whatever its component: `render`, by which a pass
/// is left out, and `run`, by which it is done once, or only when a variable changes.
#[must_use]
pub fn automatic_variables(place: &Place) -> Vec<VariableDescriptor> {
    let mut render = VariableDescriptor::new("render", VariableType::Bool, place.clone());
    render.about = "whether the pass is done".into();
    render.default = Some(Value::Bool(true));
    let mut run = VariableDescriptor::new("run", VariableType::String, place.clone());
    run.about = "always, once, or when a variable of the pass has changed".into();
    run.default = Some(Value::String("always".into()));
    run.one_of = ["always", "once", "changed"].map(str::to_owned).into();
    run.internal = true;
    vec![render, run]
}

/// A shared descriptor.
pub type SharedDescriptor = Arc<ComponentDescriptor>;
