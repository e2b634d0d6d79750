//! Component files: descriptors in TOML.
//!
//! ```toml
//! [component.edge_detect_normals]
//! about = "lines where neighboring normals differ"
//! inherits = "process_texture"
//!
//! [component.edge_detect_normals.variable]
//! threshold = { type = "number", default = 0.9, minimum = -1, maximum = 1, fragment_parameter = true }
//!
//! [component.edge_detect_normals.modify]
//! fragment_program = { default = "edge_normals:detect", internal = true }
//! ```
//!
//! Each file is read to drafts; then the drafts of all files are resolved to descriptors,
//! parents first.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::core::CoreComponent;
use super::descriptor::{
    ComponentDescriptor, SharedDescriptor, VariableDescriptor, automatic_variables,
};
use super::mistake::{Mistake, Mistakes, Place};
use super::toml_file::{Entry, Node};
use super::value::VariableType;

/// A component as in its file, before its parent is known.
#[derive(Debug, Clone)]
pub(crate) struct ComponentDraft {
    pub(crate) name: String,
    about: String,
    base: Option<BaseEntry>,
    variables: Vec<Entry>,
    /// Changed properties of inherited variables, to be read when their types are known.
    modified: Vec<Entry>,
    place: Place,
}

/// The parent or core component of a draft, and its place in the file.
#[derive(Debug, Clone)]
struct BaseEntry {
    base: Base,
    place: Place,
}

#[derive(Debug, Clone)]
enum Base {
    Core(CoreComponent),
    Inherits(String),
    /// An unknown one, which was reported.
    Unknown,
}

const PROPERTIES: [&str; 13] = [
    "type",
    "about",
    "default",
    "minimum",
    "maximum",
    "ui_minimum",
    "ui_maximum",
    "read_only",
    "internal",
    "vertex_parameter",
    "fragment_parameter",
    "one_of",
    "directory",
];

/// The keys of a pass that are not variables.
pub(crate) const PASS_KEYS: [&str; 2] = ["name", "component"];

/// Reads the `component` table of a file.
pub(crate) fn drafts(node: &Node, mistakes: &mut Mistakes) -> Vec<ComponentDraft> {
    let mut drafts = Vec::new();
    for component in node.table(mistakes).unwrap_or_default() {
        if let Some(entries) = component.node.table(mistakes) {
            drafts.push(draft(component, entries, mistakes));
        }
    }
    drafts
}

fn draft(component: &Entry, entries: &[Entry], mistakes: &mut Mistakes) -> ComponentDraft {
    let mut draft = ComponentDraft {
        name: component.key.clone(),
        about: String::new(),
        base: None,
        variables: Vec::new(),
        modified: Vec::new(),
        place: component.place.clone(),
    };
    for Entry { key, place, node } in entries {
        match key.as_str() {
            "about" => draft.about = node.text(mistakes).unwrap_or_default(),
            "inherits" => {
                let base = node.text(mistakes).map_or(Base::Unknown, Base::Inherits);
                draft.base = Some(BaseEntry { base, place: node.place.clone() });
            }
            "core" => {
                let base = node.text(mistakes).map_or(Base::Unknown, |name| {
                    CoreComponent::of_name(&name).map_or_else(
                        || {
                            let message = format!("unknown core component '{name}'");
                            let names = CoreComponent::ALL.map(CoreComponent::name);
                            mistakes.add(Mistake::error(&node.place, message).names(&name, names));
                            Base::Unknown
                        },
                        Base::Core,
                    )
                });
                draft.base = Some(BaseEntry { base, place: node.place.clone() });
            }
            "variable" => draft.variables = node.table(mistakes).unwrap_or_default().to_vec(),
            "modify" => draft.modified = node.table(mistakes).unwrap_or_default().to_vec(),
            other => {
                let message = format!("unknown key '{other}' in a component");
                let names = ["about", "inherits", "core", "variable", "modify"];
                mistakes.add(Mistake::error(place, message).names(other, names));
            }
        }
    }
    draft
}

/// Resolves drafts, which can inherit from each other and from `known`. Drafts with mistakes
/// become `None`.
pub(crate) fn resolve(
    drafts: &[ComponentDraft],
    known: &BTreeMap<String, SharedDescriptor>,
    mistakes: &mut Mistakes,
) -> BTreeMap<String, Option<SharedDescriptor>> {
    let mut by_name: BTreeMap<&str, &ComponentDraft> = BTreeMap::new();
    for draft in drafts {
        if let Some(first) = by_name.get(draft.name.as_str()) {
            let message = format!("the component '{}' is already defined", draft.name);
            let mistake = Mistake::error(&draft.place, message);
            mistakes.add(mistake.also(&first.place, "first defined here"));
        } else {
            by_name.insert(&draft.name, draft);
        }
    }
    let mut resolver =
        Resolver { drafts: by_name, known, resolved: BTreeMap::new(), open: Vec::new() };
    for draft in drafts {
        resolver.descriptor(&draft.name, mistakes);
    }
    resolver.resolved
}

struct Resolver<'a> {
    drafts: BTreeMap<&'a str, &'a ComponentDraft>,
    known: &'a BTreeMap<String, SharedDescriptor>,
    /// `None` for drafts with mistakes.
    resolved: BTreeMap<String, Option<SharedDescriptor>>,
    /// The drafts that are being resolved, each the child of the next.
    open: Vec<String>,
}

impl Resolver<'_> {
    fn descriptor(&mut self, name: &str, mistakes: &mut Mistakes) -> Option<SharedDescriptor> {
        if let Some(resolved) = self.resolved.get(name) {
            return resolved.clone();
        }
        let Some(draft) = self.drafts.get(name).copied() else {
            return self.known.get(name).cloned();
        };
        self.open.push(name.to_owned());
        let resolved = self.resolve(draft, mistakes).map(Arc::new);
        self.open.pop();
        self.resolved.insert(name.to_owned(), resolved.clone());
        resolved
    }

    fn resolve(
        &mut self,
        draft: &ComponentDraft,
        mistakes: &mut Mistakes,
    ) -> Option<ComponentDescriptor> {
        let mut component = match &draft.base {
            Some(BaseEntry { base: Base::Core(core), .. }) => ComponentDescriptor {
                name: draft.name.clone(),
                about: String::new(),
                core: *core,
                inherits: None,
                variables: automatic_variables(&draft.place),
                place: draft.place.clone(),
            },
            Some(BaseEntry { base: Base::Inherits(parent), place }) => {
                let parent = self.parent(draft, parent, place, mistakes)?;
                ComponentDescriptor {
                    name: draft.name.clone(),
                    inherits: Some(parent.name.clone()),
                    place: draft.place.clone(),
                    ..(*parent).clone()
                }
            }
            Some(BaseEntry { base: Base::Unknown, .. }) => return None,
            None => {
                let message = format!("the component '{}' has no parent", draft.name);
                let note = "name its parent, such as inherits = \"process_texture\"";
                mistakes.add(Mistake::error(&draft.place, message).note(note));
                return None;
            }
        };
        if !draft.about.is_empty() {
            component.about.clone_from(&draft.about);
        }
        for entry in &draft.variables {
            if let Some(variable) = new_variable(&component, entry, mistakes) {
                component.variables.push(variable);
            }
        }
        for entry in &draft.modified {
            modify(&mut component, entry, mistakes);
        }
        Some(component)
    }

    fn parent(
        &mut self,
        draft: &ComponentDraft,
        parent: &str,
        place: &Place,
        mistakes: &mut Mistakes,
    ) -> Option<SharedDescriptor> {
        // A component can modify the built-in one of the same name.
        if parent == draft.name
            && let Some(known) = self.known.get(parent)
        {
            return Some(known.clone());
        }
        if let Some(start) = self.open.iter().position(|open| open == parent) {
            let mut chain = self.open[start..].to_vec();
            chain.push(parent.to_owned());
            let message = format!("'{parent}' inherits from itself: {}", chain.join(" > "));
            mistakes.add(Mistake::error(place, message));
            return None;
        }
        let found = self.descriptor(parent, mistakes);
        let has_mistake = self.resolved.get(parent).is_some_and(Option::is_none);
        if found.is_none() && !has_mistake {
            let names: Vec<&str> =
                self.drafts.keys().copied().chain(self.known.keys().map(String::as_str)).collect();
            let message = format!("unknown component '{parent}'");
            mistakes.add(Mistake::error(place, message).names(parent, names));
        }
        found
    }
}

fn new_variable(
    component: &ComponentDescriptor,
    entry: &Entry,
    mistakes: &mut Mistakes,
) -> Option<VariableDescriptor> {
    let properties = entry.node.table(mistakes)?;
    let name = entry.key.as_str();
    if PASS_KEYS.contains(&name) || !is_name(name) {
        let message = format!("'{name}' is not a valid variable name");
        let note = "names consist of letters, digits and _; name and component are reserved";
        mistakes.add(Mistake::error(&entry.place, message).note(note));
        return None;
    }
    if let Some((_, known)) = component.variable(name) {
        let message = format!("the variable '{name}' is already defined; change it under modify");
        mistakes.add(Mistake::error(&entry.place, message).also(&known.place, "defined here"));
        return None;
    }
    let Some(kind) = properties.iter().find(|property| property.key == "type") else {
        let names: Vec<&str> = VariableType::ALL.iter().map(|kind| kind.name()).collect();
        let message = format!("the variable '{name}' has no type");
        mistakes.add(Mistake::error(&entry.place, message).names("", names));
        return None;
    };
    let kind_name = kind.node.text(mistakes)?;
    let Some(of) = VariableType::ALL.into_iter().find(|kind| kind.name() == kind_name) else {
        let names: Vec<&str> = VariableType::ALL.iter().map(|kind| kind.name()).collect();
        let message = format!("unknown type '{kind_name}'");
        mistakes.add(Mistake::error(&kind.node.place, message).names(&kind_name, names));
        return None;
    };
    let mut variable = VariableDescriptor::new(name, of, entry.place.clone());
    for property in properties.iter().filter(|property| property.key != "type") {
        set_property(&mut variable, property, mistakes);
    }
    check_default(&variable, properties, mistakes);
    Some(variable)
}

fn modify(component: &mut ComponentDescriptor, entry: &Entry, mistakes: &mut Mistakes) {
    let Some(properties) = entry.node.table(mistakes) else { return };
    let name = entry.key.as_str();
    let Some((index, _)) = component.variable(name) else {
        let message = format!("{} has no variable '{name}' to modify", component.name);
        let names: Vec<&str> = component.variable_names().collect();
        mistakes.add(Mistake::error(&entry.place, message).names(name, names));
        return;
    };
    let variable = &mut component.variables[index];
    for property in properties {
        if property.key == "type" {
            let message = "the type of an inherited variable cannot be changed";
            mistakes.add(Mistake::error(&property.place, message));
        } else {
            set_property(variable, property, mistakes);
        }
    }
    check_default(variable, properties, mistakes);
}

fn set_property(variable: &mut VariableDescriptor, property: &Entry, mistakes: &mut Mistakes) {
    let (key, node, kind) = (property.key.as_str(), &property.node, variable.kind);
    let flag = |mistakes: &mut Mistakes| {
        let value = node.value(VariableType::Bool, mistakes);
        matches!(value, Some(super::value::Value::Bool(true)))
    };
    match key {
        "about" => variable.about = node.text(mistakes).unwrap_or_default(),
        "default" => variable.default = node.value(kind, mistakes),
        "read_only" => variable.read_only = flag(mistakes),
        "internal" => variable.internal = flag(mistakes),
        "vertex_parameter" => variable.vertex_parameter = flag(mistakes),
        "fragment_parameter" => variable.fragment_parameter = flag(mistakes),
        "minimum" | "maximum" | "ui_minimum" | "ui_maximum" if !kind.has_extremes() => {
            let message = format!("a {} cannot have a {key}", kind.name());
            mistakes.add(Mistake::error(&property.place, message));
        }
        // A limit is also that of sliders, unless they have a stricter one.
        "minimum" => {
            variable.minimum = node.value(kind, mistakes);
            variable.ui_minimum.clone_from(&variable.minimum);
        }
        "maximum" => {
            variable.maximum = node.value(kind, mistakes);
            variable.ui_maximum.clone_from(&variable.maximum);
        }
        "ui_minimum" => variable.ui_minimum = node.value(kind, mistakes),
        "ui_maximum" => variable.ui_maximum = node.value(kind, mistakes),
        "one_of" if kind == VariableType::String => {
            let words = node.array(mistakes).unwrap_or_default();
            variable.one_of = words.iter().filter_map(|word| word.text(mistakes)).collect();
        }
        "directory" if kind == VariableType::Texture => variable.directory = node.text(mistakes),
        "one_of" | "directory" => {
            let message = format!("a {} cannot have a {key}", kind.name());
            mistakes.add(Mistake::error(&property.place, message));
        }
        other => {
            let message = format!("unknown property '{other}' of a variable");
            mistakes.add(Mistake::error(&property.place, message).names(other, PROPERTIES));
        }
    }
}

/// A default must be within the limits and be one of the words.
fn check_default(variable: &VariableDescriptor, properties: &[Entry], mistakes: &mut Mistakes) {
    let Some(default) = &variable.default else { return };
    let place = properties
        .iter()
        .find(|property| property.key == "default")
        .map_or(&variable.place, |property| &property.node.place);
    let clamped = default.clamped(variable.minimum.as_ref(), variable.maximum.as_ref());
    if clamped != *default {
        let message = format!("the default of '{}' is out of range", variable.name);
        let note = format!("the nearest value in range is {clamped}");
        mistakes.add(Mistake::error(place, message).note(note));
    }
    if let super::value::Value::String(word) = default
        && !variable.one_of.is_empty()
        && variable.word_index(word).is_none()
    {
        let message = format!("'{word}' is not a value of '{}'", variable.name);
        let words = variable.one_of.iter().map(String::as_str);
        mistakes.add(Mistake::error(place, message).names(word, words));
    }
}

/// Whether a name consists of letters, digits and underscores and does not begin with a
/// digit, as field names in WGSL.
pub(crate) fn is_name(name: &str) -> bool {
    let is_letter = |letter: char| letter.is_ascii_alphabetic() || letter == '_';
    name.starts_with(is_letter) && name.chars().all(|c| is_letter(c) || c.is_ascii_digit())
}
