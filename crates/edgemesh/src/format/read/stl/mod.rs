//! STL, as text and as bytes.
//!
//! Source: 3D Systems, *Stereolithography Interface Specification* (1988), and
//! what programs write today. Neither form has shared vertices: each facet
//! becomes three vertices of its own, and the builder welds them. Normals are
//! left out, since they follow from the corners and are often wrong, and so is
//! the attribute word, which some programs fill with a colour.
//!
//! Telling the forms apart by the word `solid` alone fails, as binary files may
//! begin with it. So the size speaks first, and then whether there are zero
//! bytes at the start, which no text has and every binary file:
//!
//! ```text
//! size = 84 + 50 * count                      binary
//! no zero byte, and 'solid' or 'facet'        text
//! all else                                    binary, with a wrong count
//! ```

mod binary;
mod text;

use self::binary::read_binary;
pub(super) use self::binary::size_fits;
use self::text::read_text;
use super::error::ReadError;
use super::source::Source;
use crate::model::Model;
use crate::report::Report;

/// How much of a file is looked at to tell the forms apart.
const HEAD_BYTES: usize = 1024;

/// Reads an STL file; the solids of a text are groups by name.
///
/// A file that ends too early gives the facets that are whole, with a warning.
///
/// # Errors
/// Empty: a count of no triangles. Truncated: not one whole triangle in a
/// binary file. Number: a coordinate of a text is no number.
pub(super) fn read_stl(source: &Source, report: &mut Report) -> Result<Model, ReadError> {
    if !size_fits(source.bytes, source.bytes.len() as u64) && is_text(source.bytes) {
        read_text(source, report)
    } else {
        read_binary(source, report)
    }
}

fn is_text(bytes: &[u8]) -> bool {
    let head = bytes.get(..HEAD_BYTES).unwrap_or(bytes);
    let holds = |word: &[u8]| head.windows(word.len()).any(|part| part.eq_ignore_ascii_case(word));
    !head.contains(&0) && (holds(b"solid") || holds(b"facet"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forms_are_told_apart() {
        let mut binary = b"solid facet".to_vec();
        binary.resize(84 + 50, b' ');
        binary[80..84].copy_from_slice(&1_u32.to_le_bytes());
        let counts = |bytes: &[u8]| {
            let source = Source { name: "test", folder: None, bytes };
            let model = read_stl(&source, &mut Report::default()).unwrap();
            (model.polygon_count(), model.polygon_lines.len())
        };
        assert_eq!(counts(&binary), (1, 0), "by size");
        binary.push(0);
        assert_eq!(counts(&binary), (1, 0), "by zero bytes");
        let facet = "Facet\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendfacet\n";
        assert_eq!(counts(format!("\u{feff} SOLID\n{facet}").as_bytes()), (1, 1));
        assert_eq!(counts(facet.as_bytes()), (1, 1), "no solid, but text");
    }
}
