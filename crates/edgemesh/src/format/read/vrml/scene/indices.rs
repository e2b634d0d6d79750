//! Lists of point indices, in which -1 ends a face or line.

use crate::format::read::error::{ReadError, ReadErrorKind};
use crate::format::read::vrml::parse::{NodeRef, Numbers};

/// Whether an index is -1, which ends a face or line.
pub(super) fn is_end(value: f64) -> bool {
    value.to_bits() == (-1.0_f64).to_bits()
}

/// The index at `place` in `indices`, which must be one of `count` points.
///
/// # Errors
/// [`ReadErrorKind::Index`] if it is not, with its line.
pub(super) fn point_index(
    node: NodeRef,
    indices: &Numbers,
    place: usize,
    count: usize,
) -> Result<usize, ReadError> {
    match indices.index(place) {
        Some(index) if index < count => Ok(index),
        _ => {
            let found = indices.values.get(place).copied().unwrap_or_default();
            let kind = node.kind();
            let what = format!("{kind} names point {found} (counted from 0) of {count}");
            Err(node.document.origin.error(ReadErrorKind::Index, indices.line_of(place), what))
        }
    }
}
