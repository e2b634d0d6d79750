//! Primitives: the triangles of a material, and lines.

use serde_json::{Value, json};

use super::super::vertices::Vertices;
use super::binary_data::{BinaryData, ElementType, float_bytes};
use super::edge_visibility::{EXTENSION, EdgeVisibility};
use super::edges::extension;
use super::materials::linear;
use super::rig::Bending;
use super::surface::Surface;
use crate::edge_mesh::EdgeMesh;
use crate::index::NONE;

const LINES: u32 = 1;
const TRIANGLES: u32 = 4;

/// The vertices of primitives as they name them.
#[derive(Debug, Clone, Default)]
pub(super) struct Attributes {
    attributes: Value,
    /// The morph targets; null without any.
    targets: Value,
    /// The number of vertices.
    count: usize,
}

impl Attributes {
    /// The attributes of vertices, with normals if triangles use them.
    pub(super) fn of(vertices: &Vertices, with_normals: bool, data: &mut BinaryData) -> Self {
        let Vertices { positions, normals, texcoords, colors, .. } = vertices;
        let mut own = Self::of_positions(positions, data);
        if with_normals {
            let normals = normals.iter().map(|&normal| float_bytes(unit(normal)));
            own.attributes["NORMAL"] = data.push(ElementType::VERTICES, normals).into();
        }
        if !texcoords.is_empty() {
            // The origin of glTF is the upper left corner of a picture.
            let flipped = texcoords.iter().map(|&[u, v]| [u, 1.0 - v].map(f32::to_le_bytes));
            let bytes = flipped.map(|bytes| -> [u8; 8] { bytemuck::cast(bytes) });
            own.attributes["TEXCOORD_0"] = data.push(ElementType::TEXCOORDS, bytes).into();
        }
        if !colors.is_empty() {
            let bytes = colors.iter().map(|&color| linear_color(color));
            let accessor = data.push(ElementType::COLORS, bytes);
            data.accessors[accessor]["normalized"] = true.into();
            own.attributes["COLOR_0"] = accessor.into();
        }
        own
    }

    /// The attributes of vertices that have positions alone.
    pub(super) fn of_positions(positions: &[[f32; 3]], data: &mut BinaryData) -> Self {
        let attributes = json!({"POSITION": data.push_positions(positions)});
        Self { attributes, targets: Value::Null, count: positions.len() }
    }

    /// These attributes with joints, weights and morph targets.
    pub(super) fn with(mut self, bending: Bending) -> Self {
        for (name, accessor) in bending.attributes {
            self.attributes[name] = accessor.into();
        }
        if !bending.targets.is_empty() {
            let target = |accessor: usize| json!({"POSITION": accessor});
            self.targets = bending.targets.into_iter().map(target).collect();
        }
        self
    }

    fn primitive(&self, mode: u32, indices: &[u32], data: &mut BinaryData) -> Value {
        let indices = data.push_indices(self.count, true, indices);
        let mut primitive =
            json!({"attributes": self.attributes, "indices": indices, "mode": mode});
        if !self.targets.is_null() {
            primitive["targets"] = self.targets.clone();
        }
        primitive
    }
}

/// The triangles of each material, with their part; `attributes` are those of each part.
pub(super) fn triangle_primitives(
    mesh: &EdgeMesh,
    surface: &Surface,
    attributes: &[Attributes],
    data: &mut BinaryData,
) -> Vec<(usize, Value)> {
    let Surface { corners, faces, primitives, .. } = surface;
    let edges = EdgeVisibility::of(mesh, faces, corners);
    let mut written = Vec::new();
    for (number, (visibility, &(part, material))) in edges.iter().zip(primitives).enumerate() {
        let own = faces.of(number).iter();
        let own = own.map(|&face| faces.stored(number, corners[face as usize]));
        let indices: Vec<u32> = own.flatten().collect();
        let mut triangles = attributes[part].primitive(TRIANGLES, &indices, data);
        if material != NONE {
            triangles["material"] = material.into();
        }
        if !visibility.is_empty() {
            let extension = extension(visibility, attributes[part].count, data);
            triangles["extensions"] = json!({EXTENSION: extension});
        }
        written.push((part, triangles));
    }
    written
}

/// Lines between pairs of vertices, if there are any.
pub(super) fn line_primitive(
    attributes: &Attributes,
    ends: &[u32],
    data: &mut BinaryData,
) -> Option<Value> {
    (!ends.is_empty()).then(|| attributes.primitive(LINES, ends, data))
}

/// A color in linear values of 16 bits, which keep all sRGB values of 8 bits apart.
#[expect(clippy::cast_possible_truncation, reason = "from 0 to 1")]
#[expect(clippy::cast_sign_loss, reason = "from 0 to 1")]
fn linear_color([red, green, blue, alpha]: [u8; 4]) -> [u8; 8] {
    let fraction = |part: u8| f32::from(part) / 255.0;
    let [red, green, blue] = [red, green, blue].map(|part| linear(fraction(part)));
    let short = |part: f32| ((part * f32::from(u16::MAX)).round() as u16).to_le_bytes();
    bytemuck::cast([red, green, blue, fraction(alpha)].map(short))
}

/// The normal, or +z if it is zero.
fn unit(normal: [f32; 3]) -> [f32; 3] {
    if normal == [0.0; 3] { [0.0, 0.0, 1.0] } else { normal }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors_are_linear_with_straight_opacity() {
        // 188 / 255 coded is 0.5029 linear, 128 is 0.2159.
        let short = |at: usize, color| {
            let bytes = linear_color(color);
            f32::from(u16::from_le_bytes([bytes[at], bytes[at + 1]])) / 65535.0
        };
        let color = [188, 128, 0, 51];
        let found = [0, 2, 4, 6].map(|at| short(at, color));
        for (found, expected) in found.into_iter().zip([0.502_886, 0.215_861, 0.0, 0.2]) {
            assert!((found - expected).abs() < 2e-5, "{found} {expected}");
        }
    }

    #[test]
    fn normals_of_zero_become_z() {
        assert_eq!([unit([0.0, -0.0, 0.0]), unit([0.0, 1.0, 0.0])], [[0., 0., 1.], [0., 1., 0.]]);
    }
}
