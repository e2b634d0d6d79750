//! Reads groups of properties: materials and colors.
//!
//! ```text
//! <basematerials id="1">  <base name="steel" displaycolor="#808080"/> ...
//! <m:colorgroup id="2">   <m:color color="#ff0000"/> ...
//! ```

use super::super::error::{ReadError, ReadErrorKind};
use super::super::words::quoted;
use super::model_part::PropertyGroup;
use super::values::color;
use super::xml::{Element, Namespace, Xml};
use crate::model::Material;

/// Groups that are known and not supported. Triangles with them have no material.
const UNSUPPORTED: [&[u8]; 3] = [b"texture2dgroup", b"compositematerials", b"multiproperties"];

/// Reads a group of properties, with its id; `None`, without entering the element, if it
/// is something else.
///
/// # Errors
/// Syntax: a color is malformed, or an id is missing.
pub(super) fn read_group(
    xml: &mut Xml,
    element: &Element,
) -> Result<Option<(u32, PropertyGroup)>, ReadError> {
    let (child, color_name): (&[u8], &[u8]) = match (element.namespace, element.name()) {
        (Namespace::Core, b"basematerials") => (b"base", b"displaycolor"),
        (Namespace::Materials, b"colorgroup") => (b"color", b"color"),
        (Namespace::Materials, name) if UNSUPPORTED.contains(&name) => {
            let id = xml.required_index(element, b"id")?;
            xml.skip()?;
            return Ok(Some((id, PropertyGroup::Unsupported(element.shown_name()))));
        }
        _ => return Ok(None),
    };
    let id = xml.required_index(element, b"id")?;
    let mut materials = Vec::new();
    while let Some(element) = xml.child()? {
        if element.name() == child {
            materials.push(material(xml, &element, color_name)?);
        }
        xml.skip()?;
    }
    Ok(Some((id, PropertyGroup::Materials(materials))))
}

fn material(xml: &mut Xml, element: &Element, color_name: &[u8]) -> Result<Material, ReadError> {
    let name = element.attribute(b"name").unwrap_or_default().into_owned();
    let Some(text) = element.attribute(color_name) else {
        return Ok(Material { name, ..Material::default() });
    };
    let Some((diffuse, opacity)) = color(&text) else {
        let what = format!("{} is not a color such as #rrggbb", quoted(text.as_bytes()));
        return Err(xml.error(ReadErrorKind::Syntax, what));
    };
    Ok(Material { name, diffuse: Some(diffuse), opacity, ..Material::default() })
}
