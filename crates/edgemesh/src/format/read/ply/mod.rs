//! PLY, as text and as bytes of both orders.
//!
//! Source: G. Turk, *The PLY Polygon File Format* (1994), and what programs
//! write today. The header describes rows of values; what they mean is only a
//! convention of names, which [`elements`] has in tables. All that has no place
//! there is stepped over: elements with a warning, since they may be geometry,
//! single properties without one, as `confidence` or `alpha`.
//!
//! ```text
//! header --> elements, each a Plan --> rows: text or binary --> elements --> Model
//! ```
//!
//! A file that ends too early is an error: what is missing is named somewhere
//! in what is there, as faces name vertices.

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

/// Reads a PLY file: polygons, triangle strips, and the edges that it lists.
///
/// # Errors
/// Format: no PLY file of version 1.0. Syntax: a header or row that breaks the
/// rules. Number: a word that is no number. Index: a vertex that is not there.
/// Truncated: fewer bytes than are announced. Size: more elements than can be
/// named.
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
