//! A square sheet with a round hole, bent up towards its corners like a shallow
//! bowl. It is open: the square and the hole are its two boundaries.
//!
//! Quads lie in rings, from the circle to the square.

use super::polygon_mesh::PolygonMesh;
use super::vector::{Point, turn};

/// A multiple of 8, so that the square has its corners.
const STEPS: u32 = 64;
const RINGS: u32 = 12;

const HALF_WIDTH: f64 = 1.0;
const HOLE_RADIUS: f64 = 0.4;

/// Height at a distance of 1 from the middle, over the sheet's lowest point.
const RISE: f64 = 0.12;

pub(crate) fn mesh() -> PolygonMesh {
    let mut mesh = PolygonMesh::default();
    for ring in 0..RINGS {
        for step in 0..STEPS {
            mesh.add(&[
                point(ring, step),
                point(ring + 1, step),
                point(ring + 1, step + 1),
                point(ring, step + 1),
            ]);
        }
    }
    mesh
}

/// Counter-clockwise as seen from above; ring 0 is the hole.
fn point(ring: u32, step: u32) -> Point {
    let (sine, cosine) = turn(step, STEPS);
    let rim = HALF_WIDTH / sine.abs().max(cosine.abs());
    let radius = HOLE_RADIUS + (rim - HOLE_RADIUS) * f64::from(ring) / f64::from(RINGS);
    let y = RISE * (radius * radius - HALF_WIDTH * HALF_WIDTH);
    [radius * cosine, y, -radius * sine]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_boundary_is_two_loops() {
        let edges = mesh().directed_edges();
        let alone: Vec<[usize; 2]> = edges
            .iter()
            .filter(|&&[from, to]| edges.binary_search(&[to, from]).is_err())
            .copied()
            .collect();
        assert_eq!(alone.len(), 2 * 64, "an edge per step around each loop");

        // Each walk follows the boundary from its first edge until it closes.
        let mut left = alone.clone();
        let mut loop_count = 0;
        while let Some([start, mut at]) = left.pop() {
            loop_count += 1;
            while at != start {
                let next = left.iter().position(|edge| edge[0] == at).unwrap();
                at = left.swap_remove(next)[1];
            }
        }
        assert_eq!(loop_count, 2);
    }

    #[test]
    fn the_sheet_faces_up() {
        let sheet = mesh();
        let (low, high) = sheet.bounds();
        assert_eq!((low[0], high[0], low[2], high[2]), (-1.0, 1.0, -1.0, 1.0));
        let square_minus_hole = 4.0 - std::f64::consts::PI * 0.4 * 0.4;
        let area = sheet.area_from_above();
        assert!((area - square_minus_hole).abs() < 0.01, "{area}");
    }
}
