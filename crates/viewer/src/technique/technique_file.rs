//! Technique files: passes in TOML.
//!
//! ```toml
//! [[pass]]
//! name = "phong_and_depth"          # optional; else that of the component
//! component = "render_phong"
//! render_target = "phong"           # every other key is a variable
//!
//! [[pass]]
//! component = "edge_detect_depth_2nd_derivative"
//! depth_texture = "<generated>:phong_depth"
//! ```
//!
//! A file may describe components of its own as well, in a `component` table.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::Technique;
use super::component_file::{self, PASS_KEYS, is_name};
use super::descriptor::SharedDescriptor;
use super::mistake::{Mistake, Mistakes, SourceText};
use super::pass::{Assignment, Pass};
use super::toml_file::{self, Entry, Node};

/// Reads a technique called `name`; its components may inherit from `components`. Says
/// as well whether all of its passes could be read.
pub(crate) fn read(
    name: &str,
    source: &Arc<SourceText>,
    components: &BTreeMap<String, SharedDescriptor>,
    mistakes: &mut Mistakes,
) -> (Technique, bool) {
    let root = toml_file::parse(source, mistakes);
    let mut own = BTreeMap::new();
    if let Some(entry) = root.iter().find(|entry| entry.key == "component") {
        let drafts = component_file::drafts(&entry.node, mistakes);
        own = component_file::resolve(&drafts, components, mistakes);
    }
    let mut technique = Technique {
        name: name.to_owned(),
        about: String::new(),
        passes: Vec::new(),
        folders: Vec::new(),
    };
    if mistakes.has_errors() && own.is_empty() {
        // Of a text that is no TOML not more than that is known.
        return (technique, false);
    }
    let mut is_whole = true;
    let mut has_passes = false;
    for Entry { key, place, node } in &root {
        match key.as_str() {
            "about" => technique.about = node.text(mistakes).unwrap_or_default(),
            "component" => {}
            "pass" => {
                has_passes = true;
                for node in node.array(mistakes).unwrap_or_default() {
                    let taken: Vec<&Pass> = technique.passes.iter().collect();
                    let pass = read_pass(node, (&own, components), &taken, mistakes);
                    is_whole &= pass.is_some();
                    technique.passes.extend(pass);
                }
            }
            other => {
                let message = format!("a technique has no '{other}'");
                let names = ["about", "pass", "component"];
                mistakes.add(Mistake::error(place, message).names(other, names));
            }
        }
    }
    if !has_passes && !mistakes.has_errors() {
        let place = super::mistake::Place { source: source.clone(), span: 0..0 };
        let note = "a technique is a list of passes; each begins with [[pass]]";
        mistakes.add(Mistake::error(&place, "the technique has no pass").note(note));
    }
    (technique, is_whole && has_passes)
}

/// A pass of one of the file's own components, or of those that are known.
fn read_pass(
    node: &Node,
    (own, known): (
        &BTreeMap<String, Option<SharedDescriptor>>,
        &BTreeMap<String, SharedDescriptor>,
    ),
    taken: &[&Pass],
    mistakes: &mut Mistakes,
) -> Option<Pass> {
    let entries = node.table(mistakes)?;
    let of_key = |key: &str| entries.iter().find(|entry| entry.key == key);
    let Some(component) = of_key("component") else {
        let note = "say which, as component = \"render_phong\"";
        mistakes.add(Mistake::error(&node.place, "the pass has no component").note(note));
        return None;
    };
    let component_name = component.node.text(mistakes)?;
    let found = match own.get(&component_name) {
        // Its own mistake was told.
        Some(None) => return None,
        Some(Some(own)) => Some(own),
        None => known.get(&component_name),
    };
    let Some(descriptor) = found.cloned() else {
        let message = format!("there is no component '{component_name}'");
        let mistake = Mistake::error(&component.node.place, message);
        let names = own.keys().chain(known.keys()).map(String::as_str);
        mistakes.add(mistake.names(&component_name, names));
        return None;
    };
    let name = match of_key("name") {
        Some(entry) => pass_name(entry, taken, mistakes)?,
        None => free_name(&descriptor.name, taken),
    };
    let mut assignments = Vec::new();
    for entry in entries.iter().filter(|entry| !PASS_KEYS.contains(&entry.key.as_str())) {
        let Some((index, variable)) = descriptor.variable(&entry.key) else {
            let message = format!("{} has no variable '{}'", descriptor.name, entry.key);
            let mistake = Mistake::error(&entry.place, message);
            let shown = descriptor.variables.iter().filter(|variable| !variable.internal);
            let shown = shown.map(|variable| variable.name.as_str());
            mistakes.add(mistake.names(&entry.key, shown));
            continue;
        };
        // What is not there for a mistake of its own is not told twice.
        let value = entry.node.value(variable.kind, mistakes).or_else(|| variable.default.clone());
        if let Some(value) = value {
            assignments.push(Assignment { index, value, place: Some(entry.node.place.clone()) });
        }
    }
    Pass::new(name, descriptor, node.place.clone(), assignments, mistakes)
}

fn pass_name(entry: &Entry, taken: &[&Pass], mistakes: &mut Mistakes) -> Option<String> {
    let name = entry.node.text(mistakes)?;
    if !is_name(&name) {
        let message = format!("'{name}' cannot be the name of a pass");
        let note = "names are letters, digits and _";
        mistakes.add(Mistake::error(&entry.node.place, message).note(note));
        return None;
    }
    if let Some(first) = taken.iter().find(|pass| pass.name == name) {
        let message = format!("there is a pass '{name}' already");
        mistakes.add(Mistake::error(&entry.node.place, message).also(&first.place, "here"));
        return None;
    }
    Some(name)
}

/// The component's name, with a number where a pass has it already.
fn free_name(component: &str, taken: &[&Pass]) -> String {
    let is_free = |name: &String| taken.iter().all(|pass| pass.name != *name);
    let numbered = (2..).map(|number| format!("{component}_{number}"));
    std::iter::once(component.to_owned()).chain(numbered).find(is_free).unwrap_or_default()
}
