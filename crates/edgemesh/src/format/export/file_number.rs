//! Numbers in the units of the model file.

use std::fmt;

use glam::Vec3;
use serde::Serialize;

use crate::edge_mesh::EdgeMesh;

/// A coordinate or length in the units of the model file: 32 bits, or 64 bits if the
/// mesh has a frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(untagged)]
pub(super) enum FileNumber {
    Single(f32),
    Double(f64),
}

impl fmt::Display for FileNumber {
    /// The shortest text that is read back as the same number.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = match *self {
            Self::Single(number) => f64::from(number).abs(),
            Self::Double(number) => number.abs(),
        };
        let is_plain = size == 0.0 || (1e-5..1e15).contains(&size);
        match (self, is_plain) {
            (Self::Single(number), true) => write!(formatter, "{number}"),
            (Self::Single(number), false) => write!(formatter, "{number:e}"),
            (Self::Double(number), true) => write!(formatter, "{number}"),
            (Self::Double(number), false) => write!(formatter, "{number:e}"),
        }
    }
}

/// A position of `mesh` in the coordinates of its model file.
pub(super) fn in_file(mesh: &EdgeMesh, position: [f32; 3]) -> [FileNumber; 3] {
    if mesh.frame.is_identity() {
        return position.map(FileNumber::Single);
    }
    mesh.frame.to_file(Vec3::from(position).as_dvec3()).to_array().map(FileNumber::Double)
}

/// A length of `mesh` in the units of its model file.
pub(super) fn length_in_file(mesh: &EdgeMesh, length: f32) -> FileNumber {
    if mesh.frame.is_identity() {
        return FileNumber::Single(length);
    }
    FileNumber::Double(f64::from(length) / mesh.frame.scale)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_as_short_as_possible() {
        let text = |number: f32| FileNumber::Single(number).to_string();
        assert_eq!([0.0, -0.0, 1.0, -0.1, 1e-7].map(text), ["0", "-0", "1", "-0.1", "1e-7"]);
        assert_eq!(text(f32::MAX), "3.4028235e38");
        assert_eq!(FileNumber::Double(0.1 + 0.2).to_string(), "0.30000000000000004");
        assert_eq!(FileNumber::Double(-4e-40).to_string(), "-4e-40");
    }
}
