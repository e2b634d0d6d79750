//! The mesh frame, the counts and placements, as numbers of sections.

use glam::{DMat4, DVec3};

use crate::edge_mesh::{EdgeCounts, MeshCounts, MeshFrame, SourceCounts};

/// The origin and the scale of a frame.
pub(super) fn of_frame(frame: &MeshFrame) -> [f64; 4] {
    let [x, y, z] = frame.origin.to_array();
    [x, y, z, frame.scale]
}

pub(super) const fn to_frame([x, y, z, scale]: [f64; 4]) -> MeshFrame {
    MeshFrame { origin: DVec3::new(x, y, z), scale }
}

/// A placement: the four columns of an affine transform.
pub(super) type Placement = [f64; 12];

/// The numbers of a placement.
pub(super) fn of_transform(place: &DMat4) -> Placement {
    let columns = [place.x_axis, place.y_axis, place.z_axis, place.w_axis];
    let mut numbers = [0.0; 12];
    for (three, column) in numbers.as_chunks_mut().0.iter_mut().zip(columns) {
        *three = column.truncate().to_array();
    }
    numbers
}

/// The transform of a placement.
pub(super) fn to_transform(numbers: &Placement) -> DMat4 {
    let [x, y, z, place] = [0, 3, 6, 9].map(|at| DVec3::from_slice(&numbers[at..at + 3]));
    DMat4::from_cols(x.extend(0.0), y.extend(0.0), z.extend(0.0), place.extend(1.0))
}

/// The counts in the order of the file.
pub(super) const fn of_counts(counts: &MeshCounts) -> [u64; 18] {
    let MeshCounts { edges, source, .. } = counts;
    [
        counts.vertices as u64,
        counts.welded_vertices as u64,
        counts.triangles as u64,
        counts.degenerate_triangles as u64,
        counts.duplicate_triangles as u64,
        edges.edges as u64,
        edges.boundary as u64,
        edges.non_manifold as u64,
        edges.inconsistent as u64,
        counts.diagonal_edges as u64,
        counts.components as u64,
        source.vertices as u64,
        source.polygons as u64,
        source.triangles as u64,
        source.edges.edges as u64,
        source.edges.boundary as u64,
        source.edges.non_manifold as u64,
        source.edges.inconsistent as u64,
    ]
}

/// The counts of a file. A count that does not fit into the address space becomes the
/// largest possible, which `check` refuses.
pub(super) fn to_counts(numbers: [u64; 18]) -> MeshCounts {
    let numbers = numbers.map(|number| usize::try_from(number).unwrap_or(usize::MAX));
    let edges = |[edges, boundary, non_manifold, inconsistent]: [usize; 4]| EdgeCounts {
        edges,
        boundary,
        non_manifold,
        inconsistent,
    };
    #[rustfmt::skip]
    let [
        vertices, welded_vertices, triangles, degenerate_triangles, duplicate_triangles,
        all, boundary, non_manifold, inconsistent, diagonal_edges, components,
        listed, polygons, fans, of_polygons @ ..,
    ] = numbers;
    MeshCounts {
        vertices,
        welded_vertices,
        triangles,
        degenerate_triangles,
        duplicate_triangles,
        edges: edges([all, boundary, non_manifold, inconsistent]),
        diagonal_edges,
        components,
        source: SourceCounts {
            vertices: listed,
            polygons,
            triangles: fans,
            edges: edges(of_polygons),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_count_is_read_back() {
        let numbers: [u64; 18] = std::array::from_fn(|index| index as u64 + 1);
        let counts = to_counts(numbers);
        assert_eq!(of_counts(&counts), numbers);
        assert_eq!((counts.vertices, counts.edges.boundary, counts.components), (1, 7, 11));
        assert_eq!((counts.source.vertices, counts.source.edges.inconsistent), (12, 18));
    }

    #[test]
    fn a_frame_is_an_origin_and_a_scale() {
        let frame = to_frame([1.0, 2.0, 3.0, 0.5]);
        assert_eq!(frame.to_mesh(DVec3::new(3.0, 2.0, 3.0)).x, 1.0);
        assert_eq!(of_frame(&frame), [1.0, 2.0, 3.0, 0.5]);
    }
}
