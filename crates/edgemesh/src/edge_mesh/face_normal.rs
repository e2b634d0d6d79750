//! Normals of faces, in 64 bits.

use glam::{DVec3, Vec3};

/// A triangle has no area if its doubled area is below this fraction of its longest side squared:
/// its height is then within the rounding of 32-bit coordinates.
const ZERO_AREA: f64 = 1e-9;

/// The positions of the corners of a triangle.
pub(crate) fn corners_of(positions: &[[f32; 3]], triangle: [u32; 3]) -> [DVec3; 3] {
    triangle.map(|vertex| Vec3::from(positions[vertex as usize]).as_dvec3())
}

/// The unit normal of a triangle, or zero if it has no area.
pub(crate) fn face_normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    let longest = (b - a).length_squared().max((c - b).length_squared());
    let longest = longest.max((a - c).length_squared());
    let area = (b - a).cross(c - a);
    // The mesh frame keeps positions small enough for their fourth power.
    if area.length_squared() > ZERO_AREA * ZERO_AREA * longest * longest {
        area.normalize_or_zero()
    } else {
        DVec3::ZERO
    }
}
