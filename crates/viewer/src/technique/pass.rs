//! A pass: a component with the values of its variables.

use std::sync::Arc;

use super::descriptor::{SharedDescriptor, VariableDescriptor};
use super::mistake::{Mistake, Mistakes, Place};
use super::texture_name::TextureName;
use super::value::Value;

/// A pass of a technique.
#[derive(Debug, Clone)]
pub struct Pass {
    /// Its name, which no other pass of the technique has.
    pub name: String,
    /// The interface of its component.
    pub component: SharedDescriptor,
    /// The values of the component's variables, in their order.
    values: Vec<Value>,
    /// Where the values were set; none for defaults.
    places: Vec<Option<Place>>,
    /// Where the pass stands.
    pub place: Place,
    /// The pass that this one was split from, where it was.
    pub split_from: Option<String>,
}

/// What a pass does is its component and its values; where they were set is not part of it.
impl PartialEq for Pass {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
            && (Arc::ptr_eq(&self.component, &other.component) || self.component == other.component)
            && self.values == other.values
            && self.split_from == other.split_from
    }
}

/// What it takes to set a variable.
#[derive(Debug, Clone)]
pub(crate) struct Assignment {
    pub(crate) index: usize,
    pub(crate) value: Value,
    pub(crate) place: Option<Place>,
}

impl Pass {
    /// A pass with what is assigned, and defaults for everything else. A variable that
    /// has neither is a mistake.
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
        let lacking: Vec<&str> = component
            .variables
            .iter()
            .zip(&values)
            .zip(&wrong)
            .filter(|((_, value), is_wrong)| value.is_none() && !**is_wrong)
            .map(|((variable, _), _)| variable.name.as_str())
            .collect();
        for variable in &lacking {
            let message = format!("the pass '{name}' must set '{variable}'");
            let note = format!("in {} it has no default", component.name);
            mistakes.add(Mistake::error(&place, message).note(note));
        }
        let values: Option<Vec<Value>> = values.into_iter().collect();
        Some(Self { name, component, values: values?, places, place, split_from: None })
    }

    /// Sets a variable by its number, within its limits.
    pub fn set_value(
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

    /// All values, in the order of the component's variables.
    #[must_use]
    pub fn values(&self) -> &[Value] {
        &self.values
    }

    /// Where a variable was set, or else the pass.
    #[must_use]
    pub fn place_of(&self, variable: &str) -> &Place {
        let index = self.component.variable(variable).map(|found| found.0);
        index.and_then(|index| self.places[index].as_ref()).unwrap_or(&self.place)
    }

    /// A variable's value.
    #[must_use]
    pub fn value(&self, variable: &str) -> Option<&Value> {
        self.component.variable(variable).map(|(index, _)| &self.values[index])
    }

    /// A bool; false where there is none of the name.
    #[must_use]
    pub fn bool(&self, variable: &str) -> bool {
        matches!(self.value(variable), Some(Value::Bool(true)))
    }

    /// An int; 0 where there is none of the name.
    #[must_use]
    pub fn int(&self, variable: &str) -> i32 {
        match self.value(variable) {
            Some(Value::Int(value)) => *value,
            _ => 0,
        }
    }

    /// The numbers of a number, vector or colour; zeros where there are none.
    #[must_use]
    pub fn numbers<const N: usize>(&self, variable: &str) -> [f32; N] {
        let mut numbers = [0.0; N];
        if let Some(Value::Numbers(values)) = self.value(variable) {
            numbers.iter_mut().zip(values).for_each(|(number, value)| *number = *value);
        }
        numbers
    }

    /// A number; 0 where there is none of the name.
    #[must_use]
    pub fn number(&self, variable: &str) -> f32 {
        self.numbers::<1>(variable)[0]
    }

    /// A string; empty where there is none of the name.
    #[must_use]
    pub fn string(&self, variable: &str) -> &str {
        match self.value(variable) {
            Some(Value::String(text)) => text,
            _ => "",
        }
    }

    /// A texture; none where there is none of the name.
    #[must_use]
    pub fn texture(&self, variable: &str) -> &TextureName {
        match self.value(variable) {
            Some(Value::Texture(name)) => name,
            _ => const { &TextureName::NONE },
        }
    }

    /// Whether the pass is done at all.
    #[must_use]
    pub fn is_rendered(&self) -> bool {
        self.bool("render")
    }
}

/// The value that a variable takes: within its limits, a word that it knows, an image
/// of its own directory.
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
                let message = format!("'{word}' is none of the words of '{}'", variable.name);
                let words = variable.one_of.iter().map(String::as_str);
                mistakes.add(error(message).names(&word, words));
                return None;
            }
            Some(Value::String(word))
        }
        Value::Texture(name) => {
            let found = variable.in_directory(Value::Texture(name.clone()));
            if found.is_none() {
                let message = format!("'{name}' has no directory");
                let note = "a texture is directory:image, <generated>:name, or a file as paper.png";
                mistakes.add(error(message).note(note));
            }
            found
        }
        value => {
            let clamped = value.clamped(variable.minimum.as_ref(), variable.maximum.as_ref());
            if clamped != value {
                let name = &variable.name;
                let message = format!("{name} = {value} is out of its range, {clamped} is taken");
                mistakes.add(Mistake::warning(place, message));
            }
            Some(clamped)
        }
    }
}
