//! The edge word: the classes of an edge and its crease angle in 24 bits of every layout, so that
//! thresholds can change while a picture is on the screen.
//!
//! The angle is computed once, in 64 bits, and stored in steps of a forty-fifth of a degree.
//! Comparing whole steps gives the same answer in every layout and on every adapter, even in the
//! many models whose creases lie exactly at a threshold.
//!
//! Rejected: the normals of both faces in each vertex, whose cosine is compared there (paper,
//! section 3.2). Two vertices of an edge, or two adapters, can then disagree.
//!
//! ```text
//!   bit 23      22 ........... 10   9 ........ 0
//!   concave     angle in steps      EdgeFlags
//! ```

use bytemuck::{Pod, Zeroable};

use crate::edge_mesh::edge_flags::EdgeFlags;

/// Steps of the crease angle in a degree.
pub(crate) const STEPS_PER_DEGREE: u32 = 45;

/// The lowest bit of the crease angle. WGSL twin: `CREASE_SHIFT`.
pub const CREASE_SHIFT: u32 = 10;

/// All bits of the crease angle, shifted down. WGSL twin: `CREASE_STEPS`.
pub const CREASE_STEPS: u32 = 0x1fff;

/// The bit of concave edges. WGSL twin: `CONCAVE`.
pub const CONCAVE: u32 = 1 << 23;

/// The classes of an edge and its crease angle, in the lower 24 bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Pod, Zeroable)]
#[repr(transparent)]
pub struct EdgeWord(pub u32);

impl EdgeWord {
    /// The word of an edge whose face normals differ by `angle_rad` (radians), which is 0 if the
    /// edge cannot be a crease.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 8100")]
    pub fn new(flags: EdgeFlags, angle_rad: f64, is_concave: bool) -> Self {
        let steps = (angle_rad.to_degrees() * f64::from(STEPS_PER_DEGREE)).round();
        let steps = steps.clamp(0.0, f64::from(180 * STEPS_PER_DEGREE)) as u32;
        let concave = if is_concave { CONCAVE } else { 0 };
        Self(flags.bits() | steps << CREASE_SHIFT | concave)
    }

    /// The classes of the edge.
    #[must_use]
    pub const fn flags(self) -> EdgeFlags {
        EdgeFlags::from_bits_truncate(self.0)
    }

    /// The angle between the face normals, in steps of 1/45 degree, 0 to 8100.
    #[must_use]
    pub const fn crease_steps(self) -> u32 {
        self.0 >> CREASE_SHIFT & CREASE_STEPS
    }

    /// Whether the edge is concave.
    #[must_use]
    pub const fn is_concave(self) -> bool {
        self.0 & CONCAVE != 0
    }
}

impl From<EdgeFlags> for EdgeWord {
    fn from(flags: EdgeFlags) -> Self {
        Self(flags.bits())
    }
}

/// Converts a threshold from radians to steps of 1/45 degree: 1 to 8101, as 0 means the creases of
/// the mesh.
#[must_use]
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 8101")]
pub fn threshold_steps(angle_rad: f64) -> u32 {
    let steps = (angle_rad.to_degrees() * f64::from(STEPS_PER_DEGREE)).round();
    steps.clamp(1.0, f64::from(180 * STEPS_PER_DEGREE + 1)) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_word_fits_24_bits_and_keeps_the_flags() {
        let word = EdgeWord::new(EdgeFlags::all(), std::f64::consts::PI, true);
        assert_eq!(word.0 >> 24, 0);
        assert_eq!((word.flags(), word.crease_steps()), (EdgeFlags::all(), 8100));
        assert_eq!(threshold_steps(0.0), 1);
        assert_eq!(threshold_steps(30_f64.to_radians()), 1350);
        assert_eq!(threshold_steps(9.0), 8101, "above every angle");
    }
}
