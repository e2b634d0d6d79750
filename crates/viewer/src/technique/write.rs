//! A changed technique as a technique file.
//!
//! The text of the original file is kept, with its comments and components; only changed
//! values differ.

use thiserror::Error;
use toml_edit::{ArrayOfTables, DocumentMut, Item, Table, TomlError};

use super::Technique;
use super::changes::argument;
use super::descriptor::VariableDescriptor;
use super::pass::Pass;
use super::value::{Value, VariableType, color_text};

/// Why a changed technique cannot be saved: its original file does not parse again.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum WriteTechniqueError {
    /// The file is not TOML.
    #[error("the technique cannot be saved: {0}")]
    Syntax(#[from] TomlError),
    /// Its passes are not an array of tables.
    #[error("the technique cannot be saved: its passes are not [[pass]] tables")]
    Passes,
}

/// The text of a file for a changed technique; `about` becomes its description.
///
/// # Errors
/// If the text of the original file does not parse.
pub(crate) fn file_text(technique: &Technique, about: &str) -> Result<String, WriteTechniqueError> {
    let source = technique.passes.first().map_or("", |pass| &pass.place.source.text);
    let mut document: DocumentMut = source.parse()?;
    let tables = document.get("pass").and_then(Item::as_array_of_tables).cloned();
    let tables = tables.ok_or(WriteTechniqueError::Passes)?;
    // Passes that were not split off are those of the file, in its order.
    let mut known = tables.iter();
    let mut last: Option<Table> = None;
    let mut passes = ArrayOfTables::new();
    for pass in &technique.passes {
        let mut table = match &pass.split_from {
            None => known.next().cloned().unwrap_or_default(),
            Some(_) => split_table(last.as_ref(), pass),
        };
        set_values(&mut table, pass);
        // Without a position it follows the table before it.
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

/// The table of a pass that was split off the one with the table `parent`.
fn split_table(parent: Option<&Table>, pass: &Pass) -> Table {
    let mut table = parent.cloned().unwrap_or_default();
    table.decor_mut().set_prefix("\n");
    table.insert("name", toml_edit::value(&pass.name));
    table.insert("component", toml_edit::value(&pass.component.name));
    table
}

/// Writes the values that differ from those in the table.
fn set_values(table: &mut Table, pass: &Pass) {
    for (variable, value) in pass.component.variables.iter().zip(pass.values()) {
        let is_default = variable.default.as_ref() == Some(value);
        let known = table.get(&variable.name).map(|item| value_of(item, variable));
        let is_same = match known {
            Some(known) => known.as_ref() == Some(value),
            None => is_default,
        };
        if !is_same {
            set_value(table, &variable.name, toml_value(variable.kind, value));
        }
    }
}

/// Sets a value and keeps the comments around it.
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

/// The value of a variable in a table; none if it has another form than [`toml_value`]
/// writes.
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
        // By its shortest decimal text, which is what users wrote.
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
    fn every_built_in_technique_is_written_as_it_was() {
        let library = Library::shipped();
        for name in library.technique_names() {
            let (technique, _) = library.technique(name).unwrap();
            let text = file_text(&technique, &technique.about).unwrap();
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
            let text = file_text(&technique, "my \"own\"").unwrap();
            std::fs::write(&path, &text).unwrap();
            let (again, _) = library.technique_file(&path).unwrap_or_else(|m| panic!("{m}{text}"));
            assert_eq!(again.about, "my \"own\"");
            assert_eq!(again.passes.len(), technique.passes.len(), "{text}");
            for (one, other) in again.passes.iter().zip(&technique.passes) {
                assert_eq!(one.name, other.name);
                assert_eq!(one.values(), other.values(), "{}\n{text}", one.name);
            }
            assert!(text.starts_with('#'), "the first comment is kept: {text}");
        }
    }
}
