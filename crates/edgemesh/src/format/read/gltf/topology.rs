//! Turns a list of corners into triangles or segments.
//!
//! Based on: glTF 2.0, section 3.7.2.1 (topology types).
//!
//! ```text
//! strip 0---2---4     triangles (0 1 2) (1 3 2) (2 3 4): every second one is
//!        \ / \ /      reversed, so that all have one winding
//!         1---3
//! ```

use gltf_json::mesh::Mode;

/// The shapes of a primitive, as indices of its vertices.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Shapes {
    /// From a list, strip or fan.
    Triangles(Vec<[u32; 3]>),
    /// From a list, strip or loop.
    Segments(Vec<[u32; 2]>),
    /// Points, which are not drawn.
    Points,
}

/// The shapes of `corners`, and the number of corners left over at the end.
pub(super) fn shapes(mode: Mode, corners: &[u32]) -> (Shapes, usize) {
    match mode {
        Mode::Points => (Shapes::Points, 0),
        Mode::Lines => {
            let (pairs, rest) = corners.as_chunks();
            (Shapes::Segments(pairs.to_vec()), rest.len())
        }
        Mode::LineStrip => (Shapes::Segments(polyline(corners)), left_over(corners, 2)),
        Mode::LineLoop => {
            let mut segments = polyline(corners);
            if let ([first, _, ..], Some(last)) = (corners, corners.last()) {
                segments.push([*last, *first]);
            }
            (Shapes::Segments(segments), left_over(corners, 2))
        }
        Mode::Triangles => {
            let (triples, rest) = corners.as_chunks();
            (Shapes::Triangles(triples.to_vec()), rest.len())
        }
        Mode::TriangleStrip => {
            let reversed_if_odd = |(at, &[a, b, c]): (usize, &[u32; 3])| {
                if at % 2 == 0 { [a, b, c] } else { [a, c, b] }
            };
            let triangles = corners.array_windows().enumerate().map(reversed_if_odd).collect();
            (Shapes::Triangles(triangles), left_over(corners, 3))
        }
        Mode::TriangleFan => {
            // The center comes last, by the specification.
            let triangles = match corners {
                [center, rim @ ..] => rim.array_windows().map(|&[a, b]| [a, b, *center]).collect(),
                [] => Vec::new(),
            };
            (Shapes::Triangles(triangles), left_over(corners, 3))
        }
    }
}

/// The segments from each corner to the next.
pub(super) fn polyline(corners: &[u32]) -> Vec<[u32; 2]> {
    corners.array_windows().copied().collect()
}

/// The number of corners if they are too few for a shape, else 0.
const fn left_over(corners: &[u32], least: usize) -> usize {
    if corners.len() < least { corners.len() } else { 0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_have_the_specified_winding() {
        let triangles = |mode, corners: &[u32]| match shapes(mode, corners) {
            (Shapes::Triangles(triangles), rest) => (triangles, rest),
            (other, _) => panic!("{other:?}"),
        };
        assert_eq!(triangles(Mode::Triangles, &[0, 1, 2, 2, 1, 3, 9]).0, [[0, 1, 2], [2, 1, 3]]);
        assert_eq!(triangles(Mode::Triangles, &[0, 1, 2, 3]).1, 1);
        let strip = triangles(Mode::TriangleStrip, &[0, 1, 2, 3, 4]);
        assert_eq!(strip, (vec![[0, 1, 2], [1, 3, 2], [2, 3, 4]], 0));
        assert_eq!(triangles(Mode::TriangleFan, &[0, 1, 2, 3]).0, [[1, 2, 0], [2, 3, 0]]);
        assert_eq!(triangles(Mode::TriangleFan, &[0, 1]), (vec![], 2));
        assert_eq!(triangles(Mode::TriangleStrip, &[]), (vec![], 0));
    }

    #[test]
    fn lines_are_segments() {
        let segments = |mode, corners: &[u32]| match shapes(mode, corners) {
            (Shapes::Segments(segments), rest) => (segments, rest),
            (other, _) => panic!("{other:?}"),
        };
        assert_eq!(segments(Mode::Lines, &[0, 1, 2, 3, 4]), (vec![[0, 1], [2, 3]], 1));
        assert_eq!(segments(Mode::LineStrip, &[0, 1, 2]), (vec![[0, 1], [1, 2]], 0));
        assert_eq!(segments(Mode::LineLoop, &[0, 1, 2]).0, [[0, 1], [1, 2], [2, 0]]);
        assert_eq!(segments(Mode::LineLoop, &[5]), (vec![], 1));
        assert_eq!(shapes(Mode::Points, &[1, 2]), (Shapes::Points, 0));
    }
}
