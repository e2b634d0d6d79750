//! Material ranges: triangles of the same material and group, with or without texture coordinates.
//!
//! Idea: triangles are in the order of their polygons, so a run of polygons is a range of
//! triangles, whose end is found by binary search. Every triangle is visited only if some corners
//! have texture coordinates.

use std::ops::Range;

use super::faces::FaceSources;
use crate::edge_mesh::FillRun;
use crate::index::{NONE, to_u32};
use crate::model::{Attributes, Model};

/// The material ranges of all triangles.
pub(crate) fn fill_runs(model: &Model, sources: &FaceSources) -> Vec<FillRun> {
    let mut runs = Vec::new();
    let mut attributes = Attributes::default();
    let mut start = 0;
    for run in &model.runs {
        let end = first_face_from(sources, run.first_polygon as usize);
        push_faces(&mut runs, model, sources, start..end, attributes);
        (start, attributes) = (end, run.attributes);
    }
    push_faces(&mut runs, model, sources, start..sources.len(), attributes);
    runs
}

/// The first face of `polygon` or of a later polygon.
fn first_face_from(sources: &FaceSources, polygon: usize) -> usize {
    let (mut start, mut end) = (0, sources.len());
    while start < end {
        let middle = start + (end - start) / 2;
        if sources.polygon(middle) < polygon {
            start = middle + 1;
        } else {
            end = middle;
        }
    }
    start
}

/// Adds faces with the same attributes.
fn push_faces(
    runs: &mut Vec<FillRun>,
    model: &Model,
    sources: &FaceSources,
    faces: Range<usize>,
    attributes: Attributes,
) {
    if faces.is_empty() {
        return;
    }
    let known = |index: u32, count: usize| if (index as usize) < count { index } else { NONE };
    let mut push = |face: usize, has_texcoords: bool| {
        let run = FillRun {
            first_triangle: to_u32(face),
            material: known(attributes.material, model.materials.len()),
            group: known(attributes.group, model.groups.len()),
            has_texcoords: has_texcoords.into(),
        };
        let start = |last: &FillRun| FillRun { first_triangle: last.first_triangle, ..run };
        if runs.last().is_none_or(|last| *last != start(last)) {
            runs.push(run);
        }
    };
    if model.corner_texcoords.is_empty() {
        push(faces.start, false);
        return;
    }
    for face in faces {
        let has_texcoord = |&corner: &u32| model.corner_texcoords[corner as usize] != NONE;
        push(face, sources.corners(face).iter().all(has_texcoord));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::{BuildOptions, build_edge_mesh};
    use crate::model::{Corner, Material, PolygonRun};
    use crate::report::Report;

    /// A square, and a point above it.
    const CORNERS: [[f32; 3]; 5] =
        [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.], [0., 0., 1.]];

    fn runs_of(model: &Model) -> Vec<[u32; 4]> {
        let mesh = build_edge_mesh(model, &BuildOptions::default(), &mut Report::default());
        assert_eq!(mesh.fill.materials, model.materials);
        assert_eq!(mesh.fill.groups, model.groups);
        mesh.fill.runs.into_iter().map(bytemuck::cast).collect()
    }

    fn attributes(material: u32, group: u32) -> Attributes {
        Attributes { material, group, ..Attributes::default() }
    }

    /// A model with two materials and two groups.
    fn named(positions: &[[f32; 3]]) -> Model {
        let mut model = Model::from_polygons(positions, &[]);
        model.materials = vec![Material::default(); 2];
        model.groups = vec!["a".into(), "b".into()];
        model
    }

    #[test]
    fn a_model_without_attributes_is_one_run() {
        let model = Model::from_polygons(&CORNERS, &[&[0, 1, 2], &[0, 2, 3]]);
        assert_eq!(runs_of(&model), [[0, NONE, NONE, 0]]);
        assert!(runs_of(&Model::from_polygons(&CORNERS, &[])).is_empty());
        let options = BuildOptions { with_fill: false, ..BuildOptions::default() };
        let mesh = build_edge_mesh(&named(&CORNERS), &options, &mut Report::default());
        assert_eq!(mesh.fill, crate::edge_mesh::FillMesh::default(), "nobody asked for it");
    }

    #[test]
    fn runs_of_polygons_become_runs_of_triangles() {
        let mut model = named(&CORNERS);
        let mut add = |attributes, corners: &[u32]| {
            let corners: Vec<Corner> = corners.iter().copied().map(Corner::at).collect();
            model.set_attributes(attributes);
            model.push_polygon(&corners, 0);
        };
        add(Attributes::default(), &[1, 0, 4]);
        add(attributes(1, 0), &[0, 1, 2, 3]);
        add(attributes(1, 0), &[1, 1, 2]);
        add(attributes(1, 1), &[2, 1, 4]);
        add(attributes(0, 1), &[1, 1, 2]);
        add(attributes(1, 1), &[0, 3, 4]);
        // The flat triangles are gone, and with one of them a run between two
        // that are alike.
        assert_eq!(runs_of(&model), [[0, NONE, NONE, 0], [1, 1, 0, 0], [3, 1, 1, 0]]);
    }

    #[test]
    fn triangles_with_texture_coordinates_are_runs_of_their_own() {
        let mut model = named(&CORNERS);
        model.texcoords = vec![[0.5; 2]];
        model.set_attributes(attributes(0, NONE));
        let all = |corners: [u32; 3], texcoord| {
            corners.map(|corner| Corner { texcoord, ..Corner::at(corner) })
        };
        model.push_polygon(&all([0, 1, 2], 0), 0);
        model.push_polygon(&all([0, 2, 3], 0), 0);
        let mut partly = all([1, 3, 0], 0);
        partly[2].texcoord = NONE;
        model.push_polygon(&partly, 0);
        model.push_polygon(&all([2, 1, 3], NONE), 0);
        assert_eq!(runs_of(&model), [[0, 0, NONE, 1], [2, 0, NONE, 0]]);
    }

    #[test]
    fn names_that_are_not_there_are_none() {
        let mut model = named(&CORNERS);
        model.runs = vec![PolygonRun { first_polygon: 0, attributes: attributes(2, NONE - 1) }];
        model.push_polygon(&[0, 1, 2].map(Corner::at), 0);
        assert_eq!(runs_of(&model), [[0, NONE, NONE, 0]]);
    }
}
