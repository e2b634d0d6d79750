//! Face normals, facing planes and welded vertex normals.
//!
//! Vertex normals weigh each face by its angle at the vertex (Thürmer and
//! Wüthrich 1998), so that they do not depend on how a flat part is cut.
//! Rejected: weighing by area, where one long sliver turns a normal.
//!
//! A face without area has no normal of its own: it takes the plane of the
//! face across its longest edge, so that it is never on its own side of a
//! contour.

use glam::{DVec3, Vec3};

use crate::edge_mesh::FacePlane;
use crate::topology::EdgeTable;

/// A triangle whose doubled area is below this part of its longest side squared
/// has no area: its height is at the rounding error of 32-bit coordinates.
const ZERO_AREA: f64 = 1e-9;

/// The corner positions of a triangle in 64 bits.
pub(crate) fn corners_of(positions: &[[f32; 3]], triangle: [u32; 3]) -> [DVec3; 3] {
    triangle.map(|vertex| Vec3::from(positions[vertex as usize]).as_dvec3())
}

/// Unit normals, `None` for faces without area.
pub(crate) fn face_normals(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Vec<Option<DVec3>> {
    triangles
        .iter()
        .map(|&triangle| {
            let [a, b, c] = corners_of(positions, triangle);
            let longest = [b - a, c - b, a - c].map(DVec3::length).into_iter().fold(0.0, f64::max);
            // Scaled to its size first, so that 1e-30 and 1e30 keep their digits.
            let area = ((b - a) / longest).cross((c - a) / longest);
            (area.length() > ZERO_AREA).then(|| area.normalize_or_zero())
        })
        .collect()
}

/// The plane that decides each face's facing.
pub(crate) fn face_planes(
    positions: &[[f32; 3]],
    triangles: &[[u32; 3]],
    normals: &[Option<DVec3>],
    table: &EdgeTable,
) -> Vec<FacePlane> {
    let mut planes: Vec<FacePlane> = triangles
        .iter()
        .zip(normals)
        .map(|(triangle, normal)| {
            let [x, y, z] = normal.unwrap_or_default().as_vec3().to_array();
            let [px, py, pz] = positions[triangle[0] as usize];
            FacePlane { normal: [x, y, z, 0.0], point: [px, py, pz, 1.0] }
        })
        .collect();
    if normals.iter().all(Option::is_some) {
        return planes;
    }
    // Slivers can lie side by side, so the planes travel on from face to face.
    let mut takers = longest_edge_neighbours(positions, triangles, normals, table);
    takers.sort_unstable_by_key(|&(face, donor)| (donor, face));
    let mut has_plane: Vec<bool> = normals.iter().map(Option::is_some).collect();
    let mut donors: Vec<usize> = (0..triangles.len()).filter(|&face| has_plane[face]).collect();
    while let Some(donor) = donors.pop() {
        let first = takers.partition_point(|taker| taker.1 < donor);
        for &(face, _) in takers[first..].iter().take_while(|taker| taker.1 == donor) {
            if !has_plane[face] {
                planes[face] = planes[donor];
                has_plane[face] = true;
                donors.push(face);
            }
        }
    }
    planes
}

/// For each face without area, the face across its longest edge.
fn longest_edge_neighbours(
    positions: &[[f32; 3]],
    triangles: &[[u32; 3]],
    normals: &[Option<DVec3>],
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
            if normals[face].is_some() || longest_side(face) != side as usize % 3 {
                continue;
            }
            let other = sides.iter().map(|&side| side as usize / 3).find(|&other| other != face);
            donors.extend(other.map(|other| (face, other)));
        }
    }
    donors
}

/// The angle of each corner of `triangle`, in radians.
pub(crate) fn corner_angles(corners: [DVec3; 3]) -> [f64; 3] {
    [0, 1, 2].map(|corner| {
        let to_next = corners[(corner + 1) % 3] - corners[corner];
        let to_previous = corners[(corner + 2) % 3] - corners[corner];
        to_next.cross(to_previous).length().atan2(to_next.dot(to_previous))
    })
}

/// Welded vertex normals by angle weight, of unit length or zero.
pub(crate) fn vertex_normals(
    positions: &[[f32; 3]],
    triangles: &[[u32; 3]],
    normals: &[Option<DVec3>],
) -> Vec<[f32; 3]> {
    let mut sums = vec![DVec3::ZERO; positions.len()];
    for (triangle, normal) in triangles.iter().zip(normals) {
        let Some(normal) = normal else { continue };
        let angles = corner_angles(corners_of(positions, *triangle));
        for (&vertex, angle) in triangle.iter().zip(angles) {
            sums[vertex as usize] += *normal * angle;
        }
    }
    sums.into_iter().map(|sum| sum.normalize_or_zero().as_vec3().to_array()).collect()
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
        let normals = face_normals(&positions, &triangles);
        assert_eq!(normals[1], None);
        let table = EdgeTable::from_triangles(4, &triangles);
        let planes = face_planes(&positions, &triangles, &normals, &table);
        assert_eq!(planes[1], planes[0]);
    }

    #[test]
    fn a_cubes_corner_points_along_its_diagonal_however_it_is_cut() {
        let positions = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.], [1., 1., 0.]];
        // The bottom face is cut in two at the corner, the others are not.
        let triangles = [[0, 4, 1], [0, 2, 4], [0, 3, 2], [0, 1, 3]];
        let normals = face_normals(&positions, &triangles);
        let [x, y, z] = vertex_normals(&positions, &triangles, &normals)[0];
        for component in [x, y, z] {
            assert!((component + 1.0 / 3.0_f32.sqrt()).abs() < 1e-6, "{component}");
        }
    }

    #[test]
    fn size_does_not_matter() {
        for scale in [1e-30_f32, 1.0, 1e30] {
            let positions = [[0., 0., 0.], [scale, 0., 0.], [0., scale, 0.]];
            assert_eq!(face_normals(&positions, &[[0, 1, 2]]), [Some(DVec3::Z)], "{scale}");
        }
    }
}
