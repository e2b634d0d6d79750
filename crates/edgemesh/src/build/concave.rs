//! Cuts a concave polygon of any size into triangles.
//!
//! Idea: a constrained Delaunay triangulation (crate `spade`) of the polygon's corners, in the
//! plane that is nearest to the polygon, with its sides as constraints. The triangles inside are
//! those around which the polygon winds once, counted from the outside inward, so a polygon whose
//! holes are joined to its outline by sides that run both ways is cut right.
//!
//! The corners are projected by leaving out one coordinate, which rounds nothing: corners in one
//! place stay in one place, and predicates are exact.
//!
//! Rejected: ear clipping, which takes quadratic time; the crates `earcut` and `earcutr`, which
//! leave out corners between two others on a line, so that the neighbors of a polygon would not
//! meet it there.

use glam::DVec3;
use rustc_hash::FxHashMap;
use spade::handles::DirectedEdgeHandle;
use spade::{
    ConstrainedDelaunayTriangulation, HasPosition, Point2, Triangulation, mitigate_underflow,
};

/// Twice the polygon's area as a vector along its normal (Newell's method).
pub(super) fn area_vector(points: &[DVec3]) -> DVec3 {
    let origin = points[0];
    points.windows(2).map(|pair| (pair[0] - origin).cross(pair[1] - origin)).sum()
}

/// A triangle of corners, and a bit for each of its sides that is a diagonal.
pub(super) type CutTriangle = ([usize; 3], u8);

/// A place of the polygon: one or several corners.
#[derive(Debug, Clone, Copy)]
struct Site {
    point: Point2<f64>,
    index: usize,
}

impl HasPosition for Site {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.point
    }
}

type Cut = ConstrainedDelaunayTriangulation<Site>;

/// The triangles of a polygon, or `None` if it crosses or covers itself.
pub(super) fn cut_concave(points: &[DVec3]) -> Option<Vec<CutTriangle>> {
    let outline = Outline::of(points)?;
    let sites: Vec<Site> = outline.projected(points);
    let mut constraints: Vec<[usize; 2]> =
        outline.sides.keys().map(|&[from, to]| [from.min(to), from.max(to)]).collect();
    constraints.sort_unstable();
    constraints.dedup();
    let mut is_crossed = false;
    let cut = Cut::try_bulk_load_cdt(sites, constraints, |_| is_crossed = true).ok()?;
    if is_crossed || cut.num_vertices() != outline.corners.len() {
        return None;
    }
    let inside = outline.inside(&cut)?;
    let triangles = cut.inner_faces().filter(|face| inside[face.fix().index()]);
    let triangles: Vec<CutTriangle> =
        triangles.map(|face| outline.triangle(face.vertices().map(|v| v.data().index))).collect();
    (!triangles.is_empty()).then_some(triangles)
}

/// The sides of a polygon between its places.
struct Outline {
    /// The corners at each place.
    corners: Vec<Vec<usize>>,
    /// The corner at which the side between two places begins.
    sides: FxHashMap<[usize; 2], usize>,
    /// The coordinates that are kept, in the order in which the polygon runs counterclockwise.
    axes: [usize; 2],
    /// The number of corners.
    count: usize,
}

impl Outline {
    /// The outline of a polygon, or `None` if two of its sides are one.
    fn of(points: &[DVec3]) -> Option<Self> {
        let mut places: FxHashMap<[u64; 3], usize> = FxHashMap::default();
        let mut corners: Vec<Vec<usize>> = Vec::new();
        let mut ring = Vec::with_capacity(points.len());
        for (corner, point) in points.iter().enumerate() {
            // Adding 0 makes -0 and 0 the same number.
            let bits = point.to_array().map(|coordinate| (coordinate + 0.0).to_bits());
            let place = *places.entry(bits).or_insert(corners.len());
            if place == corners.len() {
                corners.push(Vec::new());
            }
            corners[place].push(corner);
            ring.push(place);
        }
        let mut sides = FxHashMap::default();
        let mut covers_itself = false;
        for (corner, &from) in ring.iter().enumerate() {
            let to = ring[(corner + 1) % ring.len()];
            if from != to {
                covers_itself |= sides.insert([from, to], corner).is_some();
            }
        }
        let normal = area_vector(points);
        let upright = normal.abs().max_position();
        let [x, y] = [(upright + 1) % 3, (upright + 2) % 3];
        let axes = if normal[upright] > 0.0 { [x, y] } else { [y, x] };
        (!covers_itself).then_some(Self { corners, sides, axes, count: points.len() })
    }

    /// The places in the plane, scaled to a size around 1 by a power of two.
    fn projected(&self, points: &[DVec3]) -> Vec<Site> {
        let largest = points.iter().fold(0.0, |largest: f64, p| largest.max(p.abs().max_element()));
        let scale = if largest > 0.0 { (-largest.log2().round()).exp2() } else { 1.0 };
        let place = |(index, corners): (usize, &Vec<usize>)| {
            let [x, y] = self.axes.map(|axis| points[corners[0]][axis] * scale);
            Site { point: mitigate_underflow(Point2::new(x, y)), index }
        };
        self.corners.iter().enumerate().map(place).collect()
    }

    /// Whether the polygon winds around each face, by index; `None` if it does so more than once,
    /// or the other way.
    fn inside(&self, cut: &Cut) -> Option<Vec<bool>> {
        let mut turns: Vec<Option<i32>> = vec![None; cut.num_all_faces()];
        let outer = cut.outer_face().fix();
        turns[outer.index()] = Some(0);
        let mut open: Vec<usize> = vec![outer.index()];
        // The edges of each face, looked at once.
        let mut edges_of: Vec<Vec<(usize, i32)>> = vec![Vec::new(); cut.num_all_faces()];
        for edge in cut.directed_edges() {
            let across = edge.rev().face().fix().index();
            edges_of[edge.face().fix().index()].push((across, self.turns_across(edge)));
        }
        while let Some(face) = open.pop() {
            let own = turns[face]?;
            for &(across, difference) in &edges_of[face] {
                if turns[across].is_none() {
                    turns[across] = Some(own - difference);
                    open.push(across);
                }
            }
        }
        turns
            .into_iter()
            .map(|turns| match turns {
                Some(0) => Some(false),
                Some(1) => Some(true),
                _ => None,
            })
            .collect()
    }

    /// How many times more the polygon winds around the face left of an edge than around the one
    /// on its right.
    fn turns_across(&self, edge: DirectedEdgeHandle<'_, Site, (), spade::CdtEdge<()>, ()>) -> i32 {
        let [from, to] = [edge.from(), edge.to()].map(|vertex| vertex.data().index);
        i32::from(self.sides.contains_key(&[from, to]))
            - i32::from(self.sides.contains_key(&[to, from]))
    }

    /// The corners of a triangle of places, and its diagonals.
    fn triangle(&self, places: [usize; 3]) -> CutTriangle {
        let mut local = places.map(|place| self.corners[place][0]);
        let mut diagonals = 0;
        for side in 0..3 {
            let ends = [places[side], places[(side + 1) % 3]];
            match self.sides.get(&ends) {
                // Of several corners in one place, those of the side.
                Some(&corner) => {
                    local[side] = corner;
                    local[(side + 1) % 3] = (corner + 1) % self.count;
                }
                None => diagonals |= 1 << side,
            }
        }
        (local, diagonals)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Twice the area of triangles in the plane z = 0, all of which turn one way.
    fn two_areas(points: &[DVec3], triangles: &[CutTriangle]) -> f64 {
        let area = |&(corners, _): &CutTriangle| {
            let [a, b, c] = corners.map(|corner| points[corner]);
            let area = (b - a).cross(c - a).z;
            assert!(area > 0.0, "{corners:?}");
            area
        };
        triangles.iter().map(area).sum()
    }

    fn flat(points: &[[f64; 2]]) -> Vec<DVec3> {
        points.iter().map(|&[x, y]| DVec3::new(x, y, 0.0)).collect()
    }

    /// A comb of `teeth` teeth, 1 wide and 2 high, 1 apart, on a back 1 high.
    fn comb(teeth: u32) -> Vec<DVec3> {
        let x = f64::from;
        let mut points = vec![[0.0, 0.0], [x(2 * teeth - 1), 0.0]];
        for tooth in (0..teeth).rev() {
            let (left, right) = (x(2 * tooth), x(2 * tooth + 1));
            points.extend([[right, 3.0], [left, 3.0]]);
            if tooth > 0 {
                points.extend([[left, 1.0], [left - 1.0, 1.0]]);
            }
        }
        flat(&points)
    }

    #[test]
    fn outlines_of_any_size_have_their_own_area() {
        for teeth in [2, 10, 5000] {
            let points = comb(teeth);
            let triangles = cut_concave(&points).unwrap();
            assert_eq!(triangles.len(), points.len() - 2);
            let area = 2.0 * f64::from(2 * teeth - 1 + 2 * teeth);
            assert!((two_areas(&points, &triangles) - area).abs() < 1e-6, "{teeth} teeth");
            let diagonals: u32 = triangles.iter().map(|(_, bits)| bits.count_ones()).sum();
            assert_eq!(diagonals as usize, 2 * (points.len() - 3));
        }
    }

    #[test]
    fn corners_on_a_line_and_mirrored_outlines_keep_every_corner() {
        let mut points =
            flat(&[[0., 0.], [1., 0.], [2., 0.], [3., 0.], [3., 3.], [1.5, 1.], [0., 3.]]);
        let triangles = cut_concave(&points).unwrap();
        assert_eq!(triangles.len(), 5);
        assert!((two_areas(&points, &triangles) - 12.0).abs() < 1e-12);
        points.reverse();
        assert_eq!(cut_concave(&points).unwrap().len(), 5);
        // Upright, too.
        let upright: Vec<DVec3> = points.iter().map(|p| DVec3::new(5.0, p.y, p.x)).collect();
        assert_eq!(cut_concave(&upright).unwrap().len(), 5);
    }

    /// A square with a square hole, joined by a side that runs both ways.
    #[test]
    fn a_hole_is_left_out() {
        let points = flat(&[
            [0., 0.],
            [3., 0.],
            [3., 3.],
            [0., 3.],
            [0., 0.],
            [1., 1.],
            [1., 2.],
            [2., 2.],
            [2., 1.],
            [1., 1.],
        ]);
        let triangles = cut_concave(&points).unwrap();
        assert_eq!(triangles.len(), 8);
        assert!((two_areas(&points, &triangles) - 16.0).abs() < 1e-12);
        let sides = triangles.iter().map(|(_, bits)| 3 - bits.count_ones()).sum::<u32>();
        assert_eq!(sides, 10);
    }

    #[test]
    fn what_crosses_or_covers_itself_is_not_cut() {
        assert!(cut_concave(&flat(&[[0., 0.], [1., 1.], [1., 0.], [0., 3.]])).is_none());
        let star = (0..5).map(|k| f64::from(2 * k) * std::f64::consts::TAU / 5.0);
        let star: Vec<[f64; 2]> = star.map(|angle| [angle.cos(), angle.sin()]).collect();
        assert!(cut_concave(&flat(&star)).is_none());
        let twice = [[0., 0.], [2., 0.], [1., 2.], [0., 0.], [2., 0.], [1., 2.]];
        assert!(cut_concave(&flat(&twice)).is_none());
    }

    #[test]
    fn size_does_not_matter() {
        for scale in [1e-40, 1e-9, 1e30] {
            let points: Vec<DVec3> = comb(3).iter().map(|&point| point * scale).collect();
            assert_eq!(cut_concave(&points).map(|cut| cut.len()), Some(points.len() - 2));
        }
    }
}
