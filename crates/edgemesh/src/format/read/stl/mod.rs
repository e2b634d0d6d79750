//! STL, text and binary.
//!
//! Source: 3D Systems, *Stereolithography Interface Specification* (1988), and
//! what programs write today. Neither form shares vertices: each facet becomes
//! three new vertices, which the builder welds. Normals are ignored, because they
//! follow from the corners and are often wrong. So is the attribute word, which
//! some programs fill with a color.
//!
//! The word `solid` does not distinguish the forms: binary files may begin with it.
//! So the size is checked first, then whether the start has zero bytes, which
//! binary files have and text has not:
//!
//! ```text
//! size = 84 + 50 * count                      binary
//! no zero byte, and 'solid' or 'facet'        text
//! otherwise                                   binary, with a wrong count
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

/// The bytes that are examined to distinguish the forms.
const HEAD_BYTES: usize = 1024;

/// Reads an STL file; the named solids of a text file become groups.
///
/// A truncated file gives its complete facets, with a warning.
///
/// # Errors
/// Empty: the count of a binary file is 0. Truncated: a binary file has no complete
/// facet. Number: a coordinate of a text file is not a number.
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
    fn forms_are_distinguished() {
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
        assert_eq!(counts(facet.as_bytes()), (1, 1), "text without a solid");
    }
}
