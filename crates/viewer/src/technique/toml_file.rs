//! TOML as a tree with the place of every key and value, and values of variables in it;
//! shared by component files and technique files.

use std::sync::Arc;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::mistake::{Mistake, Mistakes, Place, SourceText};
use super::texture_name::TextureName;
use super::value::{Value, VariableType, parse_color};

/// A value in a file with its place.
#[derive(Debug, Clone)]
pub(crate) struct Node {
    pub(crate) place: Place,
    pub(crate) content: Content,
}

#[derive(Debug, Clone)]
pub(crate) enum Content {
    Bool(bool),
    /// None for one that does not fit 64 bits.
    Integer(Option<i64>),
    Number(f64),
    Text(String),
    Date,
    Array(Vec<Node>),
    Table(Vec<Entry>),
}

/// A key and its value in a table.
#[derive(Debug, Clone)]
pub(crate) struct Entry {
    pub(crate) key: String,
    /// The place of the key.
    pub(crate) place: Place,
    pub(crate) node: Node,
}

/// Parses a text and returns the entries that it could read, in the order of the file;
/// adds all syntax errors to `mistakes`.
pub(crate) fn parse(source: &Arc<SourceText>, mistakes: &mut Mistakes) -> Vec<Entry> {
    let (root, errors) = DeTable::parse_recoverable(&source.text);
    for error in errors {
        let place = Place { source: source.clone(), span: error.span().unwrap_or(0..0) };
        let message = error.message().lines().next().unwrap_or("this is not TOML").to_owned();
        mistakes.add(Mistake::error(&place, message));
    }
    table_of(source, root.get_ref())
}

fn table_of(source: &Arc<SourceText>, table: &DeTable) -> Vec<Entry> {
    let entry = |(key, value): (&Spanned<_>, &_)| {
        let key: (&std::borrow::Cow<str>, _) = (key.get_ref(), key.span());
        Entry {
            key: key.0.clone().into_owned(),
            place: Place { source: source.clone(), span: key.1 },
            node: node_of(source, value),
        }
    };
    let mut entries: Vec<Entry> = table.iter().map(entry).collect();
    entries.sort_by_key(|entry| entry.place.span.start);
    entries
}

fn node_of(source: &Arc<SourceText>, value: &Spanned<DeValue>) -> Node {
    let content = match value.get_ref() {
        DeValue::Boolean(value) => Content::Bool(*value),
        DeValue::Integer(number) => {
            Content::Integer(i64::from_str_radix(number.as_str(), number.radix()).ok())
        }
        DeValue::Float(number) => Content::Number(number.as_str().parse().unwrap_or(f64::NAN)),
        DeValue::String(text) => Content::Text(text.clone().into_owned()),
        DeValue::Datetime(_) => Content::Date,
        DeValue::Array(array) => {
            Content::Array(array.iter().map(|value| node_of(source, value)).collect())
        }
        DeValue::Table(table) => Content::Table(table_of(source, table)),
    };
    Node { place: Place { source: source.clone(), span: value.span() }, content }
}

impl Content {
    const fn type_name(&self) -> &'static str {
        match self {
            Self::Bool(_) => "true or false",
            Self::Integer(_) => "an integer",
            Self::Number(_) => "a number",
            Self::Text(_) => "a string",
            Self::Date => "a date",
            Self::Array(_) => "an array",
            Self::Table(_) => "a table",
        }
    }
}

impl Node {
    /// The text; none and a mistake for anything else.
    pub(crate) fn text(&self, mistakes: &mut Mistakes) -> Option<String> {
        let Content::Text(text) = &self.content else {
            mistakes.add(self.wrong_type(VariableType::String.expected()));
            return None;
        };
        Some(text.clone())
    }

    /// The entries of the table; none and a mistake for anything else.
    pub(crate) fn table(&self, mistakes: &mut Mistakes) -> Option<&[Entry]> {
        let Content::Table(entries) = &self.content else {
            mistakes.add(self.wrong_type("a table"));
            return None;
        };
        Some(entries)
    }

    /// The elements of the array; none and a mistake for anything else.
    pub(crate) fn array(&self, mistakes: &mut Mistakes) -> Option<&[Self]> {
        let Content::Array(nodes) = &self.content else {
            mistakes.add(self.wrong_type("an array"));
            return None;
        };
        Some(nodes)
    }

    /// The value as one of a type; none and a mistake for anything else.
    pub(crate) fn value(&self, of: VariableType, mistakes: &mut Mistakes) -> Option<Value> {
        match self.read(of) {
            Ok(value) => Some(value),
            Err(None) => {
                mistakes.add(self.wrong_type(of.expected()));
                None
            }
            Err(Some(message)) => {
                mistakes.add(Mistake::error(&self.place, message));
                None
            }
        }
    }

    pub(crate) fn wrong_type(&self, expected: &str) -> Mistake {
        let found = self.content.type_name();
        Mistake::error(&self.place, format!("expected {expected}")).label(format!("found {found}"))
    }

    /// The value as one of a type. An error has a message, or none for a wrong type.
    fn read(&self, of: VariableType) -> Result<Value, Option<String>> {
        Ok(match (of, &self.content) {
            (VariableType::Bool, Content::Bool(value)) => Value::Bool(*value),
            (VariableType::Bool, Content::Integer(Some(number @ (0 | 1)))) => {
                Value::Bool(*number == 1)
            }
            (VariableType::Int, Content::Integer(number)) => {
                let number = number.and_then(|number| i32::try_from(number).ok());
                Value::Int(number.ok_or_else(|| "expected an integer of 32 bits".to_owned())?)
            }
            (VariableType::String, Content::Text(text)) => Value::String(text.clone()),
            (VariableType::Texture, Content::Text(text)) => {
                Value::Texture(TextureName::parse(text)?)
            }
            (VariableType::Rgb | VariableType::Rgba, Content::Text(text)) => {
                Value::Numbers(parse_color(text, of).ok_or(None)?)
            }
            (_, Content::Array(nodes)) if of.number_count() > 1 => {
                let numbers: Option<Vec<f64>> = nodes.iter().map(Self::number).collect();
                numbers.and_then(|numbers| of.of_numbers(&numbers)).ok_or(None)?
            }
            _ => self.number().and_then(|number| of.of_numbers(&[number])).ok_or(None)?,
        })
    }

    fn number(&self) -> Option<f64> {
        match self.content {
            #[expect(clippy::cast_precision_loss, reason = "variables have 32 bits")]
            Content::Integer(number) => number.map(|number| number as f64),
            Content::Number(number) => Some(number),
            _ => None,
        }
    }
}
