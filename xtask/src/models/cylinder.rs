//! An upright cylinder: quads around, one polygon at each end.

use super::polygon_mesh::PolygonMesh;
use super::vector::{Point, turn};

const SIDES: u32 = 24;
const RADIUS: f64 = 0.5;
const HALF_HEIGHT: f64 = 0.5;

pub(crate) fn mesh() -> PolygonMesh {
    let mut mesh = PolygonMesh::default();
    for side in 0..SIDES {
        mesh.add(&[
            point(side, -HALF_HEIGHT),
            point(side + 1, -HALF_HEIGHT),
            point(side + 1, HALF_HEIGHT),
            point(side, HALF_HEIGHT),
        ]);
    }
    let top: Vec<Point> = (0..SIDES).map(|side| point(side, HALF_HEIGHT)).collect();
    let bottom: Vec<Point> = (0..SIDES).rev().map(|side| point(side, -HALF_HEIGHT)).collect();
    mesh.add(&top);
    mesh.add(&bottom);
    mesh
}

/// Counter-clockwise as seen from above.
fn point(side: u32, y: f64) -> Point {
    let (sine, cosine) = turn(side, SIDES);
    [RADIUS * cosine, y, -RADIUS * sine]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quads_around_and_two_ends() {
        let corners: Vec<usize> = mesh().faces().iter().map(|face| face.corners.len()).collect();
        assert_eq!(corners[..24], [4; 24]);
        assert_eq!(corners[24..], [24, 24]);
    }
}
