//! The modules of crates and the paths in them, read by `syn`.
//!
//! Code under `#[cfg(test)]` and doc comments do not count. Arguments of macros are not
//! parsed; paths are extracted from their tokens. Methods and fields name no file, so they
//! are ignored.

use std::collections::BTreeMap;

use proc_macro2::{TokenStream, TokenTree};
use syn::visit::{self, Visit};
use syn::{Attribute, Item, Meta, UseTree, Visibility};

/// The segments of a path; a leading `::` is an empty segment.
pub(super) type Path = Vec<String>;

/// One module: a file, or a `mod name { ... }` within one.
#[derive(Debug, Default)]
pub(super) struct Module {
    /// The path of the file from the root of the workspace.
    pub(super) file: String,
    pub(super) parent: Option<usize>,
    pub(super) children: BTreeMap<String, usize>,
    /// The names of its definitions.
    pub(super) items: Vec<String>,
    pub(super) imports: Vec<Import>,
    /// The paths in its code, except in `use`.
    pub(super) paths: Vec<Path>,
}

/// One name that a `use` brings in.
#[derive(Debug)]
pub(super) struct Import {
    /// The name here; `*` for all names.
    pub(super) name: String,
    pub(super) path: Path,
    /// Whether other modules see it: `pub use`, `pub(crate) use` and the like.
    pub(super) is_door: bool,
}

/// Reads a file as a module with the modules in it, and adds them to `modules`. Returns the
/// modules that are separate files: the module that declares each, and its name.
pub(super) fn read_file(
    file: &str,
    text: &str,
    parent: Option<usize>,
    modules: &mut Vec<Module>,
) -> Result<Vec<(usize, String)>, syn::Error> {
    let syntax = syn::parse_file(text)?;
    let current = modules.len();
    modules.push(Module { file: file.to_owned(), parent, ..Module::default() });
    let mut reader = Reader { modules, current, declared: Vec::new() };
    reader.visit_file(&syntax);
    Ok(reader.declared)
}

/// The first segments of all paths of a file, including tests.
pub(super) fn first_segments(text: &str) -> Result<Vec<String>, syn::Error> {
    let mut paths = Vec::new();
    paths_of_tokens(text.parse()?, &mut paths);
    Ok(paths.into_iter().filter_map(|path| path.into_iter().find(|s| !s.is_empty())).collect())
}

struct Reader<'a> {
    modules: &'a mut Vec<Module>,
    current: usize,
    declared: Vec<(usize, String)>,
}

impl Reader<'_> {
    fn here(&mut self) -> &mut Module {
        &mut self.modules[self.current]
    }

    fn read_module(&mut self, module: &syn::ItemMod) {
        let name = module.ident.to_string();
        let Some((_, items)) = &module.content else {
            self.declared.push((self.current, name));
            return;
        };
        let outer = self.current;
        self.current = self.modules.len();
        let file = self.modules[outer].file.clone();
        self.modules.push(Module { file, parent: Some(outer), ..Module::default() });
        self.modules[outer].children.insert(name, self.current);
        for item in items {
            self.visit_item(item);
        }
        self.current = outer;
    }
}

impl<'ast> Visit<'ast> for Reader<'_> {
    fn visit_item(&mut self, item: &'ast Item) {
        if is_for_tests(attributes(item)) {
            return;
        }
        if let Some(name) = defined_name(item) {
            self.here().items.push(name);
        }
        match item {
            Item::Mod(module) => self.read_module(module),
            Item::Use(import) => {
                let is_door = !matches!(import.vis, Visibility::Inherited);
                let start =
                    if import.leading_colon.is_some() { vec![String::new()] } else { vec![] };
                imports_of_tree(&import.tree, &start, is_door, &mut self.here().imports);
            }
            _ => visit::visit_item(self, item),
        }
    }

    fn visit_impl_item_fn(&mut self, function: &'ast syn::ImplItemFn) {
        if !is_for_tests(&function.attrs) {
            visit::visit_impl_item_fn(self, function);
        }
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let start = path.leading_colon.map(|_| String::new());
        let names = path.segments.iter().map(|segment| segment.ident.to_string());
        let names = start.into_iter().chain(names).collect();
        self.here().paths.push(names);
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, call: &'ast syn::Macro) {
        paths_of_tokens(call.tokens.clone(), &mut self.here().paths);
        visit::visit_macro(self, call);
    }

    fn visit_attribute(&mut self, attribute: &'ast Attribute) {
        if let Meta::List(list) = &attribute.meta {
            paths_of_tokens(list.tokens.clone(), &mut self.here().paths);
        }
        visit::visit_attribute(self, attribute);
    }
}

/// Splits a `use` into the names that it brings in.
fn imports_of_tree(tree: &UseTree, path: &[String], is_door: bool, imports: &mut Vec<Import>) {
    let with = |name: &syn::Ident| [path, &[name.to_string()]].concat();
    let mut add = |name: String, path: Path| imports.push(Import { name, path, is_door });
    match tree {
        UseTree::Path(step) => imports_of_tree(&step.tree, &with(&step.ident), is_door, imports),
        UseTree::Group(group) => {
            for tree in &group.items {
                imports_of_tree(tree, path, is_door, imports);
            }
        }
        UseTree::Name(last) if last.ident == "self" => {
            add(path.last().cloned().unwrap_or_default(), path.to_vec());
        }
        UseTree::Name(last) => add(last.ident.to_string(), with(&last.ident)),
        UseTree::Rename(last) if last.ident == "self" => {
            add(last.rename.to_string(), path.to_vec());
        }
        UseTree::Rename(last) => add(last.rename.to_string(), with(&last.ident)),
        UseTree::Glob(_) => add("*".to_owned(), path.to_vec()),
    }
}

/// Extracts paths from tokens: single names, and names joined by `::`.
fn paths_of_tokens(tokens: TokenStream, paths: &mut Vec<Path>) {
    let mut path = Path::new();
    // The punctuation before a name, and its number of repetitions.
    let mut sign = (' ', 0);
    for token in tokens {
        match token {
            TokenTree::Ident(ident) => {
                match sign {
                    (':', 2) if path.is_empty() => path.push(String::new()),
                    (':', 2) => {}
                    _ => finish_path(&mut path, paths),
                }
                // Fields, methods, lifetimes and variables of macros are no paths.
                if !matches!(sign, ('.', 1) | ('\'' | '$', _)) {
                    path.push(ident.to_string());
                }
                sign = (' ', 0);
            }
            TokenTree::Punct(punct) => {
                let repeats = if punct.as_char() == sign.0 { sign.1 + 1 } else { 1 };
                sign = (punct.as_char(), repeats);
            }
            TokenTree::Group(group) => {
                let start = if sign == (':', 2) { path.clone() } else { Path::new() };
                let mut inner = Vec::new();
                paths_of_tokens(group.stream(), &mut inner);
                paths.extend(inner.into_iter().map(|tail| [start.clone(), tail].concat()));
                finish_path(&mut path, paths);
                sign = (' ', 0);
            }
            TokenTree::Literal(_) => sign = (' ', 0),
        }
    }
    finish_path(&mut path, paths);
}

fn finish_path(path: &mut Path, paths: &mut Vec<Path>) {
    if !path.is_empty() {
        paths.push(std::mem::take(path));
    }
}

/// Whether a `cfg` is for tests alone.
fn is_for_tests(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("test")
            || attribute.path().is_ident("cfg") && {
                let Meta::List(list) = &attribute.meta else { return false };
                let mut words = Vec::new();
                paths_of_tokens(list.tokens.clone(), &mut words);
                let has =
                    |wanted: &str| words.iter().any(|word| word.len() == 1 && word[0] == wanted);
                has("test") && !has("not") && !has("any")
            }
    })
}

fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(item) => &item.attrs,
        Item::Enum(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Macro(item) => &item.attrs,
        Item::Mod(item) => &item.attrs,
        Item::Static(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        Item::Trait(item) => &item.attrs,
        Item::Type(item) => &item.attrs,
        Item::Union(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        _ => &[],
    }
}

fn defined_name(item: &Item) -> Option<String> {
    let ident = match item {
        Item::Const(item) => &item.ident,
        Item::Enum(item) => &item.ident,
        Item::Fn(item) => &item.sig.ident,
        Item::Macro(item) => item.ident.as_ref()?,
        Item::Static(item) => &item.ident,
        Item::Struct(item) => &item.ident,
        Item::Trait(item) => &item.ident,
        Item::Type(item) => &item.ident,
        Item::Union(item) => &item.ident,
        _ => return None,
    };
    Some(ident.to_string())
}
