//! Ranges of triangles of one material.

use std::ops::Range;

use crate::edge_mesh::{EdgeMesh, FillRun};

/// The ranges of all triangles with their attributes; one without any if the mesh has no fill.
pub(super) fn face_runs(mesh: &EdgeMesh) -> impl Iterator<Item = (Range<usize>, FillRun)> {
    let plain = mesh.fill.runs.is_empty().then_some(FillRun::PLAIN);
    let runs = mesh.fill.runs.iter().copied().chain(plain);
    let starts = mesh.fill.runs.iter().map(|run| run.first_triangle as usize).skip(1);
    let ends = starts.chain([mesh.triangles.len()]);
    runs.zip(ends).map(|(run, end)| (run.first_triangle as usize..end, run))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_end_where_the_next_begins() {
        let mut mesh = EdgeMesh { triangles: vec![[0; 3]; 5], ..EdgeMesh::default() };
        let ranges = |mesh: &EdgeMesh| face_runs(mesh).map(|(range, _)| range).collect::<Vec<_>>();
        assert_eq!(ranges(&mesh), vec![0..5; 1]);
        mesh.fill.runs = vec![FillRun::PLAIN, FillRun { first_triangle: 3, ..FillRun::PLAIN }];
        assert_eq!(ranges(&mesh), [0..3, 3..5]);
    }
}
