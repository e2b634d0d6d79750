//! Cuts polygons into triangles and stores which sides are diagonals.
//!
//! Idea: a fan from the first corner, (0, k, k+1), as most programs and the reference counts have
//! it. If a triangle of the fan turns against its polygon, so that the fan would overlap itself,
//! the polygon is cut by ear clipping (Meisters 1975) instead.
//!
//! Rejected: ear clipping for all polygons. Its triangles are better, but its diagonals differ from
//! those of other programs, and the diagonal of a polygon that is not flat can be a contour.
//!
//! ```text
//!   3---2      (0,1,2) has the diagonal 2-0: side 2
//!   |  /|      (0,2,3) has the diagonal 0-2: side 0
//!   | / |
//!   0---1
//! ```

use glam::DVec3;

use crate::index::to_u32;
use crate::model::Model;
use crate::report::{RepairKind, Report};

/// Larger polygons are cut as fans in any case, because ear clipping takes quadratic time. The
/// largest concave face seen in real files has 936 corners.
const MAX_EAR_CLIPPED_CORNERS: usize = 4096;

/// A triangle of a polygon.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct PolygonTriangle {
    /// Indices of corners of the model.
    pub(crate) corners: [u32; 3],
    /// The index of the polygon in the model.
    pub(crate) polygon: u32,
    /// Bit k is set if the side from corner k to corner k+1 is a diagonal.
    pub(crate) diagonals: u8,
}

/// Cuts every polygon of `model`, in order.
pub(crate) fn triangulate(model: &Model, report: &mut Report) -> Vec<PolygonTriangle> {
    let total = model.corner_positions.len() - 2 * model.polygon_count();
    let mut triangles = Vec::with_capacity(total);
    let mut points = Vec::new();
    for polygon in 0..model.polygon_count() {
        let range = model.corner_range(polygon);
        let (first, count) = (to_u32(range.start), range.len());
        let mut push = |local: [usize; 3]| {
            triangles.push(PolygonTriangle {
                corners: local.map(|corner| first + to_u32(corner)),
                polygon: to_u32(polygon),
                diagonals: diagonal_sides(local, count),
            });
        };
        points.clear();
        points.extend(range.map(|corner| position_of(model, corner)));
        if (4..=MAX_EAR_CLIPPED_CORNERS).contains(&count)
            && fan_overlaps(&points)
            && let Some(ears) = clip_ears(&points)
        {
            let place = Some(model.polygon_place(polygon));
            report.repair(RepairKind::EarClippedPolygons, 1, place);
            ears.into_iter().for_each(push);
        } else {
            (1..count - 1).for_each(|k| push([0, k, k + 1]));
        }
    }
    triangles
}

fn position_of(model: &Model, corner: usize) -> DVec3 {
    DVec3::from(model.positions[model.corner_positions[corner] as usize])
}

/// The bits of the diagonals: sides whose ends are not successive in the polygon.
fn diagonal_sides(local: [usize; 3], count: usize) -> u8 {
    (0..3)
        .filter(|&side| (local[side] + 1) % count != local[(side + 1) % 3])
        .fold(0, |bits, side| bits | 1 << side)
}

/// Twice the polygon's area as a vector along its normal (Newell's method).
fn area_vector(points: &[DVec3]) -> DVec3 {
    let origin = points[0];
    points.windows(2).map(|pair| (pair[0] - origin).cross(pair[1] - origin)).sum()
}

fn fan_overlaps(points: &[DVec3]) -> bool {
    let normal = area_vector(points);
    (1..points.len() - 1).any(|k| {
        let side = (points[k] - points[0]).cross(points[k + 1] - points[0]);
        side.dot(normal) < 0.0
    })
}

/// Cuts off ears until a triangle is left; `None` if there is no ear, as in polygons that cross
/// themselves.
fn clip_ears(points: &[DVec3]) -> Option<Vec<[usize; 3]>> {
    let normal = area_vector(points);
    let mut ring: Vec<usize> = (0..points.len()).collect();
    let mut ears = Vec::with_capacity(points.len() - 2);
    // Cutting an ear can make ears only of its two neighbors.
    let mut ear: Vec<bool> =
        (0..ring.len()).map(|tip| is_ear(points, &ring, tip, normal)).collect();
    // The search goes on after the last ear, so that a strip does not become a fan of slivers.
    let mut at = 0;
    while ring.len() > 3 {
        let count = ring.len();
        let found = (0..count).map(|step| (at + step) % count).find(|&tip| ear[tip])?;
        let (before, after) = ((found + count - 1) % count, (found + 1) % count);
        ears.push([ring[before], ring[found], ring[after]]);
        ring.remove(found);
        ear.remove(found);
        let count = count - 1;
        at = found % count;
        for tip in [(found + count - 1) % count, at] {
            ear[tip] = is_ear(points, &ring, tip, normal);
        }
    }
    ears.push([ring[0], ring[1], ring[2]]);
    Some(ears)
}

fn is_ear(points: &[DVec3], ring: &[usize], tip: usize, normal: DVec3) -> bool {
    let count = ring.len();
    let corner =
        [(tip + count - 1) % count, tip, (tip + 1) % count].map(|place| points[ring[place]]);
    let turn = |a: DVec3, b: DVec3, c: DVec3| (b - a).cross(c - a).dot(normal);
    if turn(corner[0], corner[1], corner[2]) <= 0.0 {
        return false;
    }
    !ring.iter().any(|&other| {
        let point = points[other];
        !corner.contains(&point)
            && turn(corner[0], corner[1], point) >= 0.0
            && turn(corner[1], corner[2], point) >= 0.0
            && turn(corner[2], corner[0], point) >= 0.0
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(positions: &[[f32; 3]]) -> (Vec<PolygonTriangle>, Report) {
        let corners: Vec<u32> = (0..to_u32(positions.len())).collect();
        let model = Model::from_polygons(positions, &[&corners]);
        let mut report = Report::default();
        (triangulate(&model, &mut report), report)
    }

    #[test]
    fn a_quad_is_a_fan_with_one_diagonal() {
        let (triangles, report) = cut(&[[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]]);
        assert_eq!(triangles[0].corners, [0, 1, 2]);
        assert_eq!(triangles[0].diagonals, 0b100);
        assert_eq!(triangles[1].corners, [0, 2, 3]);
        assert_eq!(triangles[1].diagonals, 0b001);
        assert_eq!(report.repair_count(RepairKind::EarClippedPolygons), 0);
    }

    /// ```text
    ///      3
    ///     / \        the fan's first triangle (0,1,2) lies outside
    ///    / 1 \
    ///   0'   '2
    /// ```
    #[test]
    fn a_dart_is_cut_by_ears_and_covers_its_area_once() {
        let dart = [[-2., -1., 0.], [0., 0., 0.], [2., -1., 0.], [0., 3., 0.]];
        let (triangles, report) = cut(&dart);
        assert_eq!(report.repair_count(RepairKind::EarClippedPolygons), 1);
        let area: f64 = triangles
            .iter()
            .map(|triangle| {
                let [a, b, c] = triangle
                    .corners
                    .map(|corner| DVec3::from(dart[corner as usize].map(f64::from)));
                let area = (b - a).cross(c - a).z / 2.0;
                assert!(area > 0.0, "no triangle turns over: {triangle:?}");
                area
            })
            .sum();
        let corners: Vec<DVec3> =
            dart.iter().map(|&point| DVec3::from(point.map(f64::from))).collect();
        assert!((area - area_vector(&corners).z / 2.0).abs() < 1e-6);
    }

    #[test]
    fn a_polygon_that_crosses_itself_falls_back_to_a_fan() {
        let (triangles, _) = cut(&[[0., 0., 0.], [1., 1., 0.], [1., 0., 0.], [0., 1., 0.]]);
        assert_eq!(triangles.len(), 2);
    }
}
