//! The nearest surface in sight: where the near plane may lie.
//!
//! A perspective view needs a near plane in front of all that it sees, and as far away as that
//! allows: triangles that are clipped much nearer than they are large lose their shape to rounding.
//! So the nearest point of the scene inside the picture is looked for.
//!
//! ```text
//!   eye  .        __ . '
//!         |  . ' |__|        inside the picture: this box is the nearest
//!         |  ' .
//!     /\  |      ' .         a triangle that reaches behind the eye, but not into sight
//!    /__\_|__________\
//! ```
//!
//! Small triangles are put into the cells of a grid, and the box around those of a cell stands for
//! them. Large triangles, such as those of a ground or far away, are cut exactly at the sides of the
//! picture.
//!
//! Rejected: the nearest point of the scene's box or bounding sphere, in which the eye can be.

use glam::{DMat4, DVec3, DVec4, USizeVec3, Vec3, Vec4};

use crate::edge_mesh::{Bounds, EdgeMesh};
use crate::index::NONE;
use crate::view::View;

/// The cells of the grid along the longest axis of the mesh. A triangle larger than a cell is a
/// large one.
const CELLS: usize = 32;

/// A surface that passes through the eye counts as this far away, in parts of its size.
const MIN_NEAR_SIZES: f64 = 1.0 / 1_048_576.0;

/// The boxes of the small triangles of a mesh, and its large triangles.
#[derive(Debug, Clone, Default)]
pub struct SightIndex {
    boxes: Vec<Bounds>,
    /// Lines without faces are triangles with two corners in one place.
    triangles: Vec<[[f32; 3]; 3]>,
}

/// The part of space that a view sees, in front of the eye.
#[derive(Debug, Clone)]
pub struct Sight {
    /// A point (w = 1) is inside if its dot product with none of these is negative.
    planes: Vec<DVec4>,
    /// The dot product with a point (w = 1) is its distance along the line of sight.
    distance: DVec4,
}

impl SightIndex {
    /// The boxes and large triangles of a mesh.
    #[must_use]
    pub fn of(mesh: &EdgeMesh) -> Self {
        let at = |vertex: u32| mesh.positions[vertex as usize];
        let lines = mesh.records.iter().filter(|record| record.face_a == NONE);
        let lines = lines.map(|line| [line.v0, line.v1, line.v1]);
        let grid = Grid::of(&mesh.bounds);
        let mut boxes: Vec<Option<Bounds>> = vec![None; CELLS * CELLS * CELLS];
        let mut triangles = Vec::new();
        for corners in mesh.triangles.iter().copied().chain(lines) {
            let corners = corners.map(at);
            let bounds = Bounds::of(&corners);
            if grid.is_large(&bounds) {
                triangles.push(corners);
            } else {
                let cell = &mut boxes[grid.cell_of(corners[0])];
                *cell = Some(cell.map_or(bounds, |cell| cell.union(&bounds)));
            }
        }
        Self { boxes: boxes.into_iter().flatten().collect(), triangles }
    }

    /// Whether the mesh has neither faces nor lines.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.boxes.is_empty() && self.triangles.is_empty()
    }

    /// The distance of the nearest surface in sight along the line of sight, or a little less;
    /// `None` if nothing is in sight. The result is positive.
    #[must_use]
    pub fn nearest(&self, sight: &Sight) -> Option<f64> {
        let boxes = self.boxes.iter().filter_map(|bounds| sight.nearest_of_box(bounds));
        let triangles = self.triangles.iter().filter_map(|corners| sight.nearest_of(corners));
        boxes.chain(triangles).min_by(f64::total_cmp)
    }
}

/// A grid of cubes over the box of a mesh.
struct Grid {
    low: Vec3,
    cell_size: f32,
}

impl Grid {
    fn of(bounds: &Bounds) -> Self {
        let low = Vec3::from(bounds.min);
        let size = (Vec3::from(bounds.max) - low).max_element();
        #[expect(clippy::cast_precision_loss, reason = "a small number")]
        let cells = CELLS as f32;
        Self { low, cell_size: (size / cells).max(f32::MIN_POSITIVE) }
    }

    fn is_large(&self, bounds: &Bounds) -> bool {
        let size = Vec3::from(bounds.max) - Vec3::from(bounds.min);
        size.max_element() > self.cell_size
    }

    fn cell_of(&self, position: [f32; 3]) -> usize {
        let place = (Vec3::from(position) - self.low) / self.cell_size;
        let [x, y, z] = place.as_usizevec3().min(USizeVec3::splat(CELLS - 1)).to_array();
        (z * CELLS + y) * CELLS + x
    }
}

impl Sight {
    /// What a view sees inside of `band`, in half sizes of the picture: 1 for the picture,
    /// [`GUARD_BAND`](crate::view::GUARD_BAND) for all that strokes in it may come from. Points
    /// (w = 1) whose dot product with one of `clip_planes` is negative are gone.
    #[must_use]
    pub fn of(view: &View, band: f32, clip_planes: &[[f32; 4]]) -> Self {
        let [x, y, _, w] = [0, 1, 2, 3].map(|row| view.clip_from_world.row(row).as_dvec4());
        let band = f64::from(band);
        let mut planes = vec![band * w - x, band * w + x, band * w - y, band * w + y];
        if view.eye.w != 0.0 {
            planes.push(w);
        }
        planes.extend(clip_planes.iter().map(|&plane| Vec4::from(plane).as_dvec4()));
        Self { planes, distance: view.distance.as_dvec4() }
    }

    /// The same for the positions of an object.
    #[must_use]
    pub fn in_object(&self, world_from_object: &DMat4) -> Self {
        let rows = world_from_object.transpose();
        Self {
            planes: self.planes.iter().map(|plane| rows * plane).collect(),
            distance: rows * self.distance,
        }
    }

    /// The least distance of a box that may be in sight.
    fn nearest_of_box(&self, bounds: &Bounds) -> Option<f64> {
        let center = bounds.center().extend(1.0);
        let half = (Vec3::from(bounds.max) - Vec3::from(bounds.min)).as_dvec3() / 2.0;
        let reach = |plane: &DVec4| plane.truncate().abs().dot(half);
        let is_outside = |plane: &DVec4| plane.dot(center) + reach(plane) < 0.0;
        if self.planes.iter().any(is_outside) {
            return None;
        }
        let nearest = self.distance.dot(center) - reach(&self.distance);
        Some(nearest.max(MIN_NEAR_SIZES * half.length().max(f64::MIN_POSITIVE)))
    }

    /// The least distance of the part of a triangle that is in sight.
    fn nearest_of(&self, corners: &[[f32; 3]; 3]) -> Option<f64> {
        let corners = corners.map(|corner| Vec3::from(corner).as_dvec3());
        let distance = |point: &DVec3| self.distance.dot(point.extend(1.0));
        let size = corners.iter().map(|point| distance(point).abs()).fold(0.0, f64::max);
        let mut polygon = corners.to_vec();
        for plane in &self.planes {
            polygon = cut(&polygon, plane);
        }
        let nearest = polygon.iter().map(distance).min_by(f64::total_cmp)?;
        Some(nearest.max(MIN_NEAR_SIZES * size.max(f64::MIN_POSITIVE)))
    }
}

/// The part of a convex polygon on the inside of a plane.
fn cut(polygon: &[DVec3], plane: &DVec4) -> Vec<DVec3> {
    let height = |point: &DVec3| plane.dot(point.extend(1.0));
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (at, point) in polygon.iter().enumerate() {
        let next = &polygon[(at + 1) % polygon.len()];
        let (here, there) = (height(point), height(next));
        if here >= 0.0 {
            kept.push(*point);
        }
        if (here < 0.0) != (there < 0.0) {
            kept.push(point.lerp(*next, here / (here - there)));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::build_edge_mesh;
    use crate::model::Model;
    use crate::view::{Camera, GUARD_BAND};

    fn mesh(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> EdgeMesh {
        let polygons: Vec<&[u32]> = triangles.iter().map(<[u32; 3]>::as_slice).collect();
        let model = Model::from_polygons(positions, &polygons);
        build_edge_mesh(&model, &Default::default(), &mut Default::default())
    }

    /// From `eye` along -z, with a field of view of 90 degrees.
    fn sight(eye: DVec3, clip_planes: &[[f32; 4]]) -> Sight {
        let camera = Camera {
            eye,
            target: eye - DVec3::Z,
            up: DVec3::Y,
            fov_y_rad: std::f64::consts::FRAC_PI_2,
            is_orthographic: false,
        };
        let view = camera.view(&Bounds { min: [-1.0; 3], max: [1.0; 3] }, 1.0);
        Sight::of(&view, GUARD_BAND, clip_planes)
    }

    /// A small triangle around (0, 0, -5), and one that is far away and large.
    fn near_and_far() -> EdgeMesh {
        let near = [[-0.1, -0.1, -5.0], [0.1, -0.1, -5.0], [0.0, 0.1, -5.0]];
        let far = [[-9e5, -9e5, -8e5], [9e5, -9e5, -8e5], [0.0, 9e5, -8e5]];
        mesh(&[near, far].concat(), &[[0, 1, 2], [3, 4, 5]])
    }

    #[test]
    fn a_stray_triangle_far_away_moves_nothing() {
        let index = SightIndex::of(&near_and_far());
        let nearest = index.nearest(&sight(DVec3::ZERO, &[])).unwrap();
        assert!((nearest - 5.0).abs() < 1e-6, "{nearest}");
        // Past the small one, only the large one is left; past both, nothing.
        let nearest = index.nearest(&sight(DVec3::Z * -6.0, &[])).unwrap();
        assert!((nearest - 799_994.0).abs() < 0.1, "{nearest}");
        assert_eq!(index.nearest(&sight(DVec3::Z * -9e5, &[])), None);
        // A clip plane that leaves z < -6.
        let nearest = index.nearest(&sight(DVec3::ZERO, &[[0.0, 0.0, -1.0, -6.0]])).unwrap();
        assert!((nearest - 8e5).abs() < 0.1, "{nearest}");
    }

    #[test]
    fn a_ground_counts_where_it_comes_into_sight() {
        let ground = [[-3e4, 0.0, -3e4], [3e4, 0.0, -3e4], [3e4, 0.0, 3e4], [-3e4, 0.0, 3e4]];
        let index = SightIndex::of(&mesh(&ground, &[[2, 1, 0], [3, 2, 0]]));
        // From 2 above it, the guard band of 4 half pictures begins to see it at 2 / 4.
        let nearest = index.nearest(&sight(DVec3::Y * 2.0, &[])).unwrap();
        assert!((nearest - 0.5).abs() < 1e-6, "{nearest}");
        // An eye on the ground is told a distance too.
        let nearest = index.nearest(&sight(DVec3::ZERO, &[])).unwrap();
        assert!(nearest > 0.0 && nearest < 0.1, "{nearest}");
    }

    #[test]
    fn the_nearest_is_that_of_all_triangles_and_moves_with_the_object() {
        // Triangles smaller than a cell.
        let side = 100_u32;
        let at = |row: u32, column: u32| {
            let [x, y] = [column, row].map(|step| f64::from(step) / f64::from(side) * 8.0 - 4.0);
            DVec3::new(x, y, -9.0 + 0.05 * (x * x + y * y)).as_vec3().to_array()
        };
        let positions: Vec<[f32; 3]> =
            (0..side).flat_map(|row| (0..side).map(move |column| at(row, column))).collect();
        let triangles: Vec<[u32; 3]> = (0..side - 1)
            .flat_map(|row| (0..side - 1).map(move |column| row * side + column))
            .flat_map(|low| [[low, low + 1, low + side], [low + 1, low + side + 1, low + side]])
            .collect();
        let bowl = mesh(&positions, &triangles);
        let index = SightIndex::of(&bowl);
        assert!(!index.boxes.is_empty() && index.triangles.is_empty());
        let size = 2.0 * bowl.bounds.radius() / 16.0;
        for eye in [DVec3::ZERO, DVec3::new(3.0, 0.0, -2.0), DVec3::new(0.0, 30.0, -2.0)] {
            let here = sight(eye, &[]);
            let exact = bowl
                .triangles
                .iter()
                .filter_map(|triangle| {
                    here.nearest_of(&triangle.map(|vertex| bowl.positions[vertex as usize]))
                })
                .min_by(f64::total_cmp);
            let found = index.nearest(&here);
            assert_eq!(found.is_some(), exact.is_some(), "{eye}");
            if let (Some(found), Some(exact)) = (found, exact) {
                assert!(found <= exact && found > exact - size, "{found} for {exact}");
                let moved = DMat4::from_translation(DVec3::Z * -2.0);
                let farther = index.nearest(&here.in_object(&moved)).unwrap();
                assert!((farther - found - 2.0).abs() < 1e-6, "{farther}");
            }
        }
    }
}
