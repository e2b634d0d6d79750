//! A pass: a component with the values of its variables.

use std::sync::Arc;

use super::descriptor::{RENDER, SharedDescriptor, VariableDescriptor};
use super::mistake::{Mistake, Mistakes, Place};
use super::value::Value;

/// A pass of a technique.
#[derive(Debug, Clone)]
pub struct Pass {
    /// Its name, unique in the technique.
    pub name: String,
    /// The descriptor of its component.
    pub component: SharedDescriptor,
    /// One value per variable of the component.
    values: Vec<Value>,
    /// Where each value was set; none for defaults and command lines.
    places: Vec<Option<Place>>,
    /// The place of the pass in its file.
    pub(crate) place: Place,
    /// The pass that this one was split from for a line class, if any.
    pub(crate) split_from: Option<String>,
}

/// Compares what passes do; the places of values do not count.
impl PartialEq for Pass {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
            && (Arc::ptr_eq(&self.component, &other.component) || self.component == other.component)
            && self.values == other.values
            && self.split_from == other.split_from
    }
}

/// A value for the variable at `index` of a component.
#[derive(Debug, Clone)]
pub(crate) struct Assignment {
    pub(crate) index: usize,
    pub(crate) value: Value,
    pub(crate) place: Option<Place>,
}

impl Pass {
    /// Makes a pass of the assigned values and the defaults of all other variables. A
    /// variable with neither is a mistake.
    pub(crate) fn new(
        name: String,
        component: SharedDescriptor,
        place: Place,
        assignments: Vec<Assignment>,
        mistakes: &mut Mistakes,
    ) -> Option<Self> {
        let count = component.variables.len();
        let mut values: Vec<Option<Value>> =
            component.variables.iter().map(|variable| variable.default.clone()).collect();
        let mut places = vec![None; count];
        let mut wrong = vec![false; count];
        for assignment in assignments {
            let variable = &component.variables[assignment.index];
            let at = assignment.place.as_ref();
            match checked(variable, assignment.value, at, mistakes) {
                Some(value) => values[assignment.index] = Some(value),
                None => wrong[assignment.index] = true,
            }
            places[assignment.index] = assignment.place;
        }
        let missing: Vec<&str> = component
            .variables
            .iter()
            .zip(&values)
            .zip(&wrong)
            .filter(|((_, value), is_wrong)| value.is_none() && !**is_wrong)
            .map(|((variable, _), _)| variable.name.as_str())
            .collect();
        for variable in &missing {
            let message = format!("the pass '{name}' must set '{variable}'");
            let note = format!("it has no default in {}", component.name);
            mistakes.add(Mistake::error(&place, message).note(note));
        }
        let values: Option<Vec<Value>> = values.into_iter().collect();
        Some(Self { name, component, values: values?, places, place, split_from: None })
    }

    /// Sets the variable at `index`, clamped to its limits. A value that the variable
    /// cannot have is a mistake and changes nothing.
    pub(crate) fn set_value(
        &mut self,
        index: usize,
        value: Value,
        place: Option<Place>,
        mistakes: &mut Mistakes,
    ) {
        let Some(variable) = self.component.variables.get(index) else { return };
        if let Some(value) = checked(variable, value, place.as_ref(), mistakes) {
            self.values[index] = value;
            self.places[index] = place;
        }
    }

    /// One value per variable of the component, in the same order.
    #[must_use]
    pub fn values(&self) -> &[Value] {
        &self.values
    }

    /// The place where a variable was set, or else that of the pass.
    #[must_use]
    pub(super) fn place_of(&self, variable: &str) -> &Place {
        let index = self.component.variable(variable).map(|found| found.0);
        index.and_then(|index| self.places[index].as_ref()).unwrap_or(&self.place)
    }

    /// Whether the pass is drawn at all: its variable `render`.
    #[must_use]
    pub(crate) fn is_rendered(&self) -> bool {
        let found = self.component.variable(RENDER);
        found.is_some_and(|(index, _)| self.values[index] == Value::Bool(true))
    }
}

/// The value as the variable takes it: clamped to its limits, one of its words, an image
/// with its directory; none, and a mistake, for a value that it cannot have.
fn checked(
    variable: &VariableDescriptor,
    value: Value,
    place: Option<&Place>,
    mistakes: &mut Mistakes,
) -> Option<Value> {
    let error = |message: String| match place {
        Some(place) => Mistake::error(place, message),
        None => Mistake::without_place(message),
    };
    match value {
        Value::String(word) if !variable.one_of.is_empty() => {
            if variable.word_index(&word).is_none() {
                let message = format!("'{word}' is not a value of '{}'", variable.name);
                let words = variable.one_of.iter().map(String::as_str);
                mistakes.add(error(message).names(&word, words));
                return None;
            }
            Some(Value::String(word))
        }
        Value::Texture(name) => {
            let found = variable.in_directory(Value::Texture(name.clone()));
            if found.is_none() {
                let message = format!("the image '{name}' needs a directory");
                let note =
                    "a texture is directory:image, <generated>:name, or a file such as paper.png";
                mistakes.add(error(message).note(note));
            }
            found
        }
        value => {
            let clamped = value.clamped(variable.minimum.as_ref(), variable.maximum.as_ref());
            if clamped != value {
                mistakes.add(Mistake::out_of_range(place, &variable.name, &value, &clamped));
            }
            Some(clamped)
        }
    }
}
