//! Box, sphere, cone and cylinder as closed meshes (VRML 97 6.7, 6.11, 6.14 and
//! 6.43; VRML 1.0 `Cube`, `Sphere`, `Cone`, `Cylinder`).
//!
//! Round solids have 24 sides, so that the angle between neighbors is 15 degrees, well
//! below a crease. Rings are counterclockwise, seen from above:
//!
//! ```text
//!          -z                     ring k + 1   d---c
//!      2  1  0 = first point                   |   |     faces a b c d,
//!        (   ) +x                              |   |     seen from outside
//!      ...                        ring k       a---b
//! ```

use std::f32::consts;
use std::f64::consts::{PI, TAU};

use crate::model::Smoothing;

/// Sides around a round solid.
const SIDES: usize = 24;

/// Bands of a sphere, from pole to pole.
const BANDS: usize = 12;

/// The smoothing of solids with a round side and flat ends: smooth around the side and
/// sharp at the ends, except for flat cones.
const ROUND: Smoothing = Smoothing::Angle(consts::FRAC_PI_6);

/// A mesh, in the lists of a face set.
#[derive(Debug, Default)]
pub(super) struct Surface {
    /// The positions, three numbers each.
    pub(super) points: Vec<f64>,
    /// The corner indices, -1 after each face.
    pub(super) indices: Vec<f64>,
    /// Which edges are shaded smoothly.
    pub(super) smoothing: Smoothing,
}

impl Surface {
    /// An empty mesh.
    pub(super) fn new(smoothing: Smoothing) -> Self {
        Self { smoothing, ..Self::default() }
    }

    /// Adds a point; returns its index.
    pub(super) fn point(&mut self, point: [f64; 3]) -> usize {
        self.points.extend(point);
        self.points.len() / 3 - 1
    }

    /// Adds a face.
    #[expect(clippy::cast_precision_loss, reason = "far fewer points than 2^53")]
    pub(super) fn face(&mut self, corners: impl IntoIterator<Item = usize>) {
        self.indices.extend(corners.into_iter().map(|corner| corner as f64));
        self.indices.push(-1.0);
    }

    /// Adds a ring of points around the y axis.
    fn ring(&mut self, radius: f64, height: f64) -> Vec<usize> {
        #[expect(clippy::cast_precision_loss, reason = "a small count")]
        let angle = |side: usize| TAU * side as f64 / SIDES as f64;
        let point = |side| [radius * angle(side).cos(), height, -radius * angle(side).sin()];
        (0..SIDES).map(|side| self.point(point(side))).collect()
    }

    /// Adds quads from one closed ring to the one above it.
    fn band(&mut self, lower: &[usize], upper: &[usize]) {
        for side in 0..lower.len() {
            let next = (side + 1) % lower.len();
            self.face([lower[side], lower[next], upper[next], upper[side]]);
        }
    }

    /// Adds triangles from a closed ring up to a point.
    fn roof(&mut self, ring: &[usize], top: usize) {
        for side in 0..ring.len() {
            self.face([ring[side], ring[(side + 1) % ring.len()], top]);
        }
    }

    /// Adds a face that faces down.
    fn floor(&mut self, ring: &[usize]) {
        self.face(ring.iter().rev().copied());
    }
}

/// A box with its center at the origin.
pub(super) fn cuboid(size: [f64; 3]) -> Surface {
    /// Corner bits: x 1, y 2, z 4; set where the coordinate is positive.
    const FACES: [[usize; 4]; 6] =
        [[4, 5, 7, 6], [1, 0, 2, 3], [0, 4, 6, 2], [5, 1, 3, 7], [6, 7, 3, 2], [0, 1, 5, 4]];
    let mut surface = Surface::new(Smoothing::Angle(0.0));
    for corner in 0..8 {
        let axis = |axis: usize| if corner & (1 << axis) == 0 { -0.5 } else { 0.5 } * size[axis];
        surface.point([axis(0), axis(1), axis(2)]);
    }
    FACES.into_iter().for_each(|face| surface.face(face));
    surface
}

/// A sphere with its center at the origin and its poles on the y axis.
pub(super) fn sphere(radius: f64) -> Surface {
    let mut surface = Surface::new(Smoothing::Angle(consts::PI));
    let bottom = surface.point([0.0, -radius, 0.0]);
    #[expect(clippy::cast_precision_loss, reason = "a small count")]
    let rings: Vec<Vec<usize>> = (1..BANDS)
        .map(|band| PI * band as f64 / BANDS as f64)
        .map(|angle| surface.ring(radius * angle.sin(), -radius * angle.cos()))
        .collect();
    let top = surface.point([0.0, radius, 0.0]);
    for side in 0..SIDES {
        surface.face([rings[0][(side + 1) % SIDES], rings[0][side], bottom]);
    }
    for pair in rings.windows(2) {
        surface.band(&pair[0], &pair[1]);
    }
    surface.roof(&rings[BANDS - 2], top);
    surface
}

/// The parts of a cone or cylinder that are drawn.
#[derive(Debug, Clone, Copy)]
pub(super) struct SolidParts {
    /// The round side.
    pub(super) side: bool,
    /// The flat face below.
    pub(super) bottom: bool,
    /// The flat face above, of a cylinder.
    pub(super) top: bool,
}

/// A cone around the y axis, with the origin at half its height.
pub(super) fn cone(radius: f64, height: f64, parts: SolidParts) -> Surface {
    let mut surface = Surface::new(ROUND);
    let ring = surface.ring(radius, -0.5 * height);
    if parts.side {
        let top = surface.point([0.0, 0.5 * height, 0.0]);
        surface.roof(&ring, top);
    }
    if parts.bottom {
        surface.floor(&ring);
    }
    surface
}

/// A cylinder around the y axis, with the origin at half its height.
pub(super) fn cylinder(radius: f64, height: f64, parts: SolidParts) -> Surface {
    let mut surface = Surface::new(ROUND);
    let lower = surface.ring(radius, -0.5 * height);
    let upper = surface.ring(radius, 0.5 * height);
    if parts.side {
        surface.band(&lower, &upper);
    }
    if parts.bottom {
        surface.floor(&lower);
    }
    if parts.top {
        surface.face(upper);
    }
    surface
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use glam::DVec3;

    use super::*;
    use crate::format::read::vrml::parse::whole;

    const ALL: SolidParts = SolidParts { side: true, bottom: true, top: true };

    fn faces(surface: &Surface) -> Vec<Vec<usize>> {
        let lists = surface.indices.split(|&index| index < 0.0).filter(|face| !face.is_empty());
        lists.map(|face| face.iter().map(|&index| whole(index).unwrap()).collect()).collect()
    }

    /// Whether every edge is used once in each direction, and every face faces away from
    /// the origin.
    fn is_closed_and_outward(surface: &Surface) -> bool {
        let mut sides = HashSet::new();
        let mut is_outward = true;
        for face in faces(surface) {
            let next = face.iter().cycle().skip(1);
            assert!(face.iter().zip(next).all(|(&a, &b)| sides.insert((a, b))), "{face:?}");
            let at = |corner: usize| DVec3::from_slice(&surface.points[3 * face[corner]..][..3]);
            let normal = (at(1) - at(0)).cross(at(2) - at(0));
            is_outward &= normal.dot(at(0)) > 0.0;
        }
        is_outward && sides.iter().all(|&(a, b)| sides.contains(&(b, a)))
    }

    #[test]
    fn solids_are_closed_and_face_outward() {
        let solids = [cuboid([1., 2., 3.]), sphere(2.0), cone(1., 2., ALL), cylinder(1., 2., ALL)];
        let counts = solids.map(|solid| {
            assert!(is_closed_and_outward(&solid), "{solid:?}");
            (solid.points.len() / 3, faces(&solid).len())
        });
        assert_eq!(counts, [(8, 6), (266, 288), (25, 25), (48, 26)]);
    }

    #[test]
    fn parts_can_be_left_out() {
        let none = SolidParts { side: false, bottom: false, top: false };
        let counts = |surface: Surface| {
            faces(&surface).iter().map(Vec::len).fold([0; 25], |mut counts, length| {
                counts[length] += 1;
                counts
            })
        };
        let top = counts(cylinder(1.0, 1.0, SolidParts { top: true, ..none }));
        assert_eq!((top[24], top[4]), (1, 0));
        let side = counts(cylinder(1.0, 1.0, SolidParts { side: true, ..none }));
        assert_eq!((side[24], side[4]), (0, 24));
        let bottom = counts(cone(1.0, 1.0, SolidParts { bottom: true, ..none }));
        assert_eq!((bottom[24], bottom[3]), (1, 0));
        assert!(cone(1.0, 1.0, none).indices.is_empty());
    }

    #[test]
    fn a_cube_has_its_size() {
        let cube = cuboid([2.0, 4.0, 6.0]);
        assert_eq!(cube.points[..6], [-1.0, -2.0, -3.0, 1.0, -2.0, -3.0]);
    }
}
