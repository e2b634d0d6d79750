//! Turns the bytes of a file into a document.

use super::document::Document;
use super::origin::Origin;
use super::parser::parse;
use super::unpack::unpack;
use super::version::Version;
use crate::format::read::byte_order_mark::without_mark;
use crate::format::read::error::{ReadError, ReadErrorKind};
use crate::report::Report;

/// Parses a file, plain or packed with gzip.
///
/// # Errors
/// [`ReadErrorKind::Format`] if the header is missing or of another version, and the
/// errors of [`unpack`] and [`parse`].
pub(crate) fn decode(
    origin: Origin,
    bytes: &[u8],
    report: &mut Report,
) -> Result<Document, ReadError> {
    let text = unpack(&origin, bytes)?;
    let text = without_mark(&text);
    let Some(version) = Version::of_header(text) else {
        let what = "does not begin with '#VRML V1.0 ascii' or '#VRML V2.0 utf8', the two \
                    supported versions";
        return Err(origin.error(ReadErrorKind::Format, 1, what));
    };
    parse(origin, version, text, report)
}
