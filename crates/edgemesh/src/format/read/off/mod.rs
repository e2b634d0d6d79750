//! OFF, text and binary.
//!
//! Source: Geomview, *OFF Files* (manual, section 4.2.5), and what programs write
//! today: the keyword without a line end behind it (`OFF8 6 12`), counts on its line,
//! two counts instead of three, and colors of vertices as bytes.
//!
//! ```text
//! COFF                            a keyword, here with colors; may be missing
//! 3 1 0                           vertices, faces, edges (ignored)
//! 0 0 0  255 0 0 255   # red      position, normal (N), color (C), texture (ST)
//! ...
//! 3  0 1 2  1 0 0                 count, vertices counted from 0, color of the face
//! ```
//!
//! Each vertex and face is a row on a line of its own, because only the end of the
//! line ends a color. Rejected: vertices that continue in the next line, which Geomview
//! reads. A vertex without its last value would then take one from the next vertex.
//!
//! Colors are display values, coded as sRGB. Those of faces are those of their corners, unless
//! vertices have colors; one of a single number, an index of a table elsewhere, is ignored. A truncated file is an error, because faces name
//! vertices that may be missing.

mod binary;
mod elements;
mod header;
mod text;

#[cfg(test)]
mod tests;

use self::binary::read_binary;
pub(super) use self::header::begins_with_keyword;
use self::header::read_header;
use self::text::read_text;
use super::error::ReadError;
use super::source::Source;
use crate::model::Model;
use crate::report::Report;

/// Reads an OFF file.
///
/// # Errors
/// Format: not OFF, or vertices of more than three dimensions. Syntax: a row breaks the
/// rules. Number: a word is not a number. Index: a vertex does not exist. Truncated: the
/// file is shorter than its counts state. Size: too many elements.
pub(super) fn read_off(source: &Source, report: &mut Report) -> Result<Model, ReadError> {
    let header = read_header(source)?;
    if header.is_binary {
        read_binary(source, &header, report)
    } else {
        read_text(source, header, report)
    }
}
