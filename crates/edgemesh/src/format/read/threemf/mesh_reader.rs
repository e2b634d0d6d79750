//! Reads a mesh: its vertices and its triangles with their properties.
//!
//! ```text
//! <triangle v1 v2 v3 pid p1 p2 p3>     pid names a group, p1 to p3 its elements at the
//!                                      corners; without p1, as the object says
//! ```
//!
//! A triangle has the property of its first corner: the model here knows no colors that
//! differ between the corners at one vertex.

use quick_xml::events::attributes::Attribute;

use super::super::error::{ReadError, ReadErrorKind};
use super::super::number::parse_number;
use super::super::words::quoted;
use super::model_part::{Mesh, Property, PropertyRun};
use super::xml::{Element, Namespace, Xml};
use crate::report::{Report, WarningCode};

/// The attributes of a triangle.
const TRIANGLE: [&[u8]; 7] = [b"v1", b"v2", b"v3", b"pid", b"p1", b"p2", b"p3"];

/// Reads the mesh of an object with this property.
///
/// # Errors
/// Syntax: a coordinate or corner is missing. Number: a value is not a number. Index: a
/// vertex does not exist.
pub(super) fn read_mesh(
    xml: &mut Xml,
    of_object: Option<Property>,
    report: &mut Report,
) -> Result<Mesh, ReadError> {
    let mut mesh = Mesh::default();
    while let Some(element) = xml.child()? {
        match (element.namespace, element.name()) {
            (Namespace::Core, b"vertices") => read_vertices(xml, &mut mesh)?,
            (Namespace::Core, b"triangles") => read_triangles(xml, of_object, &mut mesh, report)?,
            // Names for some of the triangles.
            (_, b"trianglesets") => xml.skip()?,
            _ => xml.skip_with_warning(&element, report)?,
        }
    }
    Ok(mesh)
}

fn read_vertices(xml: &mut Xml, mesh: &mut Mesh) -> Result<(), ReadError> {
    while let Some(element) = xml.child()? {
        if element.name() == b"vertex" {
            mesh.positions.push(position(xml, &element)?);
        }
        xml.skip()?;
    }
    Ok(())
}

fn position(xml: &mut Xml, element: &Element) -> Result<[f64; 3], ReadError> {
    let mut found = [None; 3];
    for attribute in element.attributes() {
        let axis = match attribute.key.as_ref() {
            b"x" => 0,
            b"y" => 1,
            b"z" => 2,
            _ => continue,
        };
        let number = parse_number(attribute.value.trim_ascii());
        found[axis] = Some(number.ok_or_else(|| not_a_number(xml, &attribute))?);
    }
    match found {
        [Some(x), Some(y), Some(z)] => Ok([x, y, z]),
        _ => Err(xml.error(ReadErrorKind::Syntax, "a vertex needs x, y and z")),
    }
}

fn read_triangles(
    xml: &mut Xml,
    of_object: Option<Property>,
    mesh: &mut Mesh,
    report: &mut Report,
) -> Result<(), ReadError> {
    let (mut blended, mut first_blended) = (0, None);
    while let Some(element) = xml.child()? {
        if element.name() == b"triangle" {
            let [v1, v2, v3, group, p1, p2, p3] = indices(xml, &element)?;
            let (Some(a), Some(b), Some(c)) = (v1, v2, v3) else {
                return Err(xml.error(ReadErrorKind::Syntax, "a triangle needs v1, v2 and v3"));
            };
            check_corners(xml, [a, b, c], mesh.positions.len())?;
            // Without a second index all corners are alike.
            if [p2, p3].into_iter().flatten().any(|other| Some(other) != p1) {
                blended += 1;
                first_blended.get_or_insert_with(|| xml.place());
            }
            let group = group.or(of_object.map(|property| property.group));
            let property = group.zip(p1).map(|(group, index)| Property { group, index });
            push_run(mesh, property);
            mesh.triangles.push([a, b, c]);
        }
        xml.skip()?;
    }
    report.warn_many(WarningCode::Unsupported, blended, first_blended, || {
        "colors that blend over a triangle are not supported; it has that of its first corner"
            .into()
    });
    Ok(())
}

/// Begins a run of triangles if their property differs from that of the last one.
fn push_run(mesh: &mut Mesh, property: Option<Property>) {
    if mesh.runs.last().and_then(|run| run.property) != property {
        mesh.runs.push(PropertyRun { first: mesh.triangles.len(), property });
    }
}

/// The values of the attributes of [`TRIANGLE`].
fn indices(xml: &mut Xml, element: &Element) -> Result<[Option<u32>; TRIANGLE.len()], ReadError> {
    let mut found = [None; TRIANGLE.len()];
    for attribute in element.attributes() {
        let name = attribute.key.as_ref();
        if let Some(slot) = TRIANGLE.iter().position(|known| *known == name) {
            let index = index(&attribute.value);
            found[slot] = Some(index.ok_or_else(|| not_a_number(xml, &attribute))?);
        }
    }
    Ok(found)
}

fn index(value: &[u8]) -> Option<u32> {
    std::str::from_utf8(value.trim_ascii()).ok()?.parse().ok()
}

fn check_corners(xml: &mut Xml, corners: [u32; 3], count: usize) -> Result<(), ReadError> {
    match corners.into_iter().find(|&corner| corner as usize >= count) {
        None => Ok(()),
        Some(corner) => {
            let what = format!("a triangle names vertex {corner} (counted from 0) of {count}");
            Err(xml.error(ReadErrorKind::Index, what))
        }
    }
}

fn not_a_number(xml: &mut Xml, attribute: &Attribute) -> ReadError {
    let (name, value) = (attribute.key.as_ref().escape_ascii(), quoted(&attribute.value));
    xml.error(ReadErrorKind::Number, format!("{name} is {value}, which is not a number"))
}
