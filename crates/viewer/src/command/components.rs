//! `viewer components`: the components of passes.

use std::fmt::Write as _;

use clap::{Args, Subcommand};
use edgemesh::command::{Failure, print_to_stdout};

use super::warnings::print_mistakes;
use crate::arguments::LibraryArguments;
use crate::error::Error;
use crate::technique::descriptor::{ComponentDescriptor, VariableDescriptor};
use crate::technique::library::Library;
use crate::technique::mistake::{Mistake, Mistakes};
use crate::technique::value::Value;

const EXAMPLES: &str = "Examples:\n  \
    viewer components list\n  \
    viewer components print edge_detect_normals";

/// Lists and describes the components of techniques
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct ComponentsCommand {
    #[command(subcommand)]
    verb: Verb,
    #[command(flatten)]
    library: LibraryArguments,
}

#[derive(Debug, Clone, Subcommand)]
enum Verb {
    /// List all components with their descriptions
    List,
    /// Describe a component with all its variables
    Print {
        /// The component
        name: String,
    },
}

impl ComponentsCommand {
    pub(super) fn run(&self, is_quiet: bool) -> Result<(), Failure> {
        let library = self.library.load();
        print_mistakes(library.mistakes(), is_quiet);
        let text = match &self.verb {
            Verb::List => list(&library),
            Verb::Print { name } => described(find(&library, name)?),
        };
        print_to_stdout(text.as_bytes())
    }
}

fn find<'l>(library: &'l Library, name: &str) -> Result<&'l ComponentDescriptor, Error> {
    let known = name.replace('-', "_");
    library.components().get(&known).map(AsRef::as_ref).ok_or_else(|| {
        let mistake = Mistake::without_place(format!("unknown component '{name}'"));
        let names = library.components().keys().map(String::as_str);
        Mistakes::of(mistake.names(name, names)).into()
    })
}

fn list(library: &Library) -> String {
    let width = library.components().keys().map(String::len).max().unwrap_or_default();
    let line = |(name, component): (&String, &crate::technique::descriptor::SharedDescriptor)| {
        format!("{name:<width$}  {}\n", component.about)
    };
    library.components().iter().map(line).collect()
}

fn described(component: &ComponentDescriptor) -> String {
    let mut text = format!("{}: {}\n", component.name, component.about);
    let base = match &component.inherits {
        Some(parent) => format!("inherits from {parent}"),
        None => "implemented in Rust".to_owned(),
    };
    let _ = writeln!(text, "{base}; described in {}\n", component.place.source.name);
    for variable in &component.variables {
        text += &variable_described(variable);
    }
    text
}

fn variable_described(variable: &VariableDescriptor) -> String {
    let mut text = format!("{} ({})", variable.name, variable.kind.name());
    if !variable.about.is_empty() {
        let _ = write!(text, ": {}", variable.about);
    }
    text.push('\n');
    let mut line = |name: &str, value: &Option<Value>| {
        if let Some(value) = value {
            let _ = writeln!(text, "    {name} {value}");
        }
    };
    line("default", &variable.default);
    line("minimum", &variable.minimum);
    line("maximum", &variable.maximum);
    let differs = |ui: &Option<Value>, hard: &Option<Value>| ui.clone().filter(|_| ui != hard);
    line("ui minimum", &differs(&variable.ui_minimum, &variable.minimum));
    line("ui maximum", &differs(&variable.ui_maximum, &variable.maximum));
    if variable.default.is_none() {
        text += "    must be set\n";
    }
    if !variable.one_of.is_empty() {
        let _ = writeln!(text, "    one of {}", variable.one_of.join(", "));
    }
    let marks = [
        (variable.read_only, "read only"),
        (variable.internal, "internal"),
        (variable.vertex_parameter, "vertex parameter"),
        (variable.fragment_parameter, "fragment parameter"),
    ];
    let marks: Vec<&str> = marks.iter().filter(|mark| mark.0).map(|mark| mark.1).collect();
    if !marks.is_empty() {
        let _ = writeln!(text, "    {}", marks.join(", "));
    }
    text
}
