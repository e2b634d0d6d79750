//! Edges between regions (NPRView thesis, section 3.3.3).

use super::{CROSS, Image, Texel};

/// Whether a neighbor is in another region.
#[must_use]
pub fn differ<T: Copy + Sync + PartialEq>(ids: &Image<T>, at: Texel) -> bool {
    ids.around(at, CROSS).into_iter().any(|other| other != ids.at(at))
}
