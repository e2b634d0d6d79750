//! The planes of faces: which side of a face the eye is on, and how far two faces turn.
//!
//! A normal is worth as much as the height of its face: rounding of the coordinates tilts it by
//! the rounding over the height. The normal of a needle or a sliver can be tilted by any angle, so
//! on a flat face it would be a false crease and a false contour.
//!
//! Idea: a thin face whose normal is in doubt by more than 11 degrees takes the plane of the face
//! across its longest edge, if the faces around it agree; then it lies in one surface with them. If they disagree, it is a narrow face of its own, such as the rim of a thin
//! plate, and keeps its plane. A face without area has none to keep, and always takes one.
//!
//! Rejected: taking the plane of a neighbor whenever a face is thin, which rounds off the rims of
//! plates that are one unit of the last digit thick.

use glam::DVec3;
use rayon::prelude::*;

use super::components::Sets;
use super::rounding::Rounding;
use crate::edge_mesh::{EdgePart, EdgeTable, FacePlane, corners_of, face_normal, triangle_side};
use crate::index::{NONE, to_u32};

/// A normal that rounding may tilt by more than this angle, in radians, is in doubt.
pub(crate) const DOUBTFUL_TILT_RAD: f32 = 0.2;

/// A thin face is at least this many times as long as it is high.
const THIN: f64 = 8.0;

/// The cosine of the angle up to which the faces around a sliver agree: 30 degrees.
const AGREEING_COSINE: f32 = 0.866;

/// The planes of all faces, and what they are worth.
#[derive(Debug, Default)]
pub(crate) struct Planes {
    pub(crate) planes: Vec<FacePlane>,
    /// The largest angle by which rounding may have tilted each normal, in radians.
    pub(crate) tilts: Vec<f32>,
    /// The faces that need the plane of a neighbor, ascending; most have found one.
    pub(crate) slivers: Vec<u32>,
}

/// Whether a face has a normal, of its own or of a neighbor.
pub(crate) fn has_normal(plane: &FacePlane) -> bool {
    plane.normal != [0.0; 4]
}

impl Planes {
    /// The planes of all faces; slivers have those of their neighbors.
    pub(crate) fn of(
        positions: &[[f32; 3]],
        triangles: &[[u32; 3]],
        table: &EdgeTable,
        rounding: &Rounding,
    ) -> Self {
        let plane = |triangle: &[u32; 3]| {
            let corners = corners_of(positions, *triangle);
            let [x, y, z] = face_normal(corners).as_vec3().to_array();
            let [px, py, pz] = positions[triangle[0] as usize];
            let plane = FacePlane { normal: [x, y, z, 0.0], point: [px, py, pz, 1.0] };
            (plane, tilt(&corners, rounding))
        };
        let (planes, tilts) = triangles.par_iter().with_min_len(1 << 12).map(plane).unzip();
        let mut all = Self { planes, tilts, slivers: Vec::new() };
        all.lend(&Slivers::find(&all, positions, triangles, table));
        all
    }

    /// Gives slivers the planes of their neighbors.
    fn lend(&mut self, slivers: &Slivers) {
        if slivers.faces.is_empty() {
            return;
        }
        self.slivers = slivers.takers(&self.planes);
        let mut needs = vec![false; self.planes.len()];
        for &face in &self.slivers {
            needs[face as usize] = true;
        }
        // Slivers can be adjacent, so planes travel from face to face: first across the longest
        // edges alone, then across the others too.
        let mut pairs: Vec<(u32, u32)> = Vec::new();
        for rank in 0..3 {
            pairs.extend(slivers.pairs(rank).map(|(index, donor)| (donor, slivers.faces[index])));
            pairs.sort_unstable();
            let mut donors: Vec<u32> = pairs.iter().map(|pair| pair.0).collect();
            donors.dedup();
            donors.retain(|&donor| !needs[donor as usize]);
            while let Some(donor) = donors.pop() {
                let first = pairs.partition_point(|pair| pair.0 < donor);
                for &(_, face) in pairs[first..].iter().take_while(|pair| pair.0 == donor) {
                    if std::mem::replace(&mut needs[face as usize], false) {
                        self.planes[face as usize] = self.planes[donor as usize];
                        self.tilts[face as usize] = self.tilts[donor as usize];
                        donors.push(face);
                    }
                }
            }
        }
    }
}

/// The largest angle by which `rounding` may tilt a polygon, in radians: each side can turn the
/// area by its length.
pub(crate) fn tilt(corners: &[DVec3], rounding: &Rounding) -> f32 {
    let (mut around, mut area, mut reach) = (0.0, DVec3::ZERO, DVec3::ZERO);
    let mut previous = corners[corners.len() - 1];
    for &corner in corners {
        around += previous.distance(corner);
        area += (previous - corners[0]).cross(corner - corners[0]);
        reach = reach.max(corner.abs());
        previous = corner;
    }
    // The three coordinates of a corner are rounded apart.
    let moved = 3_f64.sqrt() * rounding.at(reach.max_element());
    #[expect(clippy::cast_possible_truncation, reason = "7 digits are plenty")]
    let angle = (moved * around / area.length()) as f32;
    if angle < std::f32::consts::PI { angle } else { std::f32::consts::PI }
}

/// The thin faces whose normals are in doubt.
struct Slivers {
    /// The faces, ascending.
    faces: Vec<u32>,
    /// The faces across the sides of each of them, from the longest side to the shortest, or
    /// [`NONE`].
    across: Vec<[u32; 3]>,
    /// Whether each of them has no area at all.
    is_flat: Vec<bool>,
}

impl Slivers {
    fn find(
        planes: &Planes,
        positions: &[[f32; 3]],
        triangles: &[[u32; 3]],
        table: &EdgeTable,
    ) -> Self {
        let is_sliver = |face: &u32| {
            let face = *face as usize;
            let in_doubt = planes.tilts[face] > DOUBTFUL_TILT_RAD;
            in_doubt && is_thin(corners_of(positions, triangles[face]))
        };
        let faces: Vec<u32> = (0..to_u32(triangles.len()))
            .into_par_iter()
            .with_min_len(1 << 14)
            .filter(is_sliver)
            .collect();
        let is_flat =
            faces.iter().map(|&face| !has_normal(&planes.planes[face as usize])).collect();
        let mut slivers = Self { across: vec![[NONE; 3]; faces.len()], is_flat, faces };
        slivers.find_across(positions, triangles, table);
        slivers
    }

    /// Finds the face across each side: of several faces, the first that is wound the same way.
    fn find_across(&mut self, positions: &[[f32; 3]], triangles: &[[u32; 3]], table: &EdgeTable) {
        let runs_up = |side: u32| {
            let [start, end] = triangle_side(triangles, side);
            start < end
        };
        if self.faces.is_empty() {
            return;
        }
        let of_part = |(_, part): (usize, &EdgePart)| {
            let has_sliver = |(_, sides): &([u32; 2], &[u32])| {
                sides.iter().any(|&side| self.index(side / 3).is_some())
            };
            let mut found = Vec::new();
            for (_, sides) in part.iter().filter(has_sliver) {
                let [first_up, first_down] =
                    [true, false].map(|up| sides.iter().find(|&&side| runs_up(side) == up));
                for &side in sides {
                    let across = if runs_up(side) { first_down } else { first_up };
                    if let (Some(index), Some(other)) = (self.index(side / 3), across) {
                        found.push((index, side % 3, other / 3));
                    }
                }
            }
            found
        };
        let found: Vec<(usize, u32, u32)> = table.parts().flat_map_iter(of_part).collect();
        let by_side = &mut self.across;
        for (index, side, other) in found {
            by_side[index][side as usize] = other;
        }
        for (across, &face) in by_side.iter_mut().zip(&self.faces) {
            let [a, b, c] = corners_of(positions, triangles[face as usize]);
            let lengths = [b - a, c - b, a - c].map(DVec3::length_squared);
            let mut sides = [0, 1, 2];
            sides.sort_by(|&i: &usize, &j| lengths[j].total_cmp(&lengths[i]));
            *across = sides.map(|side| across[side]);
        }
    }

    fn index(&self, face: u32) -> Option<usize> {
        self.faces.binary_search(&face).ok()
    }

    /// The index of each sliver with the face across its side of a rank, the longest first.
    fn pairs(&self, rank: usize) -> impl Iterator<Item = (usize, u32)> {
        let across = self.across.iter().map(move |across| across[rank]);
        across.enumerate().filter(|&(_, other)| other != NONE)
    }

    /// The slivers that need the plane of a neighbor, ascending.
    ///
    /// Slivers that lie along each other form a strip; a strip lies in one surface if the faces
    /// along it agree.
    fn takers(&self, planes: &[FacePlane]) -> Vec<u32> {
        let strips = Sets::new(self.faces.len());
        let mut neighbors: Vec<(usize, u32)> = Vec::new();
        for (index, other) in self.pairs(0).chain(self.pairs(1)) {
            match self.index(other) {
                Some(beside) => strips.join(to_u32(index), to_u32(beside)),
                None => neighbors.push((index, other)),
            }
        }
        // The first neighbor of each strip, and whether all others agree with it.
        let mut first = vec![None; self.faces.len()];
        let mut agrees = vec![true; self.faces.len()];
        for (index, face) in neighbors {
            let strip = strips.root(to_u32(index)) as usize;
            let normal = planes[face as usize].normal;
            let [x, y, z, _] = *first[strip].get_or_insert(normal);
            let cosine = x * normal[0] + y * normal[1] + z * normal[2];
            agrees[strip] &= cosine >= AGREEING_COSINE;
        }
        let takes = |index: &usize| {
            let strip = strips.root(to_u32(*index)) as usize;
            self.is_flat[*index] || first[strip].is_some() && agrees[strip]
        };
        (0..self.faces.len()).filter(takes).map(|index| self.faces[index]).collect()
    }
}

fn is_thin([a, b, c]: [DVec3; 3]) -> bool {
    let longest = (b - a).length_squared().max((c - b).length_squared());
    let longest = longest.max((a - c).length_squared());
    (b - a).cross(c - a).length() * THIN <= longest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edge_mesh::MeshFrame;
    use crate::model::Model;

    fn planes_of(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Planes {
        let positions_in_file = positions.iter().map(|point| point.map(f64::from)).collect();
        let model = Model { positions: positions_in_file, ..Model::default() };
        let rounding =
            Rounding::of(&model, &MeshFrame::default(), (DVec3::ZERO, DVec3::splat(2.0)));
        let table = EdgeTable::from_triangles(positions.len(), triangles);
        Planes::of(positions, triangles, &table, &rounding)
    }

    /// ```text
    ///   2           (0,3,1) lies flat on the edge 0-1 of (0,1,2)
    ///   | \
    ///   0-3-1
    /// ```
    #[test]
    fn a_sliver_takes_the_plane_across_its_longest_edge() {
        for height in [0.0, 1e-8, -1e-7] {
            let positions = [[0., 0., 0.], [2., 0., 0.], [0., 1., 0.], [1., height, height]];
            let planes = planes_of(&positions, &[[0, 1, 2], [0, 3, 1]]);
            assert_eq!(planes.slivers, [1]);
            assert_eq!(planes.planes[1], planes.planes[0], "{height}");
        }
        let positions = [[0., 0., 0.], [2., 0., 0.], [0., 1., 0.], [1., -1.234_5e-3, 1e-3]];
        let planes = planes_of(&positions, &[[0, 1, 2], [0, 3, 1]]);
        assert!(planes.slivers.is_empty(), "high enough");
    }

    /// A strip as high as the rounding between two faces that are flat, or at a right angle.
    #[test]
    fn a_narrow_face_between_faces_that_disagree_keeps_its_plane() {
        let strip = |far: [f32; 3]| {
            let h = 1e-7;
            let positions =
                [[0., 0., 0.], [2., 0., 0.], [2., h, 0.], [0., h, 0.], [1., -1., 0.], far];
            planes_of(&positions, &[[0, 1, 2], [0, 2, 3], [1, 0, 4], [3, 2, 5]]).slivers
        };
        assert_eq!(strip([1., 1., 0.]), [0, 1]);
        assert!(strip([1., 0., -1.]).is_empty());
    }

    /// Two slivers whose longest edge is the one between them.
    #[test]
    fn slivers_that_have_each_other_across_look_further() {
        let positions = [[0., 0., 0.], [2., 0., 0.], [1., 1e-8, 0.], [1., -1e-8, 0.], [1., 1., 0.]];
        let planes = planes_of(&positions, &[[0, 1, 2], [1, 0, 3], [2, 1, 4]]);
        assert_eq!(planes.slivers, [0, 1]);
        assert_eq!(planes.planes[0], planes.planes[2]);
        assert_eq!(planes.planes[1], planes.planes[2]);
    }

    #[test]
    fn size_does_not_matter() {
        for scale in [1e-15_f32, 1.0, 1e15] {
            let corners = [[0., 0., 0.], [scale, 0., 0.], [0., scale, 0.]];
            assert_eq!(face_normal(corners_of(&corners, [0, 1, 2])), DVec3::Z, "{scale}");
        }
    }
}
