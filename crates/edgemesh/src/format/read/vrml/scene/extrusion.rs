//! `Extrusion` (VRML 97 6.18): a cross section swept along a spine.
//!
//! Each point of the spine has axes: y along the spine, z toward the inside of the bend,
//! x across. A point (x, z) of the cross section is scaled, rotated by the orientation,
//! and put into these axes.
//!
//! ```text
//!        y  next                     cross section, seen from above,
//!        | /                         counterclockwise:   2---1    faces a b c d
//!  z <---o         spine                                 |   |    between two rings
//!       /                                                3---0    as in `solids`
//!    previous
//! ```
//!
//! At a straight point the bend is that of the previous point, or of the first bend. The
//! axes of a spine without bends are the shortest rotation from +y. A closed spine has
//! no caps, because they would be inside.

use glam::{DMat3, DQuat, DVec2, DVec3};

use super::solids::Surface;
use super::transforms::rotation;
use crate::format::read::vrml::parse::NodeRef;
use crate::model::Smoothing;

/// An angle with a smaller sine is not a bend.
const STRAIGHT: f64 = 1e-9;

/// The fields of a node, with the defaults of the specification.
#[derive(Debug)]
pub(super) struct Extrusion {
    section: Vec<DVec2>,
    is_section_closed: bool,
    spine: Vec<DVec3>,
    scales: Vec<[f64; 2]>,
    rotations: Vec<[f64; 4]>,
    begin_cap: bool,
    end_cap: bool,
    smoothing: Smoothing,
}

impl Extrusion {
    /// Reads a node.
    pub(super) fn of(node: NodeRef, smoothing: Smoothing) -> Self {
        const SQUARE: [[f64; 2]; 5] = [[1., 1.], [1., -1.], [-1., -1.], [-1., 1.], [1., 1.]];
        let section =
            node.field("crossSection").map_or(SQUARE.as_slice(), |field| field.numbers().chunks());
        let spine = node
            .field("spine")
            .map_or([[0.; 3], [0., 1., 0.]].as_slice(), |field| field.numbers().chunks());
        let mut section: Vec<DVec2> = section.iter().copied().map(DVec2::from).collect();
        let is_section_closed = section.len() > 2 && section.first() == section.last();
        if is_section_closed {
            section.pop();
        }
        Self {
            section,
            is_section_closed,
            spine: spine.iter().copied().map(DVec3::from).collect(),
            scales: node.numbers("scale").chunks().to_vec(),
            rotations: node.numbers("orientation").chunks().to_vec(),
            begin_cap: node.flag("beginCap", true),
            end_cap: node.flag("endCap", true),
            smoothing,
        }
    }

    /// The approximate number of points and corners of the mesh.
    pub(super) fn element_count(&self) -> usize {
        self.section.len().saturating_mul(self.spine.len()).saturating_mul(8)
    }

    /// The mesh; empty without a spine or cross section.
    pub(super) fn surface(&self) -> Surface {
        let mut surface = Surface::new(self.smoothing);
        if self.spine.len() < 2 || self.section.len() < 2 {
            return surface;
        }
        let rings: Vec<Vec<usize>> = axes_along(&self.spine)
            .into_iter()
            .enumerate()
            .map(|(at, axes)| self.ring(at, axes, &mut surface))
            .collect();
        for pair in rings.windows(2) {
            self.band(&pair[0], &pair[1], &mut surface);
        }
        let has_caps = !is_closed(&self.spine) && self.section.len() > 2;
        if let Some(first) = rings.first().filter(|_| has_caps && self.begin_cap) {
            surface.face(first.iter().rev().copied());
        }
        if let Some(last) = rings.last().filter(|_| has_caps && self.end_cap) {
            surface.face(last.iter().copied());
        }
        surface
    }

    /// Adds the cross section at a point of the spine.
    fn ring(&self, at: usize, axes: DMat3, surface: &mut Surface) -> Vec<usize> {
        let scale = value_at(&self.scales, at).unwrap_or([1.0; 2]);
        let turn = value_at(&self.rotations, at).map_or(DQuat::IDENTITY, rotation);
        let add = |&point: &DVec2| {
            let [x, z] = (point * DVec2::from(scale)).to_array();
            let point = self.spine[at] + axes * (turn * DVec3::new(x, 0.0, z));
            surface.point(point.to_array())
        };
        self.section.iter().map(add).collect()
    }

    /// Adds quads between two rings.
    fn band(&self, lower: &[usize], upper: &[usize], surface: &mut Surface) {
        let count = lower.len();
        let sides = if self.is_section_closed { count } else { count - 1 };
        for side in 0..sides {
            let next = (side + 1) % count;
            surface.face([lower[side], lower[next], upper[next], upper[side]]);
        }
    }
}

/// The value for a point of the spine; a shorter list is continued with its last value.
fn value_at<T: Copy>(values: &[T], at: usize) -> Option<T> {
    values.get(at).or(values.last()).copied()
}

fn is_closed(spine: &[DVec3]) -> bool {
    spine.len() > 2 && spine.first() == spine.last()
}

/// The axes at each point of the spine, as columns.
fn axes_along(spine: &[DVec3]) -> Vec<DMat3> {
    let bends = bends(spine);
    let Some(first_bend) = bends.iter().flatten().next().copied() else {
        return vec![straight_axes(spine); spine.len()];
    };
    let mut z = first_bend;
    let mut y = DVec3::Y;
    let axes = |(at, bend): (usize, &Option<DVec3>)| {
        if let Some(bend) = *bend {
            // In the middle of an S the axes must not flip.
            z = if bend.dot(z) < 0.0 { -bend } else { bend };
        }
        y = tangent(spine, at).unwrap_or(y);
        let x = y.cross(z).normalize_or_zero();
        DMat3::from_cols(x, y, z)
    };
    bends.iter().enumerate().map(axes).collect()
}

/// The axes of a spine without bends.
fn straight_axes(spine: &[DVec3]) -> DMat3 {
    let along = spine.iter().map(|&point| point - spine[0]).find_map(DVec3::try_normalize);
    match along {
        // Half a turn has no shortest rotation; this one keeps x.
        Some(along) if along.dot(DVec3::Y) < STRAIGHT - 1.0 => {
            DMat3::from_diagonal(DVec3::new(1.0, -1.0, -1.0))
        }
        Some(along) => DMat3::from_quat(DQuat::from_rotation_arc(DVec3::Y, along)),
        None => DMat3::IDENTITY,
    }
}

/// The points before and after one of the spine; a closed spine wraps around.
fn neighbors(spine: &[DVec3], at: usize) -> [Option<DVec3>; 2] {
    let last = spine.len() - 1;
    if is_closed(spine) && (at == 0 || at == last) {
        return [Some(spine[last - 1]), Some(spine[1])];
    }
    [at.checked_sub(1).map(|before| spine[before]), spine.get(at + 1).copied()]
}

/// The direction of the spine at a point; `None` if its neighbors coincide.
fn tangent(spine: &[DVec3], at: usize) -> Option<DVec3> {
    let [before, after] = neighbors(spine, at);
    (after.unwrap_or(spine[at]) - before.unwrap_or(spine[at])).try_normalize()
}

/// The normal of the bend at each point; `None` at a straight point and at the ends of an
/// open spine.
fn bends(spine: &[DVec3]) -> Vec<Option<DVec3>> {
    let bend = |at: usize| {
        let [Some(before), Some(after)] = neighbors(spine, at) else { return None };
        let after = (after - spine[at]).try_normalize()?;
        let before = (before - spine[at]).try_normalize()?;
        let bend = after.cross(before);
        (bend.length() > STRAIGHT).then(|| bend.normalize_or_zero())
    };
    (0..spine.len()).map(bend).collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2};

    use super::*;
    use crate::format::read::vrml::tests::{faces_of, sound};

    fn extruded(fields: &str) -> crate::model::Model {
        sound(&format!("Shape {{ geometry Extrusion {{ {fields} }} }}"))
    }

    fn rounded(points: &[[f64; 3]]) -> Vec<[f64; 3]> {
        points.iter().map(|point| point.map(|part| (part * 1e6).round() / 1e6 + 0.0)).collect()
    }

    /// Six times the enclosed volume; positive if the faces face outward.
    fn volume(model: &crate::model::Model) -> f64 {
        let at = |index: u32| DVec3::from(model.positions[index as usize]);
        let cone = |face: &[u32]| -> f64 {
            let fan = face[1..].windows(2);
            fan.map(|side| at(face[0]).dot(at(side[0]).cross(at(side[1])))).sum()
        };
        faces_of(model).iter().map(|face| cone(face)).sum()
    }

    #[test]
    fn the_defaults_make_a_box_of_quads() {
        let model = extruded("");
        assert_eq!((model.positions.len(), model.polygon_count()), (8, 6));
        assert_eq!(model.positions[..2], [[1., 0., 1.], [1., 0., -1.]]);
        assert!((volume(&model) - 24.0).abs() < 1e-9, "2 x 2 x 1, outward");
        assert!((volume(&extruded("ccw FALSE")) + 24.0).abs() < 1e-9);
    }

    #[test]
    fn caps_and_sides_follow_the_cross_section() {
        assert_eq!(extruded("beginCap FALSE endCap FALSE").polygon_count(), 4);
        assert_eq!(extruded("endCap FALSE").polygon_count(), 5);
        let open = extruded("crossSection [ 1 0, 0 -1, -1 0 ]");
        assert_eq!(faces_of(&open).iter().map(Vec::len).collect::<Vec<_>>(), [4, 4, 3, 3]);
        assert_eq!(extruded("crossSection [ 1 0, -1 0 ]").polygon_count(), 1, "a sheet");
    }

    #[test]
    fn cross_sections_are_scaled_rotated_and_put_across_the_spine() {
        let fields = format!(
            "crossSection [ 1 0, 0 -1, -1 0, 1 0 ] spine [ 0 0 0, 5 0 0 ] scale [ 1 1, 2 3 ]
             orientation [ 0 1 0 0, 0 1 0 {FRAC_PI_2} ]"
        );
        // +y goes to +x by a quarter turn about -z, so x of the section goes to -y.
        let expected =
            [[0., -1., 0.], [0., 0., -1.], [0., 1., 0.], [5., 0., -2.], [5., 3., 0.], [5., 0., 2.]];
        assert_eq!(rounded(&extruded(&fields).positions), expected);
        let down = extruded("spine [ 0 0 0, 0 -1 0 ]");
        assert!((volume(&down) - 24.0).abs() < 1e-9);
    }

    #[test]
    fn bends_lie_on_the_bisector_and_an_s_does_not_flip() {
        let line = "crossSection [ -1 0, 1 0 ] spine";
        let bend = extruded(&format!("{line} [ 0 0 0, 0 2 0, 2 2 0 ]"));
        // As wide as the straight parts, at half a right angle.
        let expected =
            [[FRAC_1_SQRT_2, 2.0 - FRAC_1_SQRT_2, 0.0], [-FRAC_1_SQRT_2, 2.0 + FRAC_1_SQRT_2, 0.0]];
        assert_eq!(rounded(&bend.positions[2..4]), rounded(&expected));
        let s =
            axes_along(&[[0., 0., 0.], [0., 1., 0.], [1., 1., 0.], [1., 2., 0.]].map(DVec3::from));
        assert!(s.iter().all(|axes| axes.z_axis == s[0].z_axis), "{s:?}");
    }

    #[test]
    fn a_closed_spine_has_no_caps() {
        let ring = extruded("spine [ 4 0 0, 0 0 -4, -4 0 0, 0 0 4, 4 0 0 ]");
        assert_eq!(ring.polygon_count(), 16);
        assert_eq!(ring.positions[..4], ring.positions[16..]);
        assert!(volume(&ring) > 0.0);
    }

    #[test]
    fn spines_with_coincident_points_stay_finite() {
        let model = extruded("spine [ 0 0 0, 0 0 0, 0 1 0, 0 1 0, 1 1 0 ]");
        assert!(model.positions.iter().flatten().all(|part| part.is_finite()));
        let still = extruded("spine [ 0 0 0, 0 0 0 ]");
        assert_eq!(still.positions[..4], still.positions[4..]);
    }
}
