//! All model parts that a file needs, and the objects that references lead to.

use std::collections::HashMap;

use super::super::error::{ReadError, ReadErrorKind};
use super::archive::Archive;
use super::model_part::{Content, ModelPart, Object, Reference};
use super::part_reader::read_part;
use super::relationships::first_part;
use super::xml::place_of;
use crate::report::Report;

/// The model parts of a file.
#[derive(Debug)]
pub(super) struct Package {
    /// The parts; the first has the build.
    pub(super) parts: Vec<ModelPart>,
    /// The part and the place in it of each object, by the index of the part and its id.
    objects: HashMap<(usize, u32), (usize, usize)>,
    /// The indices of the parts, by their names in lower case.
    names: HashMap<String, usize>,
    /// The bytes of the unpacked parts.
    pub(super) bytes: u64,
}

/// An object of a package: the index of its part, and its index there.
pub(super) type ObjectIndex = (usize, usize);

impl Package {
    /// The object with this index.
    pub(super) fn object(&self, (part, object): ObjectIndex) -> Option<&Object> {
        self.parts.get(part)?.objects.get(object)
    }

    /// The object that a reference in the part `from` leads to.
    pub(super) fn target(&self, from: usize, reference: &Reference) -> Option<ObjectIndex> {
        let part = match &reference.part {
            Some(name) => *self.names.get(&key(name))?,
            None => from,
        };
        self.objects.get(&(part, reference.object)).copied()
    }
}

/// Reads the first model part and those that it names, directly or not.
///
/// # Errors
/// Those of the archive and of the parts; Syntax if a reference leads to no object, or
/// two objects have one id.
pub(super) fn read_package(archive: &Archive, report: &mut Report) -> Result<Package, ReadError> {
    let first = first_part(archive, report)?;
    let mut package =
        Package { parts: Vec::new(), objects: HashMap::new(), names: HashMap::new(), bytes: 0 };
    let mut waiting = vec![first];
    while let Some(name) = waiting.pop() {
        if package.names.contains_key(&key(&name)) {
            continue;
        }
        let part = read_part(archive, name, report)?;
        package.names.insert(key(&part.name), package.parts.len());
        add_objects(archive, &mut package, &part)?;
        waiting.extend(references(&part).filter_map(|reference| reference.part.clone()));
        package.parts.push(part);
    }
    package.bytes = archive.unpacked();
    check_references(archive, &package)?;
    Ok(package)
}

fn key(name: &str) -> String {
    name.trim_start_matches('/').to_ascii_lowercase()
}

fn add_objects(
    archive: &Archive,
    package: &mut Package,
    part: &ModelPart,
) -> Result<(), ReadError> {
    let index = package.parts.len();
    for (at, object) in part.objects.iter().enumerate() {
        if package.objects.insert((index, object.id), (index, at)).is_some() {
            let what = format!("two objects have the id {}", object.id);
            let place = Some(place_of(&part.name, object.line));
            return Err(archive.source.error(ReadErrorKind::Syntax, place, what));
        }
    }
    Ok(())
}

/// All references of a part to objects.
fn references(part: &ModelPart) -> impl Iterator<Item = &Reference> {
    let components = part.objects.iter().filter_map(|object| match &object.content {
        Content::Components(components) => Some(components),
        Content::Mesh(_) => None,
    });
    part.items.iter().chain(components.flatten())
}

fn check_references(archive: &Archive, package: &Package) -> Result<(), ReadError> {
    for (index, part) in package.parts.iter().enumerate() {
        let wrong = references(part).find(|one| package.target(index, one).is_none());
        if let Some(Reference { object, line, part: named, .. }) = wrong {
            let named = named.as_ref().unwrap_or(&part.name);
            let what = format!("names object {object}, which is not in {named}");
            let place = Some(place_of(&part.name, *line));
            return Err(archive.source.error(ReadErrorKind::Syntax, place, what));
        }
    }
    Ok(())
}
