//! A technique that was changed, as a technique file.
//!
//! The file that it came from is kept as it is, its comments and its own components
//! included; only what was changed is changed in it.

use thiserror::Error;
use toml_edit::{ArrayOfTables, DocumentMut, Item, Table, TomlError};

use super::Technique;
use super::changes::argument;
use super::descriptor::VariableDescriptor;
use super::pass::Pass;
use super::value::{Value, VariableType, color_text};

/// Why a technique cannot be written: the file that it came from cannot be read again.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum WriteTechniqueError {
    /// It is not TOML.
    #[error("the technique cannot be written: {0}")]
    Syntax(#[from] TomlError),
    /// Its passes are not an array of tables.
    #[error("the technique cannot be written: its passes are no tables")]
    Passes,
}

/// The text of a file for `technique`, which was read from a file and changed since;
/// `about` says what it shows.
///
/// # Errors
/// [`WriteTechniqueError`].
pub fn written(technique: &Technique, about: &str) -> Result<String, WriteTechniqueError> {
    let source = technique.passes.first().map_or("", |pass| &pass.place.source.text);
    let mut document: DocumentMut = source.parse()?;
    let tables = document.get("pass").and_then(Item::as_array_of_tables).cloned();
    let tables = tables.ok_or(WriteTechniqueError::Passes)?;
    // The passes that were there are those of the file, in its order.
    let mut known = tables.iter();
    let mut last: Option<Table> = None;
    let mut passes = ArrayOfTables::new();
    for pass in &technique.passes {
        let mut table = match &pass.split_from {
            None => known.next().cloned().unwrap_or_default(),
            Some(_) => split_table(last.as_ref(), pass),
        };
        set_values(&mut table, pass);
        // Without a place of its own it stands behind the one before.
        table.set_position(None);
        if pass.split_from.is_none() {
            last = Some(table.clone());
        }
        passes.push(table);
    }
    document.insert("pass", Item::ArrayOfTables(passes));
    set_value(&mut document, "about", about.into());
    Ok(document.to_string())
}

/// A pass that was split off the one whose table is `parent`.
fn split_table(parent: Option<&Table>, pass: &Pass) -> Table {
    let mut table = parent.cloned().unwrap_or_default();
    table.decor_mut().set_prefix("\n");
    table.insert("name", toml_edit::value(&pass.name));
    table.insert("component", toml_edit::value(&pass.component.name));
    table
}

/// Writes what differs from what the table says.
fn set_values(table: &mut Table, pass: &Pass) {
    for (variable, value) in pass.component.variables.iter().zip(pass.values()) {
        let is_default = variable.default.as_ref() == Some(value);
        let said = table.get(&variable.name).map(|item| value_of(item, variable));
        let is_said = match said {
            Some(said) => said.as_ref() == Some(value),
            None => is_default,
        };
        if !is_said {
            set_value(table, &variable.name, toml_value(variable.kind, value));
        }
    }
}

/// Sets a value; the comments around it stay.
fn set_value(table: &mut Table, key: &str, value: toml_edit::Value) {
    match table.get_mut(key).and_then(Item::as_value_mut) {
        Some(known) => {
            let decor = known.decor().clone();
            *known = value;
            *known.decor_mut() = decor;
        }
        None => drop(table.insert(key, Item::Value(value))),
    }
}

/// What a table says of a variable; `None` where it is said in another way than it would
/// be written here.
fn value_of(item: &Item, variable: &VariableDescriptor) -> Option<Value> {
    use toml_edit::Value as Toml;
    let kind = variable.kind;
    let number = |value: &Toml| match value {
        #[expect(clippy::cast_precision_loss, reason = "variables have 32 bits")]
        Toml::Integer(number) => Some(*number.value() as f64),
        Toml::Float(number) => Some(*number.value()),
        _ => None,
    };
    match item.as_value()? {
        Toml::Boolean(value) => Some(Value::Bool(*value.value())),
        Toml::String(text) => match kind {
            VariableType::String => Some(Value::String(text.value().clone())),
            _ => variable.in_directory(kind.parse(text.value()).ok()?),
        },
        Toml::Array(numbers) => {
            let numbers: Option<Vec<f64>> = numbers.iter().map(number).collect();
            kind.of_numbers(&numbers?)
        }
        Toml::Integer(value) if kind == VariableType::Int => {
            Some(Value::Int(i32::try_from(*value.value()).ok()?))
        }
        value => kind.of_numbers(&[number(value)?]),
    }
}

fn toml_value(kind: VariableType, value: &Value) -> toml_edit::Value {
    let number = |number: &f32| -> toml_edit::Value {
        // By its shortest text, which as 64 bits has the digits that people wrote.
        number.to_string().parse().map_or_else(
            |_| f64::from(*number).into(),
            |float: f64| {
                let is_whole = float.fract() == 0.0 && float.abs() < 1e6;
                #[expect(
                    clippy::cast_possible_truncation,
                    reason = "a whole number below a million"
                )]
                if is_whole { (float as i64).into() } else { float.into() }
            },
        )
    };
    match value {
        Value::Bool(value) => (*value).into(),
        Value::Int(value) => i64::from(*value).into(),
        Value::Numbers(numbers) => match (color_text(numbers), &numbers[..]) {
            (Some(color), _) if kind.is_color() => color.into(),
            (_, [one]) => number(one),
            _ => numbers.iter().map(number).collect::<toml_edit::Array>().into(),
        },
        Value::String(_) | Value::Texture(_) => argument(kind, value).into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::technique::library::Library;

    #[test]
    fn every_technique_that_ships_is_written_as_it_was() {
        let library = Library::shipped();
        for name in library.technique_names() {
            let (technique, _) = library.technique(name).unwrap();
            let text = written(&technique, &technique.about).unwrap();
            assert_eq!(text, technique.passes[0].place.source.text, "{name}");
        }
    }

    #[test]
    fn a_changed_technique_is_read_again_as_it_was_changed() {
        let library = Library::shipped();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mine.toml");
        for (name, settings) in [
            ("ink", &["valley.width=4.5", "ridge.color=#00ff0080", "strokes.fade=3,8"][..]),
            ("anime", &["strokes.width=0.1", "fill.toon_map=metallic", "silhouette.width=9"]),
            ("outline_combined", &[]),
        ] {
            let (mut technique, _) = library.technique(name).unwrap();
            for setting in settings {
                technique.set(setting).unwrap();
            }
            let text = written(&technique, "my \"own\"").unwrap();
            std::fs::write(&path, &text).unwrap();
            let (again, _) = library.technique_file(&path).unwrap_or_else(|m| panic!("{m}{text}"));
            assert_eq!(again.about, "my \"own\"");
            assert_eq!(again.passes.len(), technique.passes.len(), "{text}");
            for (one, other) in again.passes.iter().zip(&technique.passes) {
                assert_eq!(one.name, other.name);
                assert_eq!(one.values(), other.values(), "{}\n{text}", one.name);
            }
            assert!(text.starts_with('#'), "the comment at its head stays: {text}");
        }
    }
}
