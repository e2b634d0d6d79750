//! What every layout carries of an edge in 24 bits: its classes, and the angle
//! of its crease, so that thresholds can change while a picture is on the screen.
//!
//! The angle is worked out once, in 64 bits, and kept in steps of a forty-fifth
//! of a degree. Comparing whole steps gives the same answer in every layout and
//! on every adapter, also for the many models whose creases are all alike and
//! exactly at a threshold.
//!
//! Rejected: the paper's own way (section 3.2), the normals of both faces in
//! every vertex of every edge and the cosine compared there; two vertices of one
//! edge can then disagree, and so can two adapters.
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

/// Set where the crease is a valley. WGSL twin: `CONCAVE`.
pub const CONCAVE: u32 = 1 << 23;

/// The classes of an edge and the angle of its crease.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Pod, Zeroable)]
#[repr(transparent)]
pub struct EdgeWord(pub u32);

impl EdgeWord {
    /// The word of an edge whose face normals differ by `angle_rad`; 0 where it
    /// can be no crease.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 8100")]
    pub fn new(flags: EdgeFlags, angle_rad: f64, is_concave: bool) -> Self {
        let steps = (angle_rad.to_degrees() * f64::from(STEPS_PER_DEGREE)).round();
        let steps = steps.clamp(0.0, f64::from(180 * STEPS_PER_DEGREE)) as u32;
        let concave = if is_concave { CONCAVE } else { 0 };
        Self(flags.bits() | steps << CREASE_SHIFT | concave)
    }

    /// The classes.
    #[must_use]
    pub const fn flags(self) -> EdgeFlags {
        EdgeFlags::from_bits_truncate(self.0)
    }

    /// The angle between the face normals, in steps.
    #[must_use]
    pub const fn crease_steps(self) -> u32 {
        self.0 >> CREASE_SHIFT & CREASE_STEPS
    }

    /// Whether the crease is a valley.
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

/// A threshold in steps; at least one, since 0 stands for "as built".
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
        assert_eq!(threshold_steps(9.0), 8101, "nothing reaches it");
    }
}
