//! VRML 1.0 (specification of 26 May 1995 with the clarifications of 1996) and
//! VRML 97 (ISO/IEC 14772-1), plain or packed with gzip.
//!
//! ```text
//! bytes --unpack, lexer, parser--> Document --walk_v1 or walk_v2--> Model
//!                                    ^                |
//!                                    '--- inline <----'  files beside it
//! ```
//!
//! One grammar serves both versions ([`parser`]); what their nodes mean differs:
//! VRML 1.0 keeps a state that every node changes for those behind it, VRML 97
//! hangs everything on the shape. What is not drawn (lights, cameras, sound,
//! sensors, animation) is passed over; what would be drawn but is not read is
//! said in the report.
//!
//! Rejected: the tables of all nodes and fields that a strict reader needs.
//! They would refuse what every other program reads.

mod builder;
mod document;
mod elevation_grid;
mod extrusion;
mod face_writer;
mod faces;
mod inline;
mod lexer;
mod lines;
mod lists;
mod materials;
mod origin;
mod parser;
mod scene;
mod shapes_v1;
mod shapes_v2;
mod solids;
mod textures;
mod transforms;
mod traversal;
mod unpack;
mod walk_v1;
mod walk_v2;

#[cfg(test)]
mod tests;

use std::path::Path;

use self::document::Document;
use self::origin::Origin;
use self::scene::{Placement, Scene};
use super::error::{ReadError, ReadErrorKind};
use super::source::Source;
use crate::model::Model;
use crate::report::Report;

/// The language that a file is written in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Version {
    /// VRML 1.0.
    One,
    /// VRML 2.0, which became VRML 97.
    Two,
}

/// Reads a scene, with the files that it inlines from its folder or below.
///
/// # Errors
/// [`ReadErrorKind::Format`] without a header, [`ReadErrorKind::Empty`] where all
/// that would be drawn was left out, [`ReadErrorKind::Syntax`] and
/// [`ReadErrorKind::Number`] for text that is none, [`ReadErrorKind::Index`] for
/// corners that are no points, [`ReadErrorKind::Cycle`] where a file inlines
/// itself, and [`ReadErrorKind::Size`] where far more is made than written.
pub(super) fn read_vrml(source: &Source, report: &mut Report) -> Result<Model, ReadError> {
    let document = parse(Origin::of_model(source), source.bytes, report)?;
    let file = source
        .folder
        .and_then(|folder| folder.join(Path::new(source.name).file_name()?).canonicalize().ok());
    let mut scene = Scene::new(file, report);
    scene.allow(&document);
    scene.walk(&document, Placement::default())?;
    let model = scene.finish();
    match report.warnings().first() {
        Some(warning) if model.corner_positions.is_empty() && model.segments.is_empty() => {
            let what = format!("nothing is left to draw: {}", warning.message);
            Err(source.error(ReadErrorKind::Empty, warning.place.clone(), what))
        }
        _ => Ok(model),
    }
}

/// Parses a file, packed or not.
fn parse(origin: Origin, bytes: &[u8], report: &mut Report) -> Result<Document, ReadError> {
    let text = unpack::unpack(&origin, bytes)?;
    let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&text);
    let Some(version) = version_of(text) else {
        let what = "does not begin with '#VRML V1.0 ascii' or '#VRML V2.0 utf8', the two \
                    versions that are read";
        return Err(origin.error(ReadErrorKind::Format, 1, what));
    };
    parser::parse(origin, version, text, report)
}

/// The version that the first line states.
fn version_of(text: &[u8]) -> Option<Version> {
    let stated = text.strip_prefix(b"#VRML")?.trim_ascii_start();
    match stated.get(..3)? {
        b"V1." => Some(Version::One),
        b"V2." => Some(Version::Two),
        _ => None,
    }
}

/// A document from text that is sound; for tests.
#[cfg(test)]
fn parsed(text: &str) -> Document {
    let source = Source { name: "test.wrl", folder: None, bytes: text.as_bytes() };
    parse(Origin::of_model(&source), source.bytes, &mut Report::default()).unwrap()
}
