//! Positions, normals, texture coordinates and colors of a primitive.
//!
//! Based on: glTF 2.0, section 3.7.2.1 (meshes) and `KHR_mesh_quantization`.
//!
//! Faults in positions are errors, as are those in skins and morph targets
//! (`deform`). A fault in another attribute costs only that attribute, with a
//! warning.

use gltf_json as json;
use json::accessor::Type;
use json::mesh::Semantic;

use super::super::error::{ReadError, ReadErrorKind};
use super::accessor::Accessor;
use super::document::Accessor as JsonAccessor;
use super::material::srgb;
use super::primitive::Primitive;
use crate::report::{Place, Report, WarningCode};

/// The attributes of vertices besides positions; each list has one element for each
/// vertex, or is empty.
#[derive(Debug, Default, PartialEq)]
pub(super) struct VertexAttributes {
    pub(super) normals: Vec<[f32; 3]>,
    pub(super) texcoords: Vec<[f32; 2]>,
    pub(super) colors: Vec<[f32; 4]>,
}

impl VertexAttributes {
    /// Reads the attributes of the `count` vertices of a primitive.
    pub(super) fn read(primitive: Primitive, count: usize, report: &mut Report) -> Self {
        let mut reader = AttributeReader { primitive, count, report };
        Self {
            normals: reader.read(Semantic::Normals, |accessor| accessor.numbers()),
            texcoords: reader.read(Semantic::TexCoords(0), texcoords),
            colors: reader.read(Semantic::Colors(0), colors),
        }
    }
}

/// The positions, if the primitive has any; warns if they leave their stated bounds.
///
/// # Errors
/// As [`Primitive::attribute`].
pub(super) fn positions(
    primitive: Primitive,
    report: &mut Report,
) -> Result<Option<Vec<[f32; 3]>>, ReadError> {
    let Some(accessor) = primitive.attribute(Semantic::Positions)? else { return Ok(None) };
    let positions = accessor.numbers()?;
    if accessor.is_raw()
        && let Some(json) = primitive.asset.document.accessors.get(accessor.index())
    {
        check_bounds(json, accessor.index(), &positions, report);
    }
    Ok(Some(positions))
}

fn check_bounds(json: &JsonAccessor, index: usize, found: &[[f32; 3]], report: &mut Report) {
    let stated = |list: &Option<json::Value>, at: usize| list.as_ref()?.get(at)?.as_f64();
    for (at, axis) in ["x", "y", "z"].into_iter().enumerate() {
        let (Some(least), Some(most)) = (stated(&json.min, at), stated(&json.max, at)) else {
            continue;
        };
        // Programs often write bounds with few digits.
        let slack = 1e-5 * least.abs().max(most.abs());
        let is_outside =
            |value: f64| value.is_finite() && (value < least - slack || value > most + slack);
        let outside = found.iter().find(|position| is_outside(position[at].into()));
        if let Some(position) = outside {
            let place = Some(Place::Part(format!("accessors[{index}]")));
            report.warn(WarningCode::Syntax, place, || {
                let value = position[at];
                format!("has {axis} = {value}, outside the stated range of {least} to {most}")
            });
        }
    }
}

fn is_finite<const N: usize>(element: &[f32; N]) -> bool {
    element.iter().all(|number| number.is_finite())
}

/// Reads optional attributes.
struct AttributeReader<'a> {
    primitive: Primitive<'a>,
    /// The number of vertices.
    count: usize,
    report: &'a mut Report,
}

impl AttributeReader<'_> {
    /// The elements that `convert` makes of an attribute; empty if the primitive does
    /// not have it, or it has a fault. Elements that are not finite become zeros.
    fn read<const N: usize>(
        &mut self,
        semantic: Semantic,
        convert: impl FnOnce(Accessor) -> Result<Vec<[f32; N]>, ReadError>,
    ) -> Vec<[f32; N]> {
        let name = semantic.to_string();
        let accessor = self.primitive.attribute(semantic);
        let elements = accessor.and_then(|accessor| match accessor {
            None => Ok(Vec::new()),
            Some(accessor) => {
                self.check_count(accessor.count(), &name)?;
                convert(accessor)
            }
        });
        let mut elements = elements.unwrap_or_else(|error| {
            error.warn_left_out(self.report);
            Vec::new()
        });
        for element in elements.iter_mut().filter(|element| !is_finite(element)) {
            self.report.warn(WarningCode::NonFinite, self.primitive.place(), || {
                format!("{name} of a vertex is not finite; it was set to 0")
            });
            *element = [0.0; N];
        }
        elements
    }

    fn check_count(&self, count: usize, name: &str) -> Result<(), ReadError> {
        if count == self.count {
            return Ok(());
        }
        let what = format!("has {count} {name} for {} vertices", self.count);
        Err(self.primitive.error(ReadErrorKind::Syntax, what))
    }
}

/// Texture coordinates with their origin in the lower left corner of a picture; that
/// of glTF is in the upper left.
fn texcoords(accessor: Accessor) -> Result<Vec<[f32; 2]>, ReadError> {
    let texcoords: Vec<[f32; 2]> = accessor.numbers()?;
    Ok(texcoords.into_iter().map(|[u, v]| [u, 1.0 - v]).collect())
}

/// Colors, coded as sRGB: those of glTF are linear. Integers are normalized; without alpha, colors
/// are opaque.
fn colors(accessor: Accessor) -> Result<Vec<[f32; 4]>, ReadError> {
    let accessor = accessor.normalized();
    // What is not finite is left to the reader of attributes.
    let part = |part: f32| if part.is_finite() { srgb(part) } else { part };
    let coded = |[red, green, blue]: [f32; 3], alpha| [part(red), part(green), part(blue), alpha];
    if accessor.kind() == Type::Vec4 {
        let colors: Vec<[f32; 4]> = accessor.numbers()?;
        return Ok(colors.into_iter().map(|[r, g, b, alpha]| coded([r, g, b], alpha)).collect());
    }
    let colors: Vec<[f32; 3]> = accessor.numbers()?;
    Ok(colors.into_iter().map(|color| coded(color, 1.0)).collect())
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::super::sample::{SQUARE, Sample};
    use super::*;
    use crate::index::NONE;
    use crate::report::Warning;

    #[test]
    fn attributes_follow_their_vertices() {
        let mut sample = Sample::default();
        let attributes = json!({
            "POSITION": sample.floats("VEC3", &SQUARE[..3]),
            "NORMAL": sample.floats("VEC3", &[[0.0, 0.0, 2.0]; 3]),
            "TEXCOORD_0": sample.floats("VEC2", &[[0.0, 0.25]; 3]),
            "COLOR_0": sample.bytes("VEC4", &[[255, 0, 51, 9]; 3])
        });
        let (model, report) = sample.read_primitive(&json!({"attributes": attributes})).unwrap();
        assert_eq!(report.warnings(), [] as [Warning; 0]);
        assert_eq!(model.corner_normals, [0, 1, 2]);
        assert_eq!(model.corner_texcoords, [0, 1, 2]);
        assert_eq!(model.normals, [[0.0, 0.0, 1.0]; 3]);
        assert_eq!(model.texcoords, [[0.0, 0.75]; 3], "from the lower left corner");
        // Bytes are normalized in any case; 0.2 is linear.
        let [red, green, blue, alpha] = model.colors[2];
        assert_eq!((red, green, alpha, model.colors.len()), (1.0, 0.0, 9.0 / 255.0, 3));
        assert!((blue - 0.484_529).abs() < 1e-5, "{blue}");
    }

    #[test]
    fn quantized_positions_are_numbers_or_normalized() {
        let read = |is_normalized: bool| {
            let mut sample = Sample::default();
            let bytes: Vec<u8> = [0_i16, 32767, -32767, 0].map(i16::to_le_bytes).concat();
            let view = sample.view(
                &[bytes.clone(), bytes.clone(), bytes].concat(),
                &json!({
                    "byteStride": 8
                }),
            );
            let positions = sample.accessor(json!({
                "bufferView": view, "componentType": 5122, "count": 3, "type": "VEC3",
                "normalized": is_normalized, "min": [0, 32767, -32767], "max": [0, 32767, -32767]
            }));
            let (model, report) =
                sample.read_primitive(&json!({"attributes": {"POSITION": positions}})).unwrap();
            assert!(report.warnings().is_empty(), "{report:?}");
            model.positions[0]
        };
        assert_eq!(read(true), [0.0, 1.0, -1.0]);
        assert_eq!(read(false), [0.0, 32767.0, -32767.0]);
    }

    #[test]
    fn a_faulty_attribute_is_left_out_alone() {
        let mut sample = Sample::default();
        let positions = sample.floats("VEC3", &SQUARE[..3]);
        let too_few = sample.floats("VEC3", &SQUARE[..2]);
        let past_end = sample.accessor(json!({
            "bufferView": 0, "componentType": 5126, "count": 900, "type": "VEC2"
        }));
        let not_finite = sample.floats("VEC3", &[[1.0, f32::INFINITY, 0.0], [1.0; 3], [1.0; 3]]);
        let attributes = json!({
            "POSITION": positions, "NORMAL": too_few, "TEXCOORD_0": past_end, "COLOR_0": not_finite
        });
        let (model, report) = sample.read_primitive(&json!({"attributes": attributes})).unwrap();
        assert_eq!(model.polygon_count(), 1);
        assert_eq!(model.corner(0).normal, NONE);
        assert_eq!(model.corner(0).texcoord, NONE);
        assert_eq!(model.colors, [[0.0; 4], [1.0; 4], [1.0; 4]]);
        assert_eq!(report.count(WarningCode::NonFinite), 1);
        assert!(report.count(WarningCode::Syntax) >= 2, "{report:?}");
    }

    #[test]
    fn positions_outside_their_bounds_give_a_warning() {
        let mut sample = Sample::default();
        sample.floats("VEC3", &SQUARE[..3]);
        let positions = sample.accessor(json!({
            "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
            "min": [0, 0, 0], "max": [1, 0.5, 0]
        }));
        let (_, report) =
            sample.read_primitive(&json!({"attributes": {"POSITION": positions}})).unwrap();
        assert_eq!(report.warnings()[0].place, Some(Place::Part("accessors[1]".into())));
        assert!(report.warnings()[0].message.contains("y = 1"), "{report:?}");
    }

    #[test]
    fn positions_that_are_not_finite_are_left_to_the_firewall() {
        let mut sample = Sample::default();
        let [a, b, c] = [SQUARE[0], SQUARE[1], SQUARE[2]];
        let positions = sample.floats("VEC3", &[a, b, c, a, b, [f32::NAN, 1.0, 1.0]]);
        let primitive = json!({"attributes": {"POSITION": positions}});
        let (model, report) = sample.read_primitive(&primitive).unwrap();
        assert!(model.positions[5][0].is_nan() && report.count(WarningCode::NonFinite) == 0);
    }

    #[test]
    fn faults_of_positions_are_errors() {
        let mut sample = Sample::default();
        let four = sample.floats("VEC4", &[[0.0; 4]; 3]);
        let read = |positions: usize| {
            sample.read_primitive(&json!({"attributes": {"POSITION": positions}})).unwrap_err()
        };
        assert_eq!(read(four).kind, ReadErrorKind::Syntax);
        let error = read(7);
        assert_eq!(error.kind, ReadErrorKind::Syntax);
        assert!(error.what.contains("accessors[7]; there are 1"), "{error}");
        let place = "meshes[0].primitives[0].attributes";
        assert_eq!(error.place, Some(Place::Part(place.into())));
    }
}
