//! Resolves the paths in each file to the files that define them.

use std::collections::{BTreeMap, BTreeSet};

use super::source::{Import, Module, Path, read_file};

/// The target of a path.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Named {
    /// A definition in a file of the workspace.
    Item { file: String, name: String },
    /// A module of the workspace, without a name in it.
    Module { file: String },
    /// An item of another crate; the first segment is the name of the crate.
    Foreign(Path),
}

/// A file with an item that it names.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Use {
    pub(super) from: String,
    pub(super) to: Named,
    /// Whether it is only exported again, by `pub use`.
    pub(super) is_door: bool,
}

/// The modules of several crates.
#[derive(Debug, Default)]
pub(super) struct Tree {
    modules: Vec<Module>,
    /// The libraries by their names in code.
    libraries: BTreeMap<String, usize>,
}

impl Tree {
    /// Adds a crate by its root, `lib.rs` or `main.rs`. A library has a name.
    pub(super) fn add_crate(
        &mut self,
        name: Option<&str>,
        root: &str,
        files: &BTreeMap<String, String>,
    ) -> Result<(), String> {
        if let Some(name) = name {
            self.libraries.insert(name.to_owned(), self.modules.len());
        }
        let (folder, _) = root.rsplit_once('/').unwrap_or(("", root));
        self.add_file(root, folder, None, files).map(drop)
    }

    /// Adds a file and the files of the modules it declares; those are in `folder`.
    fn add_file(
        &mut self,
        file: &str,
        folder: &str,
        parent: Option<usize>,
        files: &BTreeMap<String, String>,
    ) -> Result<usize, String> {
        let text = files.get(file).ok_or_else(|| format!("{file}: no such file"))?;
        let index = self.modules.len();
        let declared = read_file(file, text, parent, &mut self.modules)
            .map_err(|error| format!("{file}: {error}"))?;
        for (declaring, name) in declared {
            let inner = format!("{folder}/{name}");
            let candidates = [format!("{inner}.rs"), format!("{inner}/mod.rs")];
            let child = candidates.iter().find(|path| files.contains_key(*path));
            let child = child.ok_or_else(|| format!("{file}: no file for `mod {name}`"))?;
            let child = self.add_file(child, &inner, Some(declaring), files)?;
            self.modules[declaring].children.insert(name, child);
        }
        Ok(index)
    }

    pub(super) fn files(&self) -> BTreeSet<&str> {
        self.modules.iter().map(|module| module.file.as_str()).collect()
    }

    /// All uses, except those of a file's own items.
    pub(super) fn uses(&self) -> BTreeSet<Use> {
        let mut uses = BTreeSet::new();
        for (index, module) in self.modules.iter().enumerate() {
            let mut add = |named: Option<Named>, is_door| match named {
                Some(Named::Item { file, .. } | Named::Module { file }) if file == module.file => {}
                Some(to) => drop(uses.insert(Use { from: module.file.clone(), to, is_door })),
                None => {}
            };
            for import in &module.imports {
                add(self.follow(index, &import.path, Some(import), 0), import.is_door);
            }
            for path in &module.paths {
                add(self.follow(index, path, None, 0), false);
            }
        }
        uses
    }

    /// The target of a path in a module; `None` for local and built-in names. `import` is
    /// the `use` that the path is from: it does not resolve its own path.
    fn follow(
        &self,
        module: usize,
        path: &[String],
        import: Option<&Import>,
        depth: usize,
    ) -> Option<Named> {
        let (first, rest) = path.split_first()?;
        match first.as_str() {
            _ if depth > 16 => None,
            "" => Some(self.follow_foreign(rest, depth)),
            "crate" => self.walk(self.root(module), rest, None, depth),
            "self" => self.walk(module, rest, import, depth),
            "super" => self.walk(self.modules[module].parent?, rest, import, depth),
            name if self.knows(module, name, import) => self.walk(module, path, import, depth),
            name if self.libraries.contains_key(name) => Some(self.follow_foreign(path, depth)),
            // A variable, a type parameter, an item of the prelude.
            _ if rest.is_empty() && import.is_none() => None,
            _ => Some(Named::Foreign(path.to_vec())),
        }
    }

    fn follow_foreign(&self, path: &[String], depth: usize) -> Named {
        let library = path.first().and_then(|name| self.libraries.get(name));
        library
            .and_then(|&root| self.walk(root, &path[1..], None, depth))
            .unwrap_or_else(|| Named::Foreign(path.to_vec()))
    }

    /// Follows a path from a module.
    fn walk(
        &self,
        mut module: usize,
        path: &[String],
        import: Option<&Import>,
        depth: usize,
    ) -> Option<Named> {
        for (at, name) in path.iter().enumerate() {
            let here = &self.modules[module];
            if name == "super" {
                module = here.parent?;
            } else if let Some(&child) = here.children.get(name) {
                module = child;
            } else if here.items.contains(name) {
                return Some(Named::Item { file: here.file.clone(), name: name.clone() });
            } else if let Some(door) = self.door(module, name, import) {
                let tail = if door.name == "*" { &path[at..] } else { &path[at + 1..] };
                let path = [&door.path, tail].concat();
                return self.follow(module, &path, Some(door), depth + 1);
            } else {
                return Some(Named::Item { file: here.file.clone(), name: name.clone() });
            }
        }
        Some(Named::Module { file: self.modules[module].file.clone() })
    }

    fn knows(&self, module: usize, name: &str, import: Option<&Import>) -> bool {
        let here = &self.modules[module];
        here.children.contains_key(name)
            || here.items.iter().any(|item| item == name)
            || self.door(module, name, import).is_some()
    }

    /// The `use` of a module that brings a name in, other than `import` itself.
    fn door(&self, module: usize, name: &str, import: Option<&Import>) -> Option<&Import> {
        let imports = &self.modules[module].imports;
        let mut others =
            imports.iter().filter(|other| !import.is_some_and(|own| std::ptr::eq(own, *other)));
        others.clone().find(|import| import.name == name).or_else(|| {
            others.find(|import| {
                import.name == "*"
                    && self.glob_target(module, import).is_some_and(|inner| {
                        let inner = &self.modules[inner];
                        inner.children.contains_key(name)
                            || inner.items.iter().any(|item| item == name)
                            || inner.imports.iter().any(|import| import.name == name)
                    })
            })
        })
    }

    /// The module of a `use path::*`, if it is in the workspace.
    fn glob_target(&self, module: usize, import: &Import) -> Option<usize> {
        let (first, rest) = import.path.split_first()?;
        let mut at = match first.as_str() {
            "crate" => self.root(module),
            "self" => module,
            "super" => self.modules[module].parent?,
            name => {
                *self.modules[module].children.get(name).or_else(|| self.libraries.get(name))?
            }
        };
        for name in rest {
            at = match name.as_str() {
                "super" => self.modules[at].parent?,
                name => *self.modules[at].children.get(name)?,
            };
        }
        Some(at)
    }

    fn root(&self, mut module: usize) -> usize {
        while let Some(parent) = self.modules[module].parent {
            module = parent;
        }
        module
    }
}

/// A file that names another.
#[derive(Debug)]
pub(super) struct Arrow {
    pub(super) from: String,
    pub(super) to: String,
    pub(super) names: BTreeSet<String>,
}

type Arrows<'a> = BTreeMap<&'a str, BTreeMap<&'a str, BTreeSet<String>>>;

/// The arrows of each group of files that name each other in a circle.
///
/// Items of the `mod.rs` of a file's own folder do not count, since the files of a folder
/// share them. Nor does `pub use`, which only exports again.
pub(super) fn circles(uses: &BTreeSet<Use>) -> Vec<Vec<Arrow>> {
    let mut arrows = Arrows::new();
    for Use { from, to, is_door } in uses {
        if let (Named::Item { file, name }, false) = (to, is_door)
            && !is_of_own_folder(from, file)
        {
            arrows.entry(from).or_default().entry(file).or_default().insert(name.clone());
        }
    }
    let reach: BTreeMap<&str, BTreeSet<&str>> =
        arrows.keys().map(|&file| (file, reached(file, &arrows))).collect();
    let reaches = |a: &str, b: &str| reach.get(a).is_some_and(|all| all.contains(b));
    let mut done = BTreeSet::new();
    let mut circles = Vec::new();
    for &file in arrows.keys().filter(|file| reaches(file, file)) {
        if done.contains(file) {
            continue;
        }
        let is_member = |other: &str| reaches(file, other) && reaches(other, file);
        let members: Vec<&str> = arrows.keys().copied().filter(|other| is_member(other)).collect();
        let of_member = |&from: &&str| {
            let inside = arrows[from].iter().filter(|(to, _)| members.contains(to));
            let arrow = |(to, names): (&&str, &BTreeSet<String>)| Arrow {
                from: from.to_owned(),
                to: (*to).to_owned(),
                names: names.clone(),
            };
            inside.map(arrow).collect::<Vec<_>>()
        };
        circles.push(members.iter().flat_map(of_member).collect());
        done.extend(members);
    }
    circles
}

fn is_of_own_folder(from: &str, file: &str) -> bool {
    file.strip_suffix("mod.rs").is_some_and(|folder| from.starts_with(folder))
}

/// The files that can be reached by one arrow or more.
fn reached<'a>(start: &'a str, arrows: &Arrows<'a>) -> BTreeSet<&'a str> {
    let mut reached = BTreeSet::new();
    let mut open = vec![start];
    while let Some(file) = open.pop() {
        for &next in arrows.get(file).into_iter().flat_map(BTreeMap::keys) {
            if reached.insert(next) {
                open.push(next);
            }
        }
    }
    reached
}
