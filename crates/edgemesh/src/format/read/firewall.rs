//! Checks the model that any reader returns: indices in range, finite numbers, at least three
//! corners a polygon, counts within the limits. Readers may check more, and earlier.

use std::iter;

use super::error::{ReadError, ReadErrorKind};
use super::source::Source;
use crate::index::{MAX_INDEX, NONE, to_u32};
use crate::model::{Material, Model};
use crate::report::{Place, Report, WarningCode};

/// Larger coordinates count as infinite: the size of a box around them would be.
pub(crate) const LARGEST_COORDINATE: f64 = 1e300;

/// Checks `model` and drops what is unusable, with warnings.
///
/// A corner with a wrong texture coordinate or normal loses only that, a material with a
/// number that is not finite only this number. A polygon is dropped if one of its vertices
/// is not finite; `warned_of_vertices` is set if the reader has already warned of those. A
/// model that loses all its faces here is returned empty, if it has a finite vertex. An instanced
/// mesh without faces and lines is dropped.
///
/// # Errors
/// Fails if a face or line names a vertex that does not exist, if there are more
/// than [`MAX_INDEX`] elements, if the file has no face and no line at all, and if no
/// vertex is finite.
pub(crate) fn check(
    source: &Source,
    model: &mut Model,
    report: &mut Report,
    warned_of_vertices: bool,
) -> Result<(), ReadError> {
    let mut instanced = std::mem::take(&mut model.instanced);
    let own = iter::once(&mut *model);
    let mut parts: Vec<&mut Model> =
        own.chain(instanced.iter_mut().map(|instanced| &mut instanced.model)).collect();
    for part in &parts {
        check_counts(source, part)?;
        check_positions(source, part)?;
    }
    check_is_drawn(source, &parts, report)?;
    for part in &mut parts {
        drop_wrong_attributes(part, report);
    }
    let is_finite: Vec<Vec<bool>> = parts.iter().map(|part| finite_vertices(part)).collect();
    check_is_finite(source, &parts, &is_finite)?;
    for (part, is_finite) in parts.into_iter().zip(&is_finite) {
        if !warned_of_vertices {
            warn_of_vertices(is_finite, report);
        }
        drop_what_is_not_finite(part, is_finite, report);
    }
    instanced.retain(|instanced| !has_nothing(&instanced.model));
    model.instanced = instanced;
    Ok(())
}

/// Whether a model has neither faces nor lines.
const fn has_nothing(model: &Model) -> bool {
    model.polygon_count() == 0 && model.segments.is_empty()
}

fn check_counts(source: &Source, model: &Model) -> Result<(), ReadError> {
    let counts = [model.positions.len(), model.corner_positions.len(), model.segments.len()];
    match counts.into_iter().find(|&count| count > MAX_INDEX) {
        None => Ok(()),
        Some(count) => {
            let what = format!("too large: {count} vertices or corners; the limit is {MAX_INDEX}");
            Err(source.error(ReadErrorKind::Size, None, what))
        }
    }
}

/// Checks that the parts of a model have a face or a line, or are empty for a reason.
fn check_is_drawn(source: &Source, parts: &[&mut Model], report: &Report) -> Result<(), ReadError> {
    let is_meant = |part: &Model| !has_nothing(part) || part.has_invisible_parts;
    if parts.iter().any(|part| is_meant(part)) || report.count(WarningCode::Degenerate) > 0 {
        return Ok(());
    }
    let what = match parts.iter().map(|part| part.positions.len()).sum() {
        0_usize => "no vertices and no faces: nothing to draw".into(),
        count => format!("{count} vertices but no faces and no lines: nothing to draw"),
    };
    Err(source.error(ReadErrorKind::Empty, None, what))
}

/// Checks that the parts of a model have a finite vertex, given those of each (see
/// [`finite_vertices`]).
fn check_is_finite(
    source: &Source,
    parts: &[&mut Model],
    is_finite: &[Vec<bool>],
) -> Result<(), ReadError> {
    let has_any = |(part, is_finite): (&&mut Model, &Vec<bool>)| match is_finite.is_empty() {
        true => !part.positions.is_empty(),
        false => is_finite.contains(&true),
    };
    let count: usize = parts.iter().map(|part| part.positions.len()).sum();
    if count == 0 || parts.iter().zip(is_finite).any(has_any) {
        return Ok(());
    }
    let what = format!(
        "none of the {count} vertices is finite, so nothing can be drawn; export the model again"
    );
    Err(source.error(ReadErrorKind::Number, Some(Place::Vertex(1)), what))
}

fn drop_what_is_not_finite(model: &mut Model, is_finite: &[bool], report: &mut Report) {
    clear_attributes_not_finite(model, report);
    clear_colors_not_finite(&mut model.materials, report);
    drop_polygons(model, is_finite, report);
    model.segments.retain(|segment| {
        let [a, b] = segment.ends.map(|end| end as usize);
        a != b && (is_finite.is_empty() || is_finite[a] && is_finite[b])
    });
}

fn check_positions(source: &Source, model: &Model) -> Result<(), ReadError> {
    let count = model.positions.len();
    let is_wrong = |&position: &u32| position as usize >= count;
    if let Some(corner) = model.corner_positions.iter().position(is_wrong) {
        let polygon = model.polygon_of(corner);
        let index = model.corner_positions[corner];
        let what = format!("a face names vertex {index} (counted from 0) of {count}");
        return Err(source.error(ReadErrorKind::Index, Some(model.polygon_place(polygon)), what));
    }
    match model.segments.iter().find(|segment| segment.ends.iter().any(is_wrong)) {
        Some(segment) => {
            let place = Some(segment.line).filter(|&line| line > 0).map(Place::Line);
            let what = format!("a line names a vertex past the last of {count}");
            Err(source.error(ReadErrorKind::Index, place, what))
        }
        None => Ok(()),
    }
}

/// Sets indices of texture coordinates, normals and colors that are out of range to [`NONE`];
/// colors that are neither those of corners nor of all positions are left out.
fn drop_wrong_attributes(model: &mut Model, report: &mut Report) {
    if model.corner_colors.is_empty() && model.colors.len() != model.positions.len() {
        model.colors.clear();
    }
    let counts = [model.texcoords.len(), model.normals.len(), model.colors.len()];
    let lists = [&mut model.corner_texcoords, &mut model.corner_normals, &mut model.corner_colors];
    for (list, count) in lists.into_iter().zip(counts) {
        for index in list.iter_mut().filter(|index| **index != NONE && **index as usize >= count) {
            report.warn(WarningCode::Index, None, || {
                format!("attribute {index} of {count} was left out; the face is kept")
            });
            *index = NONE;
        }
    }
}

/// Sets normals, texture coordinates and colors that are not finite to 0; the builder
/// replaces a normal of 0.
fn clear_attributes_not_finite(model: &mut Model, report: &mut Report) {
    clear("normal", &mut model.normals, report);
    clear("texture coordinate", &mut model.texcoords, report);
    clear("color", &mut model.colors, report);
}

fn clear<const N: usize>(name: &str, list: &mut [[f32; N]], report: &mut Report) {
    let is_finite = |element: &[f32; N]| element.iter().all(|number| number.is_finite());
    for (at, element) in list.iter_mut().enumerate().filter(|(_, element)| !is_finite(element)) {
        report.warn(WarningCode::NonFinite, None, || {
            format!("{name} {} of the file is not finite; it was set to 0", at + 1)
        });
        *element = [0.0; N];
    }
}

/// Removes the numbers of materials that are not finite.
fn clear_colors_not_finite(materials: &mut [Material], report: &mut Report) {
    for material in materials {
        let Material { name, ambient, diffuse, specular, shininess, opacity, .. } = material;
        let mut count = 0;
        for color in [ambient, diffuse, specular] {
            count +=
                usize::from(color.take_if(|color| !color.iter().all(|x| x.is_finite())).is_some());
        }
        for number in [shininess, opacity] {
            count += usize::from(number.take_if(|number| !number.is_finite()).is_some());
        }
        report.warn_many(WarningCode::NonFinite, count, None, || {
            format!("a number of the material '{name}' is not finite; it was left out")
        });
    }
}

/// Whether each vertex is finite; empty if all are.
fn finite_vertices(model: &Model) -> Vec<bool> {
    // False for NaN.
    let is_finite = |point: &[f64; 3]| point.iter().all(|x| x.abs() <= LARGEST_COORDINATE);
    if model.positions.iter().all(is_finite) {
        return Vec::new();
    }
    model.positions.iter().map(is_finite).collect()
}

fn warn_of_vertices(is_finite: &[bool], report: &mut Report) {
    for vertex in (0..is_finite.len()).filter(|&vertex| !is_finite[vertex]) {
        report.warn(WarningCode::NonFinite, Some(Place::Vertex(vertex as u64 + 1)), || {
            "a vertex is not finite; faces that use it were dropped".into()
        });
    }
}

/// Drops polygons with fewer than three corners, and those with a vertex that is
/// not finite.
fn drop_polygons(model: &mut Model, is_finite: &[bool], report: &mut Report) {
    let too_small = |model: &Model, polygon: usize| model.corner_range(polygon).len() < 3;
    let uses_wrong = |model: &Model, polygon: usize| {
        !is_finite.is_empty()
            && model
                .corner_range(polygon)
                .any(|corner| !is_finite[model.corner_positions[corner] as usize])
    };
    if is_finite.is_empty() && model.is_triangles() {
        return;
    }
    let is_kept: Vec<bool> = (0..model.polygon_count())
        .map(|polygon| {
            if too_small(model, polygon) {
                let count = model.corner_range(polygon).len();
                let place = Some(model.polygon_place(polygon));
                report.warn(WarningCode::Degenerate, place, || {
                    format!("a face needs three corners, this one has {count}; it was dropped")
                });
                return false;
            }
            !uses_wrong(model, polygon)
        })
        .collect();
    if is_kept.iter().all(|&kept| kept) {
        return;
    }
    keep_polygons(model, &is_kept);
}

/// Removes all polygons that `is_kept` is false for.
fn keep_polygons(model: &mut Model, is_kept: &[bool]) {
    let ranges: Vec<_> = (0..model.polygon_count())
        .filter(|&polygon| is_kept[polygon])
        .map(|polygon| model.corner_range(polygon))
        .collect();
    let pick = |list: &[u32]| -> Vec<u32> {
        if list.is_empty() {
            return Vec::new();
        }
        ranges.iter().flat_map(|range| list[range.clone()].iter().copied()).collect()
    };
    let corner_positions = pick(&model.corner_positions);
    model.corner_texcoords = pick(&model.corner_texcoords);
    model.corner_normals = pick(&model.corner_normals);
    model.corner_colors = pick(&model.corner_colors);
    model.corner_positions = corner_positions;
    let mut end = 0;
    model.polygon_ends = ranges
        .iter()
        .map(|range| {
            end += to_u32(range.len());
            end
        })
        .collect();
    if ranges.iter().all(|range| range.len() == 3) {
        model.polygon_ends.clear();
    }
    let mut kept = is_kept.iter();
    model.polygon_lines.retain(|_| kept.next() == Some(&true));
    let mut kept_before = Vec::with_capacity(is_kept.len() + 1);
    let mut count = 0;
    for &kept in is_kept {
        kept_before.push(count);
        count += u32::from(kept);
    }
    kept_before.push(count);
    for run in &mut model.runs {
        run.first_polygon = kept_before[run.first_polygon as usize];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Attributes, Corner, InstancedModel, PolygonRun, Segment};

    const SOURCE: Source = Source { name: "test", folder: None, bytes: b"" };

    fn square() -> Model {
        let corners = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
        Model::from_polygons(&corners, &[&[0, 1, 2], &[0, 1, 2, 3]])
    }

    #[test]
    fn corners_past_the_last_vertex_are_errors_with_their_face() {
        let mut model = square();
        model.push_polygon(&[0, 1, 4].map(Corner::at), 0);
        let error = check(&SOURCE, &mut model, &mut Report::default(), false).unwrap_err();
        assert_eq!((error.kind, error.place), (ReadErrorKind::Index, Some(Place::Face(3))));
        let mut model = square();
        model.segments.push(Segment { ends: [0, 9], line: 12 });
        let error = check(&SOURCE, &mut model, &mut Report::default(), false).unwrap_err();
        assert_eq!(error.place, Some(Place::Line(12)));
    }

    #[test]
    fn faces_with_a_vertex_that_is_not_finite_are_dropped() {
        let mut model = square();
        model.positions[3][1] = f64::NAN;
        let attributes = Attributes { material: 1, ..Attributes::default() };
        model.set_attributes(attributes);
        model.push_polygon(&[0, 1, 2].map(Corner::at), 0);
        model.segments.push(Segment { ends: [0, 3], line: 0 });
        let mut report = Report::default();
        check(&SOURCE, &mut model, &mut report, false).unwrap();
        assert_eq!((model.polygon_count(), model.is_triangles()), (2, true));
        assert_eq!(model.runs, [PolygonRun { first_polygon: 1, attributes }]);
        assert!(model.segments.is_empty());
        assert_eq!(report.warnings()[0].place, Some(Place::Vertex(4)));
    }

    #[test]
    fn wrong_attributes_are_left_out_and_the_face_is_kept() {
        let mut model = square();
        model.texcoords = vec![[0.0; 2]; 2];
        model.colors = vec![[0.5; 4]];
        let corner = |k| Corner { position: k, texcoord: k, normal: 5, color: k };
        model.push_polygon(&[0, 1, 2].map(corner), 0);
        let mut report = Report::default();
        check(&SOURCE, &mut model, &mut report, false).unwrap();
        assert_eq!(model.corner_texcoords[7..], [0, 1, NONE]);
        assert_eq!(model.corner_colors[7..], [0, NONE, NONE]);
        assert_eq!(report.count(WarningCode::Index), 6);
    }

    /// Instanced meshes are checked as the model is, and count as its faces.
    #[test]
    fn instanced_meshes_are_checked() {
        let instanced = |model| InstancedModel { model, placements: Vec::new() };
        let check = |mut model: Model| {
            let mut report = Report::default();
            check(&SOURCE, &mut model, &mut report, false).map(|()| (model, report))
        };
        let mut wrong = square();
        wrong.corner_positions[1] = 77;
        let model = Model { instanced: vec![instanced(wrong)], ..square() };
        assert_eq!(check(model).unwrap_err().kind, ReadErrorKind::Index);
        let mut torn = square();
        torn.positions[3][1] = f64::NAN;
        let bare = Model { polygon_ends: vec![], corner_positions: vec![], ..square() };
        let model = Model { instanced: vec![instanced(torn), instanced(bare)], ..Model::default() };
        let (model, report) = check(model).unwrap();
        let [only] = &model.instanced[..] else { panic!("{model:?}") };
        assert_eq!((only.model.polygon_count(), report.count(WarningCode::NonFinite)), (1, 1));
        let lost = Model { positions: vec![[f64::NAN; 3]; 4], ..square() };
        let model = Model { instanced: vec![instanced(lost.clone())], ..square() };
        assert_eq!(check(model).unwrap().0.instanced.len(), 0, "the rest is drawn");
        let model = Model { instanced: vec![instanced(lost.clone())], ..lost };
        let error = check(model).unwrap_err();
        assert!(error.what.starts_with("none of the 8 vertices is finite"), "{error}");
    }

    #[test]
    fn a_file_without_faces_is_an_error_and_a_model_that_loses_all_is_not() {
        let mut report = Report::default();
        let mut model = Model::from_polygons(&[[0.0; 3]; 3], &[]);
        let error = check(&SOURCE, &mut model, &mut report, false).unwrap_err();
        assert_eq!(error.kind, ReadErrorKind::Empty);
        let corners = [[0.0; 3], [f32::NAN; 3], [f32::INFINITY, 0.0, 0.0]];
        let mut model = Model::from_polygons(&corners, &[&[0, 1, 2]]);
        check(&SOURCE, &mut model, &mut report, false).unwrap();
        assert_eq!((model.polygon_count(), report.count(WarningCode::NonFinite)), (0, 2));
    }

    #[test]
    fn a_model_without_a_finite_vertex_is_an_error() {
        let mut model = Model::from_polygons(&[[f32::NAN; 3]; 3], &[&[0, 1, 2]]);
        let error = check(&SOURCE, &mut model, &mut Report::default(), false).unwrap_err();
        assert_eq!((error.kind, error.place), (ReadErrorKind::Number, Some(Place::Vertex(1))));
        assert!(error.what.contains("none of the 3 vertices is finite"), "{}", error.what);
    }

    #[test]
    fn attributes_and_materials_lose_numbers_that_are_not_finite() {
        let mut model = square();
        model.normals = vec![[0.0, f32::NAN, 1.0], [0.0, 0.0, 1.0]];
        model.texcoords = vec![[f32::INFINITY, 0.0]];
        model.colors = vec![[1.0; 4], [f32::NEG_INFINITY; 4], [0.5; 4], [0.25; 4]];
        model.materials = vec![
            Material { shininess: Some(8.0), ..Material::default() },
            Material {
                name: "steel".into(),
                diffuse: Some([0.5, f32::NAN, 0.5]),
                specular: Some([0.5; 3]),
                opacity: Some(f32::INFINITY),
                ..Material::default()
            },
        ];
        let mut report = Report::default();
        check(&SOURCE, &mut model, &mut report, false).unwrap();
        assert_eq!(model.normals, [[0.0; 3], [0.0, 0.0, 1.0]]);
        assert_eq!(model.texcoords, [[0.0; 2]]);
        assert_eq!(model.colors, [[1.0; 4], [0.0; 4], [0.5; 4], [0.25; 4]]);
        let [sound, steel] = &model.materials[..] else { panic!("{:?}", model.materials) };
        assert_eq!(sound.shininess, Some(8.0));
        assert_eq!((steel.diffuse, steel.specular, steel.opacity), (None, Some([0.5; 3]), None));
        assert_eq!(report.count(WarningCode::NonFinite), 5);
        assert_eq!(model.polygon_count(), 2, "the faces are kept");
    }
}
