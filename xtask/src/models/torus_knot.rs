//! A tube along the (2, 3) torus knot: twice around the torus, three times
//! through its hole. Every view of it has contours that hide each other.

use super::polygon_mesh::PolygonMesh;
use super::vector::{Point, add, cross, scale, turn, unit};

const RINGS: u32 = 160;
const SIDES: u32 = 16;

/// The torus: distance of its core from the axis, and of the knot from its core.
const CORE_RADIUS: f64 = 0.62;
const KNOT_RADIUS: f64 = 0.26;
const TUBE_RADIUS: f64 = 0.12;

const AROUND_AXIS: u32 = 2;
const THROUGH_HOLE: u32 = 3;

pub(crate) fn mesh() -> PolygonMesh {
    let mut mesh = PolygonMesh::default();
    for ring in 0..RINGS {
        for side in 0..SIDES {
            mesh.add(&[
                point(ring, side),
                point(ring, side + 1),
                point(ring + 1, side + 1),
                point(ring + 1, side),
            ]);
        }
    }
    mesh
}

/// A point of the tube. The ring is normal to the knot and oriented by the normal of the
/// torus, which closes without a twist.
fn point(ring: u32, side: u32) -> Point {
    let (axis_sine, axis_cosine) = turn(AROUND_AXIS * ring, RINGS);
    let (hole_sine, hole_cosine) = turn(THROUGH_HOLE * ring, RINGS);
    let outward = [axis_cosine, 0.0, -axis_sine];
    let forward = [-axis_sine, 0.0, -axis_cosine];
    let normal = add(scale(outward, hole_cosine), [0.0, hole_sine, 0.0]);
    let knot = add(scale(outward, CORE_RADIUS), scale(normal, KNOT_RADIUS));

    let around = f64::from(AROUND_AXIS) * (CORE_RADIUS + KNOT_RADIUS * hole_cosine);
    let through = f64::from(THROUGH_HOLE) * KNOT_RADIUS;
    let rising = add(scale(outward, -hole_sine), [0.0, hole_cosine, 0.0]);
    let tangent = unit(add(scale(forward, around), scale(rising, through)));

    let (sine, cosine) = turn(side, SIDES);
    let across = cross(tangent, normal);
    let spoke = add(scale(normal, cosine), scale(across, sine));
    add(knot, scale(spoke, TUBE_RADIUS))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_ring_of_quads() {
        let knot = mesh();
        assert_eq!(knot.faces().len(), 160 * 16);
        assert_eq!(knot.point_count(), 160 * 16);
    }
}
