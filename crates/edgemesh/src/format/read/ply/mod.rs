//! PLY, text and binary in both byte orders.
//!
//! Source: G. Turk, *The PLY Polygon File Format* (1994), and what programs
//! write today. The header describes rows of values; their meaning is a convention
//! of names, which [`elements`] lists in tables. Unknown elements are skipped with a
//! warning, because they may be geometry; unknown properties, such as `confidence`
//! or `alpha`, without one.
//!
//! ```text
//! header --> elements, each with a RowPlan --> rows: text or binary --> elements --> Model
//! ```
//!
//! A truncated file is an error, because faces name vertices that may be missing.

mod binary;
mod elements;
mod header;
mod rows;
mod scalar;
mod text;

#[cfg(test)]
mod tests;

use self::binary::BinaryRows;
use self::elements::read_elements;
use self::header::{Encoding, read_header};
use self::text::TextRows;
use super::error::ReadError;
use super::source::Source;
use crate::model::Model;
use crate::report::Report;

/// Reads a PLY file: polygons, triangle strips and edges.
///
/// # Errors
/// Format: not PLY 1.0. Syntax: the header or a row breaks the rules. Number: a word
/// is not a number. Index: a vertex does not exist. Truncated: the file is shorter
/// than its header states. Size: too many elements.
pub(super) fn read_ply(source: &Source, report: &mut Report) -> Result<Model, ReadError> {
    let header = read_header(source, report)?;
    match header.encoding {
        Encoding::Ascii => {
            read_elements(source, &header, &mut TextRows::new(source, &header), report)
        }
        Encoding::LittleEndian | Encoding::BigEndian => {
            read_elements(source, &header, &mut BinaryRows::new(source, &header), report)
        }
    }
}
