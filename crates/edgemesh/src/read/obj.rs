//! OBJ through `tobj`, behind the screen of `obj_screen`.

use std::path::Path;

use rustc_hash::FxHashMap;

use super::ReadError;
use super::mtl::{library_names, read_library};
use super::obj_screen::{Screened, screen_obj};
use crate::index::{NONE, to_u32};
use crate::model::{Corner, Material, Model, Polygon};
use crate::report::{Report, WarningCode};

/// A model that lies further from the origin than this many times its own size
/// loses more than a thousandth of its size to rounding in 32 bits.
const FAR_FROM_ORIGIN: f64 = 8192.0;

/// Reads the OBJ text `bytes`, which came from `path`.
pub(super) fn read_obj(path: &Path, bytes: &[u8]) -> Result<(Model, Report), ReadError> {
    let mut report = Report::default();
    let screened = screen_obj(path, bytes, &mut report)?;
    let mesh = parse(path, &screened.text)?;
    warn_if_far(&screened, &mut report);
    let mut model = Model {
        name: path.display().to_string(),
        vertex_count_in_file: screened.vertex_count,
        positions: mesh.positions.as_chunks::<3>().0.to_vec(),
        texcoords: mesh.texcoords.as_chunks::<2>().0.to_vec(),
        normals: mesh.normals.as_chunks::<3>().0.to_vec(),
        has_smoothing_groups: screened.has_smoothing_groups,
        ..Model::default()
    };
    fill_polygons(path, &mut model, &mesh, &screened)?;
    if model.polygons.is_empty() {
        let what = "every face uses a vertex that is not finite".into();
        return Err(ReadError::Empty { path: path.into(), what });
    }
    model.materials = read_materials(path, &screened, &mut report);
    Ok((model, report))
}

/// Runs `tobj` over screened text, which holds no groups or materials and so
/// comes back as one mesh.
fn parse(path: &Path, mut text: &[u8]) -> Result<tobj::Mesh, ReadError> {
    let internal = |what: String| ReadError::Internal { path: path.into(), what };
    let (models, _) = tobj::load_obj_buf(&mut text, &tobj::LoadOptions::default(), |_| {
        Err(tobj::LoadError::OpenFileFailed)
    })
    .map_err(|error| internal(error.to_string()))?;
    let count = models.len();
    let mut models = models.into_iter();
    match (models.next(), count) {
        (Some(model), 1) => Ok(model.mesh),
        _ => Err(internal(format!("{count} meshes instead of one"))),
    }
}

/// Makes the polygons of those faces whose positions are all finite.
fn fill_polygons(
    path: &Path,
    model: &mut Model,
    mesh: &tobj::Mesh,
    screened: &Screened,
) -> Result<(), ReadError> {
    let corner_total = mesh.indices.len();
    let is_sound = mesh.texcoord_indices.len() == corner_total
        && mesh.normal_indices.len() == corner_total
        && (mesh.face_arities.is_empty() || mesh.face_arities.len() == screened.faces.len());
    if !is_sound {
        let what = "corners without all indices".into();
        return Err(ReadError::Internal { path: path.into(), what });
    }
    let texcoord_of = |index: u32| kept(index, &model.texcoords[index as usize]);
    let normal_of = |index: u32| kept(index, &model.normals[index as usize]);
    let mut corners = Vec::with_capacity(corner_total);
    let mut start = 0;
    for (face, source) in screened.faces.iter().enumerate() {
        // tobj gives no arities where all faces are triangles.
        let arity = mesh.face_arities.get(face).map_or(3, |&arity| arity as usize);
        let range = start..start + arity;
        start += arity;
        let is_finite = mesh.indices[range.clone()]
            .iter()
            .all(|&position| model.positions[position as usize][0].is_finite());
        if !is_finite {
            continue;
        }
        let first_corner = to_u32(corners.len());
        corners.extend(range.map(|corner| Corner {
            position: mesh.indices[corner],
            texcoord: texcoord_of(mesh.texcoord_indices[corner]),
            normal: normal_of(mesh.normal_indices[corner]),
        }));
        model.polygons.push(Polygon {
            first_corner,
            corner_count: to_u32(arity),
            material: source.material,
            smoothing_group: source.smoothing_group,
            line: source.line,
        });
    }
    model.corners = corners;
    Ok(())
}

/// The index itself, or [`NONE`] for the screen's stand-in, which is NaN.
const fn kept(index: u32, value: &[f32]) -> u32 {
    if value[0].is_nan() { NONE } else { index }
}

/// Coordinates beyond this leave no room for an eye some radii away: the numbers
/// of a view would not be finite in 32 bits.
const LARGEST_COORDINATE: f64 = 1e37;

fn warn_if_far(screened: &Screened, report: &mut Report) {
    let Some((low, high)) = screened.bounds else { return };
    if screened.largest_coordinate > LARGEST_COORDINATE {
        report.warn(WarningCode::Precision, None, || {
            format!(
                "coordinates reach {:.3e}: views of such a model overflow; make it smaller",
                screened.largest_coordinate
            )
        });
    }
    let size = (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max);
    if size > 0.0 && screened.largest_coordinate > FAR_FROM_ORIGIN * size {
        report.warn(WarningCode::Precision, None, || {
            format!(
                "coordinates reach {:.3e} while the model is only {size:.3e} large: 32-bit numbers \
                 lose detail; move the model to the origin",
                screened.largest_coordinate
            )
        });
    }
}

/// The materials that faces use, with what the libraries say of them.
fn read_materials(path: &Path, screened: &Screened, report: &mut Report) -> Vec<Material> {
    let mut known: Vec<tobj::Material> = Vec::new();
    for (rest, line) in &screened.material_libraries {
        for name in library_names(path, rest) {
            match read_library(path, &name) {
                Ok(materials) => known.extend(materials),
                Err(why) => report.warn(WarningCode::Material, Some(*line), || {
                    format!("material library '{name}' {why}; its colours are left out")
                }),
            }
        }
    }
    let mut by_name = FxHashMap::default();
    for material in &known {
        by_name.entry(material.name.as_str()).or_insert(material);
    }
    screened
        .material_names
        .iter()
        .map(|name| {
            by_name.get(name.as_str()).map_or_else(
                || Material { name: name.clone(), ..Material::default() },
                |material| material_of(material),
            )
        })
        .collect()
}

fn material_of(material: &tobj::Material) -> Material {
    Material {
        name: material.name.clone(),
        ambient: material.ambient,
        diffuse: material.diffuse,
        specular: material.specular,
        shininess: material.shininess,
        opacity: material.dissolve,
        diffuse_texture: material.diffuse_texture.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> (Model, Report) {
        read_obj(Path::new("test.obj"), text.as_bytes()).unwrap()
    }

    #[test]
    fn polygons_objects_and_mixed_corners() {
        let (model, report) = read(
            "o first\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n\
             f 1/1/1 2 3//1 4\no second\nv 0 0 1\nf 1 2 -1\n",
        );
        assert_eq!(report, Report::default());
        assert_eq!(model.vertex_count_in_file, 5);
        let counts: Vec<_> = model.polygons.iter().map(|polygon| polygon.corner_count).collect();
        assert_eq!(counts, [4, 3]);
        assert_eq!(model.corners[0].position, model.corners[4].position, "shared across objects");
        assert_ne!(model.corners[0].texcoord, NONE);
        assert_eq!(model.corners[1].texcoord, NONE);
        assert_ne!(model.corners[2].normal, NONE);
        assert_eq!(model.corners[3].normal, NONE);
        assert_eq!(model.positions[model.corners[6].position as usize], [0.0, 0.0, 1.0]);
    }

    #[test]
    fn faces_with_vertices_that_are_not_finite_go() {
        let (model, report) = read("v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nf 1 2 3\nf 2 3 4\n");
        assert_eq!(model.polygons.len(), 1);
        assert_eq!(report.count(WarningCode::NonFinite), 1);
    }

    #[test]
    fn models_too_far_or_too_large_for_32_bits_are_told() {
        for (text, count) in [
            ("v 5000000 0 0\nv 5000001 0 0\nv 5000000 1 0\nf 1 2 3\n", 1),
            ("v 0 0 0\nv 3e38 0 0\nv 0 3e38 0\nf 1 2 3\n", 1),
            ("v 500 0 0\nv 501 0 0\nv 500 1 0\nf 1 2 3\n", 0),
        ] {
            assert_eq!(read(text).1.count(WarningCode::Precision), count, "{text}");
        }
    }
}
