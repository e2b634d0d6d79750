//! Technique files: passes in TOML.
//!
//! ```toml
//! [[pass]]
//! name = "phong_and_depth"          # optional; by default that of the component
//! component = "render_phong"
//! render_target = "phong"           # every other key is a variable
//!
//! [[pass]]
//! component = "edge_detect_depth_2nd_derivative"
//! depth_texture = "<generated>:phong_depth"
//! ```
//!
//! A file can also describe components, in a `component` table.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::Technique;
use super::component_file::{self, PASS_KEYS, is_name};
use super::descriptor::SharedDescriptor;
use super::mistake::{Mistake, Mistakes, SourceText};
use super::pass::{Assignment, Pass};
use super::toml_file::{self, Entry, Node};

/// Reads a technique called `name`; its own components can inherit from `components`. The
/// flag is false if a pass could not be read.
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
        // The rest of a file with syntax errors cannot be checked.
        return (technique, false);
    }
    let known = KnownComponents { own: &own, others: components };
    let mut is_complete = true;
    let mut has_passes = false;
    for Entry { key, place, node } in &root {
        match key.as_str() {
            "about" => technique.about = node.text(mistakes).unwrap_or_default(),
            "component" => {}
            "pass" => {
                has_passes = true;
                for node in node.array(mistakes).unwrap_or_default() {
                    let taken: Vec<&Pass> = technique.passes.iter().collect();
                    let pass = read_pass(node, &known, &taken, mistakes);
                    is_complete &= pass.is_some();
                    technique.passes.extend(pass);
                }
            }
            other => {
                let message = format!("unknown key '{other}' in a technique");
                let names = ["about", "pass", "component"];
                mistakes.add(Mistake::error(place, message).names(other, names));
            }
        }
    }
    if !has_passes && !mistakes.has_errors() {
        let place = super::mistake::Place { source: source.clone(), span: 0..0 };
        let note = "a technique is a list of passes; each begins with [[pass]]";
        mistakes.add(Mistake::error(&place, "the technique has no passes").note(note));
    }
    (technique, is_complete && has_passes)
}

/// The components that passes of a file can name.
struct KnownComponents<'a> {
    /// Those of the file; none for one with mistakes.
    own: &'a BTreeMap<String, Option<SharedDescriptor>>,
    others: &'a BTreeMap<String, SharedDescriptor>,
}

/// Reads a pass; `taken` are the passes above it.
fn read_pass(
    node: &Node,
    known: &KnownComponents,
    taken: &[&Pass],
    mistakes: &mut Mistakes,
) -> Option<Pass> {
    let entries = node.table(mistakes)?;
    let of_key = |key: &str| entries.iter().find(|entry| entry.key == key);
    let Some(component) = of_key("component") else {
        let note = "name one, such as component = \"render_phong\"";
        mistakes.add(Mistake::error(&node.place, "the pass has no component").note(note));
        return None;
    };
    let component_name = component.node.text(mistakes)?;
    let found = match known.own.get(&component_name) {
        // The component has a mistake already.
        Some(None) => return None,
        Some(Some(own)) => Some(own),
        None => known.others.get(&component_name),
    };
    let Some(descriptor) = found.cloned() else {
        let message = format!("unknown component '{component_name}'");
        let mistake = Mistake::error(&component.node.place, message);
        let names = known.own.keys().chain(known.others.keys()).map(String::as_str);
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
        // A value with a mistake is not also missing.
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
        let message = format!("'{name}' is not a valid pass name");
        let note = "names consist of letters, digits and _";
        mistakes.add(Mistake::error(&entry.node.place, message).note(note));
        return None;
    }
    if let Some(first) = taken.iter().find(|pass| pass.name == name) {
        let message = format!("the pass name '{name}' is already used");
        let mistake = Mistake::error(&entry.node.place, message);
        mistakes.add(mistake.also(&first.place, "first used here"));
        return None;
    }
    Some(name)
}

/// The component's name, or with the first number from 2 that makes it unique.
fn free_name(component: &str, taken: &[&Pass]) -> String {
    let is_free = |name: &String| taken.iter().all(|pass| pass.name != *name);
    let numbered = (2..).map(|number| format!("{component}_{number}"));
    std::iter::once(component.to_owned()).chain(numbered).find(is_free).unwrap_or_default()
}
