//! 3MF, as slicers and CAD programs write it for 3D printing.
//!
//! Source: 3MF Consortium, *Core Specification* 1.4, *Materials and Properties
//! Extension* 1.2 and *Production Extension* 1.2; PKWARE, *APPNOTE.TXT* 6.3 for the
//! archive around them.
//!
//! ```text
//! ZIP --archive--> parts --relationships--> model part --xml, part_reader--> Part
//!                                                                             |
//!     other parts that it names (p:path) --package--> Objects <---------------'
//!                                                        |
//!          items of the build and their components --placement--> Model
//! ```
//!
//! The XML is read as a stream, so memory grows with the meshes and not with the text.
//! Rejected: a tree of the XML (`roxmltree`), which takes ten times the memory of the
//! meshes; and the crate `zip`, most of which writes and extracts archives, for the
//! two hundred lines that find a part.
//!
//! Positions stay in the unit of the model part, as in other formats; parts with
//! another unit are scaled to it.

mod archive;
mod mesh_reader;
mod model_part;
mod package;
mod part_reader;
mod placement;
mod property_reader;
mod relationships;
#[cfg(test)]
mod sample;
#[cfg(test)]
mod tests;
mod values;
mod xml;

use self::archive::Archive;
use self::package::read_package;
use self::placement::place_items;
use super::error::ReadError;
use super::source::Source;
use crate::model::Model;
use crate::report::Report;

/// Reads a 3MF file: the meshes that its build places, with their materials.
///
/// # Errors
/// Format: not a ZIP archive with a model part. Truncated: the archive is cut short.
/// Syntax, Number, Index: the XML breaks the rules. Cycle: an object contains itself.
/// Extension: an extension is required that is not supported. Size: too large after
/// unpacking, or after placing components.
pub(super) fn read_3mf(source: &Source, report: &mut Report) -> Result<Model, ReadError> {
    let archive = Archive::open(source)?;
    let package = read_package(&archive, report)?;
    place_items(source, &package, report)
}
