//! The edge word: the classes of an edge and its crease angle in 30 bits, so that thresholds can
//! change while a picture is on the screen.
//!
//! The angle is computed once, by the builder, and stored in steps of 1/720 degree, rounded up;
//! thresholds are rounded up as well, and an edge is a crease if it has more steps than the
//! threshold. So an edge exactly at a threshold is none, in every layout and on every adapter, and
//! the builder and a picture agree. What the rounding of the coordinates could have added to an
//! angle is taken off before: the edges of a prism, which all turn by one angle, are all creases or
//! none.
//!
//! The 16-bit layout has room for steps of 1/45 degree. There the threshold counts as the next of
//! these, which changes nothing for thresholds that are one, such as whole degrees.
//!
//! Rejected: the normals of both faces in each vertex, whose cosine is compared there (paper,
//! section 3.2). Two vertices of an edge, or two adapters, can then disagree.
//!
//! ```text
//!   bit 29      28 ........... 12   11 ....... 0
//!   concave     angle in steps      EdgeFlags
//!
//!   bit 23      22 ........... 10   9 ........ 0      at 16 bits
//!   concave     angle in 16 steps   EdgeFlags
//! ```
//!
//! At 16 bits, a diagonal is an edge that is both ridge and valley, which none is, GROOVE has the
//! bit of DIAGONAL, and PAIRED is both BOUNDARY and `NON_MANIFOLD`.

use bytemuck::{Pod, Zeroable};

use crate::edge_mesh::edge_flags::EdgeFlags;

/// Steps of the crease angle in a degree.
const STEPS_PER_DEGREE: u32 = 720;

/// The lowest bit of the crease angle. WGSL twin: `CREASE_SHIFT`.
pub const CREASE_SHIFT: u32 = 12;

/// All bits of the crease angle, shifted down. WGSL twin: `CREASE_STEPS`.
pub const CREASE_STEPS: u32 = 0x1ffff;

/// The bit of concave edges. WGSL twin: `CONCAVE`.
pub const CONCAVE: u32 = 1 << 29;

/// Steps of the crease angle in one of the 16-bit layout. WGSL twin: `STEPS_PER_STEP_16`.
pub const STEPS_PER_STEP_16: u32 = 16;

/// The lowest bit of the crease angle in the 16-bit layout. WGSL twin: `CREASE_SHIFT_16`.
pub const CREASE_SHIFT_16: u32 = 10;

/// The bit of concave edges in the 16-bit layout. WGSL twin: `CONCAVE_16`.
pub const CONCAVE_16: u32 = 1 << 23;

/// The bits of flags in the 16-bit layout.
const FLAGS_16: u32 = (1 << CREASE_SHIFT_16) - 1;

/// A diagonal in the 16-bit layout.
const DIAGONAL_16: EdgeFlags = EdgeFlags::RIDGE.union(EdgeFlags::VALLEY);

/// A pair without a feature in the 16-bit layout.
const PAIRED_16: EdgeFlags = EdgeFlags::BOUNDARY.union(EdgeFlags::NON_MANIFOLD);

/// What the rounding of 64 bits may add to a number of steps.
const ROUNDING_STEPS: f64 = 1e-6;

/// The classes of an edge and its crease angle, in the lower 30 bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Pod, Zeroable)]
#[repr(transparent)]
pub struct EdgeWord(pub u32);

impl EdgeWord {
    /// The word of an edge whose face normals certainly differ by `angle_rad` (radians), which is 0
    /// or less if the edge cannot be a crease.
    #[must_use]
    pub fn new(flags: EdgeFlags, angle_rad: f64, is_concave: bool) -> Self {
        let concave = if is_concave { CONCAVE } else { 0 };
        Self(flags.bits() | steps_above(angle_rad) << CREASE_SHIFT | concave)
    }

    /// The classes of the edge.
    #[must_use]
    pub const fn flags(self) -> EdgeFlags {
        EdgeFlags::from_bits_truncate(self.0)
    }

    /// Adds classes.
    pub(crate) const fn insert(&mut self, flags: EdgeFlags) {
        self.0 |= flags.bits();
    }

    /// Adds or removes classes.
    pub const fn set(&mut self, flags: EdgeFlags, is_set: bool) {
        self.0 &= !flags.bits();
        if is_set {
            self.insert(flags);
        }
    }

    /// The angle between the face normals, in steps of 1/720 degree, 0 to 129600.
    #[must_use]
    pub const fn crease_steps(self) -> u32 {
        self.0 >> CREASE_SHIFT & CREASE_STEPS
    }

    /// Whether the edge is concave.
    #[must_use]
    pub const fn is_concave(self) -> bool {
        self.0 & CONCAVE != 0
    }

    /// The creases that the edge is, given the least steps of ridges and valleys.
    #[must_use]
    pub(crate) const fn creases(self, ridge_steps: u32, valley_steps: u32) -> EdgeFlags {
        if self.is_concave() && self.crease_steps() >= valley_steps {
            EdgeFlags::VALLEY
        } else if !self.is_concave() && self.crease_steps() >= ridge_steps {
            EdgeFlags::RIDGE
        } else {
            EdgeFlags::empty()
        }
    }

    /// The word in the 24 bits of the 16-bit layout.
    #[must_use]
    pub const fn to_24_bits(self) -> u32 {
        let concave = if self.is_concave() { CONCAVE_16 } else { 0 };
        let steps = self.crease_steps().div_ceil(STEPS_PER_STEP_16);
        let flags = self.flags();
        let mut short = EdgeFlags::from_bits_truncate(flags.bits() & FLAGS_16);
        short = short.difference(EdgeFlags::DIAGONAL);
        if flags.contains(EdgeFlags::DIAGONAL) {
            short = short.union(DIAGONAL_16);
        }
        if flags.contains(EdgeFlags::GROOVE) {
            short = short.union(EdgeFlags::DIAGONAL);
        }
        if flags.contains(EdgeFlags::PAIRED) {
            short = short.union(PAIRED_16);
        }
        short.bits() | steps << CREASE_SHIFT_16 | concave
    }

    /// The word of 24 bits of the 16-bit layout, with the least angle that they can stand for.
    /// WGSL twin: `word_of_24_bits`.
    #[must_use]
    pub const fn from_24_bits(bits: u32) -> Self {
        let steps = (bits & (CONCAVE_16 - 1)) >> CREASE_SHIFT_16;
        let least = (steps * STEPS_PER_STEP_16).saturating_sub(STEPS_PER_STEP_16 - 1);
        let concave = if bits & CONCAVE_16 == 0 { 0 } else { CONCAVE };
        let short = EdgeFlags::from_bits_truncate(bits & FLAGS_16);
        let mut flags = short.difference(EdgeFlags::DIAGONAL);
        if short.contains(DIAGONAL_16) {
            flags = flags.difference(DIAGONAL_16).union(EdgeFlags::DIAGONAL);
        }
        if short.contains(PAIRED_16) {
            flags = flags.difference(PAIRED_16).union(EdgeFlags::PAIRED);
        }
        if short.contains(EdgeFlags::DIAGONAL) {
            flags = flags.union(EdgeFlags::GROOVE);
        }
        Self(flags.bits() | least << CREASE_SHIFT | concave)
    }
}

impl From<EdgeFlags> for EdgeWord {
    fn from(flags: EdgeFlags) -> Self {
        Self(flags.bits())
    }
}

/// The least steps of a crease with a threshold in radians: 1 to 129601, as 0 means the creases of
/// the mesh.
#[must_use]
pub fn threshold_steps(angle_rad: f64) -> u32 {
    steps_above(angle_rad) + 1
}

/// An angle in whole steps, rounded up, from 0 to 180 degrees.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 129600")]
fn steps_above(angle_rad: f64) -> u32 {
    let steps = angle_rad.to_degrees() * f64::from(STEPS_PER_DEGREE);
    (steps - ROUNDING_STEPS).ceil().clamp(0.0, f64::from(180 * STEPS_PER_DEGREE)) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_word_fits_30_bits_and_keeps_the_flags() {
        let word = EdgeWord::new(EdgeFlags::all(), std::f64::consts::PI, true);
        assert_eq!(word.0 >> 30, 0);
        assert_eq!((word.flags(), word.crease_steps()), (EdgeFlags::all(), 180 * 720));
        assert_eq!(word.to_24_bits() >> 24, 0);
        assert_eq!(threshold_steps(-1.0), 1);
        assert_eq!(threshold_steps(30_f64.to_radians()), 30 * 720 + 1);
        assert_eq!(threshold_steps(9.0), 180 * 720 + 1, "above every angle");
    }

    #[test]
    fn flags_survive_16_bits() {
        let creases = EdgeFlags::RIDGE | EdgeFlags::VALLEY;
        for bits in 0..=EdgeFlags::all().bits() {
            let flags = EdgeFlags::from_bits_truncate(bits);
            let is_diagonal = flags.contains(EdgeFlags::DIAGONAL);
            let ends = EdgeFlags::BOUNDARY | EdgeFlags::NON_MANIFOLD;
            let is_paired = flags.contains(EdgeFlags::PAIRED);
            if flags.contains(creases) || is_diagonal && flags.intersects(creases) {
                continue; // No edge is both ridge and valley, and no diagonal is either.
            }
            if flags.contains(ends) || is_paired && flags.intersects(ends) {
                continue; // No edge is two of boundary, non-manifold and paired.
            }
            let word = EdgeWord::new(flags, 0.5, true);
            let back = EdgeWord::from_24_bits(word.to_24_bits());
            assert_eq!((back.flags(), back.is_concave()), (flags, true), "{flags:?}");
        }
    }

    #[test]
    fn flags_change_without_the_angle() {
        let mut word = EdgeWord::new(EdgeFlags::RIDGE, 0.5, true);
        let steps = word.crease_steps();
        word.set(EdgeFlags::MARKED, true);
        word.set(EdgeFlags::RIDGE, false);
        assert_eq!((word.flags(), word.crease_steps()), (EdgeFlags::MARKED, steps));
        assert!(word.is_concave());
    }

    /// Whole steps of the 16-bit layout give the same creases as all others.
    #[test]
    fn an_angle_at_its_own_threshold_is_no_crease_at_any_precision() {
        for sides in 3_u32..400 {
            let degrees = 360.0 / f64::from(sides);
            let word = EdgeWord::new(EdgeFlags::empty(), degrees.to_radians(), false);
            let short = EdgeWord::from_24_bits(word.to_24_bits());
            for (word, precision) in [(word, 0.002), (short, 0.024)] {
                let is_ridge = |threshold: f64| {
                    let steps = threshold_steps(threshold.to_radians());
                    word.creases(steps, steps) == EdgeFlags::RIDGE
                };
                assert!(!is_ridge(degrees), "{sides}");
                assert!(!is_ridge(degrees + 1e-9) && !is_ridge(degrees + 0.3), "{sides}");
                assert!(is_ridge(degrees - precision), "{sides}");
            }
            for whole in 1..180 {
                let steps = threshold_steps(f64::from(whole).to_radians());
                assert_eq!(word.creases(steps, steps), short.creases(steps, steps), "{sides}");
            }
        }
    }
}
