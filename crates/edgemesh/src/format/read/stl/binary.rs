//! Binary STL, little-endian.
//!
//! ```text
//! 0      80 84                 134
//! | head | n | facet | facet ... |
//!            '-> normal, 3 corners: 12 floats; attribute: 2 bytes
//! ```
//!
//! If the count `n` and the size of the file disagree, the smaller counts, with a
//! warning: bytes after the last counted facet may be anything.

use rayon::prelude::*;

use super::super::error::{ReadError, ReadErrorKind};
use super::super::source::Source;
use crate::index::to_u32;
use crate::model::Model;
use crate::report::{Place, Report, WarningCode};

/// Bytes before the first facet.
const HEAD_BYTES: usize = 84;

/// Bytes of a facet.
const FACET_BYTES: usize = 50;

/// The least number of facets for another thread.
const FACETS_A_THREAD: usize = 1 << 14;

/// Whether `size`, in bytes, is that of a binary STL file whose first bytes are
/// `head`: the format has no signature but its count of facets.
pub(in crate::format::read) fn size_fits(head: &[u8], size: u64) -> bool {
    let needed = |count| HEAD_BYTES as u64 + FACET_BYTES as u64 * u64::from(count);
    count(head).is_some_and(|count| size == needed(count))
}

fn count(bytes: &[u8]) -> Option<u32> {
    Some(u32::from_le_bytes(*bytes.get(HEAD_BYTES - 4..)?.first_chunk()?))
}

/// Reads a binary file.
///
/// # Errors
/// Empty: the count is 0. Truncated: the first facet is incomplete.
pub(super) fn read_binary(source: &Source, report: &mut Report) -> Result<Model, ReadError> {
    let error = |kind, place, what| Err(source.error(kind, Some(Place::Byte(place)), what));
    let size = source.bytes.len();
    let Some(count) = count(source.bytes) else {
        let what = format!("{size} bytes are too few for binary STL, and not text STL");
        return error(ReadErrorKind::Truncated, size as u64, what);
    };
    let body = source.bytes.get(HEAD_BYTES..).unwrap_or_default();
    let (facets, _) = body.as_chunks::<FACET_BYTES>();
    let whole = facets.len();
    if count == 0 {
        let what = match whole {
            0 => "the file has no triangles; export the model again".into(),
            _ => format!(
                "the file states that it has no triangles, though it has room for {whole}; \
                 export the model again"
            ),
        };
        return error(ReadErrorKind::Empty, HEAD_BYTES as u64 - 4, what);
    }
    if whole == 0 {
        let what = format!("the file is truncated: none of {count} triangles is complete");
        return error(ReadErrorKind::Truncated, size as u64, what);
    }
    let facets = facets.get(..count as usize).unwrap_or(facets);
    let rest = body.get(facets.len() * FACET_BYTES..).unwrap_or_default();
    let is_blank = |byte: &u8| *byte == 0 || byte.is_ascii_whitespace();
    if count as usize > whole || !rest.iter().all(is_blank) {
        let place = Place::Byte((size - rest.len()) as u64);
        report.warn(WarningCode::Truncated, Some(place), || {
            format!(
                "the stated number of triangles is {count}, and the file has room for {whole}; \
                 the smaller number was read"
            )
        });
    }
    Ok(model_of(facets))
}

/// The facets of 4 GiB have fewer corners than [`crate::index::MAX_INDEX`].
fn model_of(facets: &[[u8; FACET_BYTES]]) -> Model {
    let triangles: Vec<[[f64; 3]; 3]> =
        facets.par_iter().with_min_len(FACETS_A_THREAD).map(corners).collect();
    let positions = triangles.into_flattened();
    let corner_positions = (0..to_u32(positions.len())).collect();
    Model { positions, corner_positions, ..Model::default() }
}

fn corners(facet: &[u8; FACET_BYTES]) -> [[f64; 3]; 3] {
    // Three floats of normal, nine of corners; two bytes of attribute remain.
    let floats = facet.as_chunks::<4>().0;
    let coordinate = |at: usize| f64::from(f32::from_le_bytes(floats[at]));
    [3, 6, 9].map(|at| [at, at + 1, at + 2].map(coordinate))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file with the count `count` and with `facets` facets, whose corners have the
    /// coordinates 1 to 9 and whose normals are NaN.
    fn file(count: u32, facets: usize) -> Vec<u8> {
        let mut bytes = vec![b'x'; 80];
        bytes.extend(count.to_le_bytes());
        for _ in 0..facets {
            bytes.extend([f32::NAN; 3].iter().flat_map(|float| float.to_le_bytes()));
            bytes.extend((1_u8..10).flat_map(|k| f32::from(k).to_le_bytes()));
            bytes.extend([0xff, 0x7f]);
        }
        bytes
    }

    fn read(bytes: &[u8], report: &mut Report) -> Result<Model, ReadError> {
        read_binary(&Source { name: "test", folder: None, bytes }, report)
    }

    #[test]
    fn every_facet_has_its_own_three_vertices() {
        let mut report = Report::default();
        let model = read(&file(2, 2), &mut report).unwrap();
        let triangle = [[1., 2., 3.], [4., 5., 6.], [7., 8., 9.]];
        assert_eq!(model.positions, [triangle, triangle].concat());
        assert_eq!(model.corner_positions, [0, 1, 2, 3, 4, 5]);
        assert_eq!((model.polygon_count(), model.is_triangles()), (2, true));
        assert!(report.warnings().is_empty(), "normals and attributes are ignored");
    }

    #[test]
    fn the_smaller_of_count_and_size_counts() {
        for (count, facets, cut, read_count, place) in
            [(3, 2, 0, 2, 184), (2, 2, 1, 1, 134), (1, 2, 0, 1, 134), (u32::MAX, 1, 0, 1, 134)]
        {
            let mut bytes = file(count, facets);
            bytes.truncate(bytes.len() - cut);
            let mut report = Report::default();
            let model = read(&bytes, &mut report).unwrap();
            assert_eq!(model.polygon_count(), read_count, "{count} {facets} {cut}");
            let [warning] = report.warnings() else { panic!("{report:?}") };
            assert_eq!(warning.code, WarningCode::Truncated);
            assert_eq!(warning.place, Some(Place::Byte(place)));
        }
    }

    #[test]
    fn padding_is_ignored() {
        let mut report = Report::default();
        let padded = [file(1, 1), b"\0\0\r\n ".to_vec()].concat();
        assert_eq!(read(&padded, &mut report).unwrap().polygon_count(), 1);
        assert!(report.warnings().is_empty(), "{report:?}");
    }

    #[test]
    fn a_file_without_a_complete_facet_is_an_error() {
        use ReadErrorKind::{Empty, Truncated};
        let cut = |count, bytes| file(count, 1).get(..bytes).unwrap().to_vec();
        for (bytes, kind, place) in [
            (file(0, 0), Empty, 80),
            (file(0, 1), Empty, 80),
            (file(1, 0), Truncated, 84),
            (cut(1, 133), Truncated, 133),
            (cut(1, 83), Truncated, 83),
            (Vec::new(), Truncated, 0),
        ] {
            let error = read(&bytes, &mut Report::default()).unwrap_err();
            assert_eq!((error.kind, error.place), (kind, Some(Place::Byte(place))));
        }
    }

    #[test]
    fn a_file_without_triangles_says_so() {
        let what = |bytes: &[u8]| read(bytes, &mut Report::default()).unwrap_err().what;
        assert_eq!(what(&file(0, 0)), "the file has no triangles; export the model again");
        assert!(what(&file(0, 2)).contains("no triangles, though it has room for 2"));
    }

    #[test]
    fn the_size_follows_from_the_count() {
        let fits = |bytes: &[u8]| size_fits(bytes, bytes.len() as u64);
        assert!(fits(&file(2, 2)) && fits(&file(0, 0)));
        assert!(!fits(&file(2, 1)) && !fits(&file(1, 2)));
        assert!(!fits(b"solid"));
    }
}
