//! Reads a model part: its extensions, its resources and its build.

use std::collections::HashMap;

use glam::DAffine3;

use super::super::error::{ReadError, ReadErrorKind};
use super::archive::Archive;
use super::mesh_reader::read_mesh;
use super::model_part::{Content, ModelPart, Object, Property, Reference};
use super::property_reader::read_group;
use super::values::{transform, unit};
use super::xml::{Element, Namespace, Xml};
use crate::report::Report;

/// The unit of a part that states none.
const DEFAULT_UNIT: f64 = 1e-3;

/// Namespaces of extensions that may be required: they are supported, or add what a
/// picture of the surface does not need.
const SUPPORTED_OR_HARMLESS: [&str; 6] = [
    "http://schemas.microsoft.com/3dmanufacturing/core/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/material/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/production/2015/06",
    "http://schemas.microsoft.com/3dmanufacturing/production/alternatives/2021/04",
    "http://schemas.microsoft.com/3dmanufacturing/slice/2015/07",
    "http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07",
];

/// Types of objects that are not part of the printed model.
const OTHER_KINDS: [&str; 3] = ["other", "support", "solidsupport"];

/// Resources that no object needs: pictures, slices.
const UNUSED_RESOURCES: [&[u8]; 2] = [b"texture2d", b"slicestack"];

/// Children of objects that add nothing to a picture.
const UNUSED_OF_OBJECTS: [&[u8]; 2] = [b"metadatagroup", b"alternatives"];

/// Reads the part `name`.
///
/// # Errors
/// Those of the archive; Format: another root than `model`. Extension: a required
/// extension is not supported. Syntax, Number, Index: the part breaks the rules.
pub(super) fn read_part(
    archive: &Archive,
    name: String,
    report: &mut Report,
) -> Result<ModelPart, ReadError> {
    let text = archive.read(&name)?;
    let mut xml = Xml::new(archive.source, &name, &text)?;
    let root = xml.root()?;
    if root.namespace != Namespace::Core || root.name() != b"model" {
        let what = format!("the root is '{}', not a model of 3MF", root.shown_name());
        return Err(xml.error(ReadErrorKind::Format, what));
    }
    check_extensions(&mut xml, &root)?;
    let unit = match root.attribute(b"unit") {
        None => DEFAULT_UNIT,
        Some(word) => unit(&word).ok_or_else(|| {
            xml.error(ReadErrorKind::Syntax, format!("'{}' is not a unit", word.escape_debug()))
        })?,
    };
    let (objects, groups, items) = (Vec::new(), HashMap::new(), Vec::new());
    let mut part = ModelPart { name: String::new(), unit, objects, groups, items };
    while let Some(element) = xml.child()? {
        match (element.namespace, element.name()) {
            (Namespace::Core, b"resources") => read_resources(&mut xml, &mut part, report)?,
            (Namespace::Core, b"build") => part.items = read_references(&mut xml, b"item")?,
            _ => xml.skip()?,
        }
    }
    part.name = name;
    Ok(part)
}

fn check_extensions(xml: &mut Xml, root: &Element) -> Result<(), ReadError> {
    let required = root.attribute(b"requiredextensions").unwrap_or_default();
    for prefix in required.split_ascii_whitespace() {
        let name = xml.namespace_of_prefix(prefix).unwrap_or_else(|| prefix.to_owned());
        if !SUPPORTED_OR_HARMLESS.contains(&name.as_str()) {
            let what = format!(
                "the file requires the extension {}, which is not supported: export the model \
                 without it",
                name.escape_debug()
            );
            return Err(xml.error(ReadErrorKind::Extension, what));
        }
    }
    Ok(())
}

fn read_resources(
    xml: &mut Xml,
    part: &mut ModelPart,
    report: &mut Report,
) -> Result<(), ReadError> {
    while let Some(element) = xml.child()? {
        match (element.namespace, element.name()) {
            (Namespace::Core, b"object") => {
                let object = read_object(xml, &element, report)?;
                part.objects.push(object);
            }
            (_, name) if UNUSED_RESOURCES.contains(&name) => xml.skip()?,
            _ => match read_group(xml, &element)? {
                Some((id, group)) => _ = part.groups.insert(id, group),
                None => xml.skip_with_warning(&element, report)?,
            },
        }
    }
    Ok(())
}

fn read_object(xml: &mut Xml, element: &Element, report: &mut Report) -> Result<Object, ReadError> {
    let id = xml.required_index(element, b"id")?;
    let kind = element.attribute(b"type").unwrap_or_default();
    let other_kind = OTHER_KINDS.contains(&&*kind).then(|| kind.into_owned());
    let group = xml.optional_index(element, b"pid")?;
    let index = xml.optional_index(element, b"pindex")?.unwrap_or(0);
    let name = element.attribute(b"name").unwrap_or_default().into_owned();
    let property = group.map(|group| Property { group, index });
    let line = xml.line();
    let mut content = None;
    while let Some(child) = xml.child()? {
        match (child.namespace, child.name()) {
            (Namespace::Core, b"mesh") => {
                content = Some(Content::Mesh(read_mesh(xml, property, report)?));
            }
            (Namespace::Core, b"components") => {
                content = Some(Content::Components(read_references(xml, b"component")?));
            }
            (_, name) if UNUSED_OF_OBJECTS.contains(&name) => xml.skip()?,
            _ => xml.skip_with_warning(&child, report)?,
        }
    }
    let content = content.unwrap_or(Content::Components(Vec::new()));
    Ok(Object { id, name, other_kind, property, content, line })
}

/// Reads the children with this name, which place objects.
fn read_references(xml: &mut Xml, name: &[u8]) -> Result<Vec<Reference>, ReadError> {
    let mut references = Vec::new();
    while let Some(element) = xml.child()? {
        if element.namespace == Namespace::Core && element.name() == name {
            references.push(reference(xml, &element)?);
        }
        xml.skip()?;
    }
    Ok(references)
}

fn reference(xml: &mut Xml, element: &Element) -> Result<Reference, ReadError> {
    let object = xml.required_index(element, b"objectid")?;
    let transform = match element.attribute(b"transform") {
        None => DAffine3::IDENTITY,
        Some(text) => transform(&text)
            .ok_or_else(|| xml.error(ReadErrorKind::Number, "a transform needs twelve numbers"))?,
    };
    let part =
        xml.attribute_in(element, Namespace::Production, b"path").map(|path| path.into_owned());
    Ok(Reference { part, object, transform, line: xml.line() })
}
