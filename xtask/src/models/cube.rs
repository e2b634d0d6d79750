//! A cube of six quads, one unit wide.

use super::polygon_mesh::PolygonMesh;
use super::vector::{Point, scale};

pub(crate) fn mesh() -> PolygonMesh {
    let mut mesh = PolygonMesh::default();
    for quad in cube_grid(1) {
        mesh.add(&quad.map(|corner| scale(corner, 0.5)));
    }
    mesh
}

/// The surface of the cube from -1 to 1, with `cells` x `cells` quads a side.
pub(crate) fn cube_grid(cells: u32) -> Vec<[Point; 4]> {
    let mut quads = Vec::new();
    for (axis, sign) in [(0, 1.0), (1, 1.0), (2, 1.0), (0, -1.0), (1, -1.0), (2, -1.0)] {
        for column in 0..cells {
            for row in 0..cells {
                let cell = [(0, 0), (1, 0), (1, 1), (0, 1)];
                quads.push(
                    cell.map(|(right, up)| {
                        grid_point(axis, sign, [column + right, row + up], cells)
                    }),
                );
            }
        }
    }
    quads
}

/// The axes of a side follow its own in turn (y and z on the x side), so that columns and
/// rows run counter-clockwise; on the opposite side the columns run backward.
fn grid_point(axis: usize, sign: f64, [column, row]: [u32; 2], cells: u32) -> Point {
    let along = |step: u32| (2.0 * f64::from(step) - f64::from(cells)) / f64::from(cells);
    let mut point = [0.0; 3];
    point[axis] = sign;
    point[(axis + 1) % 3] = sign * along(column);
    point[(axis + 2) % 3] = along(row);
    point
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn six_quads_of_eight_points() {
        let cube = mesh();
        assert_eq!((cube.faces().len(), cube.point_count()), (6, 8));
        assert_eq!(cube.bounds(), ([-0.5; 3], [0.5; 3]));
        assert!((cube.signed_volume() - 1.0).abs() < 1e-9, "{}", cube.signed_volume());
    }
}
