//! `ElevationGrid` (VRML 97 6.17): quads over the plane of x and z.
//!
//! ```text
//! O--- x    heights row by row     a---d    faces a b c d,
//! |         point = x + z columns  |   |    seen from above
//! z                                b---c
//! ```

use super::solids::Surface;
use crate::format::read::vrml::parse::{NodeRef, whole};
use crate::model::Smoothing;

/// The grid of a node.
///
/// # Errors
/// Fails if there are too few heights; the message is a whole sentence.
pub(super) fn elevation_grid(node: NodeRef, smoothing: Smoothing) -> Result<Surface, String> {
    let heights = node.numbers("height").values;
    let [columns, rows] = ["xDimension", "zDimension"].map(|field| node.number(field, 0.0));
    let (Some(columns), Some(rows)) = (whole(columns), whole(rows)) else {
        return Err(format!("a grid of {columns} x {rows} was left out"));
    };
    if columns.saturating_mul(rows) > heights.len() {
        let found = heights.len();
        return Err(format!("a grid of {columns} x {rows} with {found} heights was left out"));
    }
    let spacing = ["xSpacing", "zSpacing"].map(|field| node.number(field, 1.0));
    Ok(quads(heights, [columns, rows], spacing, smoothing))
}

#[expect(clippy::cast_precision_loss, reason = "no more rows than heights")]
fn quads(
    heights: &[f64],
    [columns, rows]: [usize; 2],
    [dx, dz]: [f64; 2],
    smoothing: Smoothing,
) -> Surface {
    let mut surface = Surface::new(smoothing);
    if columns < 2 || rows < 2 {
        return surface;
    }
    for (point, &height) in heights.iter().enumerate().take(columns * rows) {
        let (x, z) = (point % columns, point / columns);
        surface.point([dx * x as f64, height, dz * z as f64]);
    }
    for z in 1..rows {
        for x in 1..columns {
            let c = x + z * columns;
            let d = c - columns;
            surface.face([d - 1, c - 1, c, d]);
        }
    }
    surface
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grid_consists_of_quads_that_face_up() {
        let grid = quads(&[0., 1., 2., 3., 4., 5.], [3, 2], [2.0, 3.0], Smoothing::Unstated);
        assert_eq!(grid.points[6..12], [4., 2., 0., 0., 3., 3.]);
        assert_eq!(grid.indices, [0., 3., 4., 1., -1., 1., 4., 5., 2., -1.]);
        assert!(quads(&[], [0, 0], [1.0; 2], Smoothing::Unstated).indices.is_empty());
        assert!(quads(&[1.0; 3], [3, 1], [1.0; 2], Smoothing::Unstated).indices.is_empty());
    }
}
