//! A ball with waves: few sharp edges, but folds that hide parts of themselves, so that
//! contours run and end inside the outline.

use std::f64::consts::FRAC_PI_4;

use super::cube::cube_grid;
use super::polygon_mesh::PolygonMesh;
use super::vector::{Point, add, dot, scale, unit};

/// Quads along each edge of the cube that becomes the ball: 2,402 points.
const CELLS: u32 = 20;

const RADIUS: f64 = 0.75;

/// The shift of the middle by the waves, which is subtracted.
const MIDDLE: Point = [-0.05, 0.15, -0.04];

/// A wave through space: its direction, height and phase.
struct Wave {
    direction: Point,
    height: f64,
    phase: f64,
}

const WAVES: [Wave; 4] = [
    Wave { direction: [4.1, 1.9, -1.3], height: 0.12, phase: 0.4 },
    Wave { direction: [-1.7, 4.7, 2.3], height: 0.10, phase: 2.3 },
    Wave { direction: [2.3, -3.1, 5.3], height: 0.08, phase: 3.3 },
    Wave { direction: [-6.1, 3.7, 3.1], height: 0.04, phase: 5.2 },
];

pub(crate) fn mesh() -> PolygonMesh {
    let mut mesh = PolygonMesh::default();
    for quad in cube_grid(CELLS) {
        mesh.add(&quad.map(waved));
    }
    mesh
}

/// A point of the cube, moved to the waved ball.
fn waved(on_cube: Point) -> Point {
    // The tangent makes the quads nearly equal in size.
    let on_ball = unit(on_cube.map(|coordinate| (coordinate * FRAC_PI_4).tan()));
    let rise: f64 = WAVES
        .iter()
        .map(|wave| wave.height * (dot(wave.direction, on_ball) + wave.phase).sin())
        .sum();
    add(scale(on_ball, RADIUS + rise), scale(MIDDLE, -1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sides_of_the_cube_share_their_points() {
        let blob = mesh();
        assert_eq!((blob.faces().len(), blob.point_count()), (2400, 2402));
    }
}
