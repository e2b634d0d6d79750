//! The normal of a face, in 64 bits.

use glam::{DVec3, Vec3};

/// A triangle whose doubled area is below this part of its longest side squared
/// has no area: its height is at the rounding error of 32-bit coordinates.
const ZERO_AREA: f64 = 1e-9;

/// The corner positions of a triangle in 64 bits.
pub(crate) fn corners_of(positions: &[[f32; 3]], triangle: [u32; 3]) -> [DVec3; 3] {
    triangle.map(|vertex| Vec3::from(positions[vertex as usize]).as_dvec3())
}

/// The unit normal of a triangle; zero where it has no area.
pub(crate) fn face_normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    let longest = (b - a).length_squared().max((c - b).length_squared());
    let longest = longest.max((a - c).length_squared());
    let area = (b - a).cross(c - a);
    // Positions are of a size whose fourth power 64 bits hold (`frame`).
    if area.length_squared() > ZERO_AREA * ZERO_AREA * longest * longest {
        area.normalize_or_zero()
    } else {
        DVec3::ZERO
    }
}
