//! A small part in the style of CAD: an angle bracket with a bored upright plate and a
//! rib in the corner.
//!
//! ```text
//!        y                      upright plate from the front
//!      H +--+                   +-----------+ H
//!        |  |                   |   .---.   |
//!        |::| hole              |  (  O  )  |    O the hole, ( ) a pad around
//!        |  |                   |   '---'   |    it, flat: only the material
//!   RIB_Y|  |\                  |    +-+    |    changes there
//!        |  | \  rib            |    | |    |
//!      T |  +--+----+           +----+-+----+ T
//!      0 +----------+ z         +-----------+ 0
//!        0  T RIB_Z D          -W           W
//! ```
//!
//! Flat faces are cut only where they must be, so no edge ends inside another.

use super::polygon_mesh::PolygonMesh;
use super::vector::{Point, turn};

const PAINTED: &str = "painted";
const MACHINED: &str = "machined";

/// Half the width.
const W: f64 = 0.5;
/// Height of the upright plate.
const H: f64 = 1.2;
/// Depth of the base plate.
const D: f64 = 1.0;
/// Thickness of both plates.
const T: f64 = 0.15;

/// The rib: half its width, and how far it reaches up and out.
const RIB_W: f64 = 0.06;
const RIB_Y: f64 = 0.55;
const RIB_Z: f64 = 0.7;

/// The hole and the pad around it.
const HOLE_Y: f64 = 0.85;
const HOLE_RADIUS: f64 = 0.18;
const PAD_RADIUS: f64 = 0.27;
const HOLE_SIDES: u32 = 32;

/// A point of a face that looks along z: x, y.
type FlatPoint = [f64; 2];

pub(crate) fn mesh() -> PolygonMesh {
    let mut mesh = PolygonMesh::default();
    for face in plates().into_iter().chain(rib()).chain(upright_back()).chain(upright_front()) {
        mesh.add_of(PAINTED, &face.into_iter().map(centered).collect::<Vec<_>>());
    }
    for face in bore().into_iter().chain(pad()) {
        mesh.add_of(MACHINED, &face.map(centered));
    }
    mesh
}

fn centered([x, y, z]: Point) -> Point {
    [x, y - H / 2.0, z - D / 2.0]
}

/// The faces of both plates, except the two that the hole goes through.
fn plates() -> Vec<Vec<Point>> {
    // From the inner corner, so that a fan of triangles fills the angle; those on the
    // right run the other way around.
    let angle = [[T, T], [H, T], [H, 0.0], [0.0, 0.0], [0.0, D], [T, D]];
    let side = |x: f64| angle.map(|[y, z]| [x, y, z]).to_vec();
    let mut right = side(W);
    right[1..].reverse();
    vec![
        side(-W),
        right,
        vec![[-W, 0.0, 0.0], [W, 0.0, 0.0], [W, 0.0, D], [-W, 0.0, D]],
        vec![[-W, 0.0, D], [W, 0.0, D], [W, T, D], [-W, T, D]],
        vec![[-W, H, T], [W, H, T], [W, H, 0.0], [-W, H, 0.0]],
        // The top of the base plate, around the rib.
        vec![[-W, T, T], [-W, T, D], [-RIB_W, T, RIB_Z], [-RIB_W, T, T]],
        vec![[-W, T, D], [W, T, D], [RIB_W, T, RIB_Z], [-RIB_W, T, RIB_Z]],
        vec![[W, T, D], [W, T, T], [RIB_W, T, T], [RIB_W, T, RIB_Z]],
    ]
}

fn rib() -> [Vec<Point>; 3] {
    let side = |x: f64| [[x, T, T], [x, RIB_Y, T], [x, T, RIB_Z]];
    let [left, right] = [side(-RIB_W), side(RIB_W)];
    [vec![left[0], left[2], left[1]], right.to_vec(), vec![left[1], left[2], right[2], right[1]]]
}

fn upright_back() -> Vec<Vec<Point>> {
    let outer = [[W, H], [-W, H], [-W, 0.0], [W, 0.0]];
    let triangles = between_loops(&outer, &circle(HOLE_RADIUS));
    // Seen from behind, left is right.
    triangles.into_iter().map(|[a, b, c]| [a, c, b].map(|p| at_z(p, 0.0)).to_vec()).collect()
}

fn upright_front() -> Vec<Vec<Point>> {
    // The corners beside the rib, which cannot see the hole, are cut off first.
    let beside_rib =
        [[[-W, T], [-RIB_W, T], [-RIB_W, RIB_Y]], [[RIB_W, RIB_Y], [RIB_W, T], [W, T]]];
    let outer = [[W, H], [-W, H], [-W, T], [-RIB_W, RIB_Y], [RIB_W, RIB_Y], [W, T]];
    let triangles = between_loops(&outer, &circle(PAD_RADIUS));
    let all = beside_rib.into_iter().chain(triangles);
    all.map(|triangle| triangle.map(|p| at_z(p, T)).to_vec()).collect()
}

/// The wall of the hole; it looks towards the hole's axis.
fn bore() -> Vec<[Point; 4]> {
    let quad = |[a, b]: [FlatPoint; 2]| [at_z(a, 0.0), at_z(b, 0.0), at_z(b, T), at_z(a, T)];
    sides(&circle(HOLE_RADIUS)).into_iter().map(quad).map(reversed).collect()
}

/// The flat ring around the hole's front end.
fn pad() -> Vec<[Point; 4]> {
    let [inner, outer] = [HOLE_RADIUS, PAD_RADIUS].map(|radius| sides(&circle(radius)));
    let quads = inner.into_iter().zip(outer);
    quads.map(|([a, b], [c, d])| [a, c, d, b].map(|p| at_z(p, T))).collect()
}

fn reversed([a, b, c, d]: [Point; 4]) -> [Point; 4] {
    [d, c, b, a]
}

fn at_z([x, y]: FlatPoint, z: f64) -> Point {
    [x, y, z]
}

/// Around the hole's axis, counter-clockwise as seen from the front.
fn circle(radius: f64) -> Vec<FlatPoint> {
    let point = |step| {
        let (sine, cosine) = turn(step, HOLE_SIDES);
        [radius * cosine, HOLE_Y + radius * sine]
    };
    (0..HOLE_SIDES).map(point).collect()
}

fn sides(points: &[FlatPoint]) -> Vec<[FlatPoint; 2]> {
    (0..points.len()).map(|i| [points[i], points[(i + 1) % points.len()]]).collect()
}

/// Triangles that fill the space between two loops around the hole's axis; both
/// run counter-clockwise.
///
/// Walks along both at once and takes the step whose middle comes first, seen from the
/// axis, so that every corner gets the part of the circle that faces it.
fn between_loops(outer: &[FlatPoint], inner: &[FlatPoint]) -> Vec<[FlatPoint; 3]> {
    let first = nearest(outer[0], inner);
    let outer_at = |i: usize| outer[i % outer.len()];
    let inner_at = |j: usize| inner[(first + j) % inner.len()];
    let (mut i, mut j) = (0, 0);
    let mut triangles = Vec::new();
    while i < outer.len() || j < inner.len() {
        let outer_middle = middle_direction(outer_at(i), outer_at(i + 1));
        let inner_middle = middle_direction(inner_at(j), inner_at(j + 1));
        let outer_is_first = cross(outer_middle, inner_middle) > 0.0;
        if j == inner.len() || (i < outer.len() && outer_is_first) {
            triangles.push([outer_at(i), outer_at(i + 1), inner_at(j)]);
            i += 1;
        } else {
            triangles.push([outer_at(i), inner_at(j + 1), inner_at(j)]);
            j += 1;
        }
    }
    triangles
}

/// Half-way between two points as seen from the hole's axis.
fn middle_direction(a: FlatPoint, b: FlatPoint) -> FlatPoint {
    let [a, b] = [a, b].map(|[x, y]| {
        let length = x.hypot(y - HOLE_Y);
        [x / length, (y - HOLE_Y) / length]
    });
    [a[0] + b[0], a[1] + b[1]]
}

fn cross(a: FlatPoint, b: FlatPoint) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn nearest(to: FlatPoint, points: &[FlatPoint]) -> usize {
    let distance = |i: usize| (points[i][0] - to[0]).hypot(points[i][1] - to[1]);
    let by_distance = |a: &usize, b: &usize| distance(*a).total_cmp(&distance(*b));
    (0..points.len()).min_by(by_distance).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn doubled_area([a, b, c]: [FlatPoint; 3]) -> f64 {
        cross([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]])
    }

    #[test]
    fn the_space_between_loops_is_filled_once() {
        let outer = [[W, H], [-W, H], [-W, 0.0], [W, 0.0]];
        let circle = circle(HOLE_RADIUS);
        let triangles = between_loops(&outer, &circle);
        assert_eq!(triangles.len(), outer.len() + circle.len());
        for triangle in &triangles {
            assert!(doubled_area(*triangle) > 1e-6, "{triangle:?} is turned over or flat");
        }
        let filled: f64 = triangles.into_iter().map(doubled_area).sum::<f64>() / 2.0;
        let (sine, _) = turn(1, HOLE_SIDES);
        let hole = f64::from(HOLE_SIDES) * HOLE_RADIUS * HOLE_RADIUS * sine / 2.0;
        assert!((filled - (2.0 * W * H - hole)).abs() < 1e-9, "{filled}");
    }

    #[test]
    fn the_volume_is_that_of_the_drawing() {
        let (sine, _) = turn(1, HOLE_SIDES);
        let hole = f64::from(HOLE_SIDES) * HOLE_RADIUS * HOLE_RADIUS * sine / 2.0 * T;
        let plates = 2.0 * W * (D * T + (H - T) * T);
        let rib = RIB_W * (RIB_Y - T) * (RIB_Z - T);
        let volume = mesh().signed_volume();
        assert!((volume - (plates + rib - hole)).abs() < 1e-5, "{volume}");
    }
}
