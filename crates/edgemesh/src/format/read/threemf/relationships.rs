//! Finds the model part that a file begins with.
//!
//! Source: ECMA-376, *Open Packaging Conventions*, chapter 9 (relationships). The part
//! `_rels/.rels` names it; some programs forget that, but nearly all use the same name.

use super::super::error::{ReadError, ReadErrorKind};
use super::archive::Archive;
use super::xml::{Namespace, Xml};
use crate::report::Report;

/// The part with the relationships of the whole archive.
const RELATIONSHIPS: &str = "_rels/.rels";

/// The type of the relationship to the model part.
const MODEL_TYPE: &str = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";

/// The usual name of the model part.
const USUAL_NAME: &str = "3D/3dmodel.model";

/// The name of the first model part.
///
/// # Errors
/// Format: the archive has no model part.
pub(super) fn first_part(archive: &Archive, report: &mut Report) -> Result<String, ReadError> {
    let named = match archive.has(RELATIONSHIPS) {
        true => named_part(archive).unwrap_or_else(|error| {
            error.warn_left_out(report);
            None
        }),
        false => None,
    };
    let candidates = named.into_iter().chain([USUAL_NAME.to_owned()]);
    candidates.into_iter().find(|name| archive.has(name)).ok_or_else(|| {
        let what = "is a ZIP archive without a 3D model part, so it is not a 3MF file";
        archive.source.error(ReadErrorKind::Format, None, what)
    })
}

fn named_part(archive: &Archive) -> Result<Option<String>, ReadError> {
    let text = archive.read(RELATIONSHIPS)?;
    let mut xml = Xml::new(archive.source, RELATIONSHIPS, &text)?;
    xml.root()?;
    while let Some(element) = xml.child()? {
        let is_relationship = element.namespace == Namespace::Relationships
            && element.name() == b"Relationship"
            && element.attribute(b"Type").is_some_and(|kind| kind == MODEL_TYPE);
        if is_relationship && let Some(target) = element.attribute(b"Target") {
            return Ok(Some(target.trim_start_matches('/').to_owned()));
        }
        xml.skip()?;
    }
    Ok(None)
}
