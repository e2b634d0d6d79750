//! Cuts polygons into triangles and stores which sides are diagonals.
//!
//! Idea: a fan from the first corner, (0, k, k+1), as most programs and the reference counts have
//! it. If a triangle of the fan turns against its polygon, so that the fan would overlap itself,
//! the polygon is cut as [`concave`](super::concave) instead. A polygon that crosses itself has no
//! inside; it stays a fan, with a warning.
//!
//! Rejected: cutting all polygons in the better way. Its diagonals differ from those of other
//! programs, and the diagonal of a polygon that is not flat can be a contour.
//!
//! ```text
//!   3---2      (0,1,2) has the diagonal 2-0: side 2
//!   |  /|      (0,2,3) has the diagonal 0-2: side 0
//!   | / |
//!   0---1
//! ```

use glam::DVec3;

use super::concave::{area_vector, cut_concave};
use crate::index::to_u32;
use crate::model::Model;
use crate::report::{RepairKind, Report, WarningCode};

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

/// Cuts every polygon of `model`, in order; those of `jointed`, ascending, have corners on their
/// sides, from which a fan would have triangles without area.
pub(crate) fn triangulate(
    model: &Model,
    jointed: &[u32],
    report: &mut Report,
) -> Vec<PolygonTriangle> {
    let total = model.corner_positions.len() - 2 * model.polygon_count();
    let mut triangles = Vec::with_capacity(total);
    let mut points = Vec::new();
    for polygon in 0..model.polygon_count() {
        let range = model.corner_range(polygon);
        let (first, count) = (to_u32(range.start), range.len());
        let mut push = |local: [usize; 3], diagonals: u8| {
            let corners = local.map(|corner| first + to_u32(corner));
            triangles.push(PolygonTriangle { corners, polygon: to_u32(polygon), diagonals });
        };
        points.clear();
        points.extend(range.map(|corner| position_of(model, corner)));
        let is_jointed = jointed.binary_search(&to_u32(polygon)).is_ok();
        if is_jointed && let Some(cut) = cut_concave(&points) {
            cut.into_iter().for_each(|(local, diagonals)| push(local, diagonals));
            continue;
        }
        if count > 3 && fan_overlaps(&points) {
            let place = Some(model.polygon_place(polygon));
            if let Some(cut) = cut_concave(&points) {
                report.repair(RepairKind::EarClippedPolygons, 1, place);
                cut.into_iter().for_each(|(local, diagonals)| push(local, diagonals));
                continue;
            }
            report.warn(WarningCode::Crossing, place, || {
                "a polygon crosses itself; it was cut as a fan".into()
            });
        }
        (1..count - 1).for_each(|k| push([0, k, k + 1], fan_diagonals(k, count)));
    }
    triangles
}

fn position_of(model: &Model, corner: usize) -> DVec3 {
    DVec3::from(model.positions[model.corner_positions[corner] as usize])
}

/// The bits of the diagonals of the fan's triangle (0, k, k+1).
const fn fan_diagonals(k: usize, count: usize) -> u8 {
    let (starts, ends) = (k > 1, k + 2 < count);
    starts as u8 | (ends as u8) << 2
}

fn fan_overlaps(points: &[DVec3]) -> bool {
    let normal = area_vector(points);
    (1..points.len() - 1).any(|k| {
        let side = (points[k] - points[0]).cross(points[k + 1] - points[0]);
        side.dot(normal) < 0.0
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(positions: &[[f32; 3]]) -> (Vec<PolygonTriangle>, Report) {
        let corners: Vec<u32> = (0..to_u32(positions.len())).collect();
        let model = Model::from_polygons(positions, &[&corners]);
        let mut report = Report::default();
        (triangulate(&model, &[], &mut report), report)
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
    fn a_dart_covers_its_area_once() {
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
        let (triangles, report) = cut(&[[0., 0., 0.], [1., 1., 0.], [1., 0., 0.], [0., 3., 0.]]);
        assert_eq!(triangles.len(), 2);
        assert_eq!(report.count(WarningCode::Crossing), 1);
    }
}
