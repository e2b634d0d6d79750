//! Face planes, which decide whether a face looks at the eye.
//!
//! A face without area has no normal. It takes the plane of the face across its longest edge, so
//! that no contour separates the two.

use glam::DVec3;
use rayon::prelude::*;

use crate::edge_mesh::{EdgeTable, FacePlane, corners_of, face_normal};

/// The planes of all faces; a face without area has a normal of zero.
pub(crate) fn face_planes(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Vec<FacePlane> {
    let plane = |triangle: &[u32; 3]| {
        let [x, y, z] = face_normal(corners_of(positions, *triangle)).as_vec3().to_array();
        let [px, py, pz] = positions[triangle[0] as usize];
        FacePlane { normal: [x, y, z, 0.0], point: [px, py, pz, 1.0] }
    };
    triangles.par_iter().with_min_len(1 << 12).map(plane).collect()
}

/// Whether a face has an area, before [`lend_planes`].
pub(crate) fn has_area(plane: &FacePlane) -> bool {
    plane.normal != [0.0; 4]
}

/// Gives the faces without area, `flat`, the planes of their neighbors.
pub(crate) fn lend_planes(
    positions: &[[f32; 3]],
    triangles: &[[u32; 3]],
    flat: &[usize],
    table: &EdgeTable,
    planes: &mut [FacePlane],
) {
    if flat.is_empty() {
        return;
    }
    // Slivers can be adjacent, so planes travel from face to face.
    let mut takers = longest_edge_neighbors(positions, triangles, planes, table);
    takers.sort_unstable_by_key(|&(face, donor)| (donor, face));
    let mut donors: Vec<usize> =
        takers.iter().map(|taker| taker.1).filter(|&donor| has_area(&planes[donor])).collect();
    donors.dedup();
    while let Some(donor) = donors.pop() {
        let first = takers.partition_point(|taker| taker.1 < donor);
        for &(face, _) in takers[first..].iter().take_while(|taker| taker.1 == donor) {
            if !has_area(&planes[face]) {
                planes[face] = planes[donor];
                donors.push(face);
            }
        }
    }
}

/// For each face without area, the face across its longest edge.
fn longest_edge_neighbors(
    positions: &[[f32; 3]],
    triangles: &[[u32; 3]],
    planes: &[FacePlane],
    table: &EdgeTable,
) -> Vec<(usize, usize)> {
    let longest_side = |face: usize| {
        let [a, b, c] = corners_of(positions, triangles[face]);
        let lengths = [b - a, c - b, a - c].map(DVec3::length_squared);
        (0..3).fold(0, |best, side| if lengths[side] > lengths[best] { side } else { best })
    };
    let mut donors = Vec::new();
    for (_, sides) in table.iter() {
        for &side in sides {
            let face = side as usize / 3;
            if has_area(&planes[face]) || longest_side(face) != side as usize % 3 {
                continue;
            }
            let other = sides.iter().map(|&side| side as usize / 3).find(|&other| other != face);
            donors.extend(other.map(|other| (face, other)));
        }
    }
    donors
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ```text
    ///   2           (0,3,1) lies flat on the edge 0-1 of (0,1,2)
    ///   | \
    ///   0-3-1
    /// ```
    #[test]
    fn a_sliver_takes_the_plane_across_its_longest_edge() {
        let positions = [[0., 0., 0.], [2., 0., 0.], [0., 1., 0.], [1., 0., 0.]];
        let triangles = [[0, 1, 2], [0, 3, 1]];
        let mut planes = face_planes(&positions, &triangles);
        assert!(has_area(&planes[0]) && !has_area(&planes[1]));
        let table = EdgeTable::from_triangles(4, &triangles);
        lend_planes(&positions, &triangles, &[1], &table, &mut planes);
        assert_eq!(planes[1], planes[0]);
    }

    #[test]
    fn size_does_not_matter() {
        for scale in [1e-15_f32, 1.0, 1e15] {
            let corners = [[0., 0., 0.], [scale, 0., 0.], [0., scale, 0.]];
            assert_eq!(face_normal(corners_of(&corners, [0, 1, 2])), DVec3::Z, "{scale}");
        }
    }
}
