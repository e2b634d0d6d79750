//! VRML 1.0 (specification of 26 May 1995 with the clarifications of 1996) and
//! VRML 97 (ISO/IEC 14772-1), plain or packed with gzip.
//!
//! ```text
//! bytes --parse--> Document --scene--> Model
//!            ^                  |
//!            '-- inlined files -'
//! ```
//!
//! Both versions have one grammar ([`parse`]). Their nodes differ ([`scene`]): in VRML 1.0
//! each node changes a state for the nodes after it, in VRML 97 a shape has its
//! properties as fields. Nodes that are not drawn (lights, cameras, sound, sensors,
//! animation) are ignored; unsupported nodes that would be drawn give a warning.
//!
//! Rejected: the tables of all nodes and fields that a strict reader needs. It would
//! refuse files that every other program reads.

mod parse;
mod scene;

#[cfg(test)]
mod tests;

use std::path::Path;

use self::parse::{Origin, decode};
use self::scene::build_model;
use super::error::{ReadError, ReadErrorKind};
use super::source::Source;
use crate::model::Model;
use crate::report::Report;

/// Reads a scene, with the files that it inlines from its folder or below.
///
/// # Errors
/// [`ReadErrorKind::Format`] without a valid header, [`ReadErrorKind::Empty`] if all that
/// would be drawn was left out, [`ReadErrorKind::Syntax`] and [`ReadErrorKind::Number`]
/// for malformed text, [`ReadErrorKind::Index`] for corners out of range,
/// [`ReadErrorKind::Cycle`] if a file inlines itself, and [`ReadErrorKind::Size`] if the
/// scene generates too many elements.
pub(super) fn read_vrml(source: &Source, report: &mut Report) -> Result<Model, ReadError> {
    let document = decode(Origin::of_model(source), source.bytes, report)?;
    let path = source
        .folder
        .and_then(|folder| folder.join(Path::new(source.name).file_name()?).canonicalize().ok());
    let model = build_model(&document, path, report)?;
    match report.warnings().first() {
        Some(warning) if model.corner_positions.is_empty() && model.segments.is_empty() => {
            let what = format!("nothing to draw: {}", warning.message);
            Err(source.error(ReadErrorKind::Empty, warning.place.clone(), what))
        }
        _ => Ok(model),
    }
}
