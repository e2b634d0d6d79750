//! Binary PLY, little-endian: vertices, triangles and hard edges.
//!
//! Source: G. Turk, *The PLY Polygon File Format* (1994), with the element and property
//! names that programs use. Edges have the color of their first class, which
//! distinguishes the classes in programs that draw them, and all their class bits.
//! Comments in the header explain colors and bits.
//!
//! A mesh with texture coordinates or colors has the vertices of its fill, with `s` and `t`, and
//! with `red`, `green`, `blue` and `alpha`; another one has its own. Triangles have the diffuse color of their material if any has one; a program that
//! wants the materials themselves reads glTF.
//!
//! Positions are floats, or doubles if the mesh has a frame. The normal of a vertex
//! without faces, or with faces that cancel out, is zero.
//!
//! Rejected: text, which is larger and slower; for reading there is the OBJ export.

use std::io::{self, Write};

use super::edge_records::{edges, hard_classes};
use super::face_runs::face_runs;
use super::file_number::{FileNumber, in_file};
use super::one_line::one_line;
use super::vertices::Vertices;
use crate::edge_mesh::{CHAIN_CLASSES, EdgeFlags, EdgeMesh, FillRun, chain_class_of, class_names};
use crate::format::edge_classes::STATES_CLASSES;

/// The colors of [`CHAIN_CLASSES`].
const COLORS: [[u8; 3]; 7] = [
    [214, 39, 40],
    [31, 119, 180],
    [227, 119, 194],
    [255, 127, 14],
    [148, 103, 189],
    [44, 160, 44],
    [23, 190, 207],
];

/// Writes a mesh with its hard edges.
///
/// # Errors
/// Those of `out`.
pub(super) fn write_ply(mesh: &EdgeMesh, name: &str, out: &mut impl Write) -> io::Result<()> {
    let vertices = Vertices::of(mesh);
    let colors = face_colors(mesh);
    write_header(mesh, &vertices, colors.is_some(), name, out)?;
    for (at, &position) in vertices.positions.iter().enumerate() {
        for coordinate in in_file(mesh, position) {
            match coordinate {
                FileNumber::Single(number) => out.write_all(&number.to_le_bytes())?,
                FileNumber::Double(number) => out.write_all(&number.to_le_bytes())?,
            }
        }
        out.write_all(vertices.normals[at].map(f32::to_le_bytes).as_flattened())?;
        if let Some(texcoord) = vertices.texcoords.get(at) {
            out.write_all(texcoord.map(f32::to_le_bytes).as_flattened())?;
        }
        if let Some(color) = vertices.colors.get(at) {
            out.write_all(color)?;
        }
    }
    for (at, triangle) in vertices.triangles.iter().enumerate() {
        out.write_all(&[3])?;
        out.write_all(triangle.map(u32::to_le_bytes).as_flattened())?;
        if let Some(colors) = &colors {
            out.write_all(&colors[at])?;
        }
    }
    for ([start, end], flags) in hard_edges(mesh) {
        let ends = [start, end].map(|end| vertices.stored(end));
        out.write_all(ends.map(u32::to_le_bytes).as_flattened())?;
        out.write_all(&chain_class_of(flags).map_or([0; 3], |class| COLORS[class]))?;
        out.write_all(&flags.bits().to_le_bytes())?;
    }
    Ok(())
}

fn write_header(
    mesh: &EdgeMesh,
    vertices: &Vertices,
    has_colors: bool,
    name: &str,
    out: &mut impl Write,
) -> io::Result<()> {
    let colors = "property uchar red\nproperty uchar green\nproperty uchar blue";
    writeln!(out, "ply\nformat binary_little_endian 1.0")?;
    writeln!(out, "comment {}", one_line(name))?;
    writeln!(out, "comment Edgemesh {}: a mesh and its hard edges", env!("CARGO_PKG_VERSION"))?;
    writeln!(out, "comment {STATES_CLASSES}")?;
    for (class, [red, green, blue]) in CHAIN_CLASSES.into_iter().zip(COLORS) {
        let bit = class.bits();
        let word = class_names(class).next().unwrap_or_default();
        writeln!(out, "comment edge flag {bit}, color {red} {green} {blue}: {word}")?;
    }
    let float = if mesh.frame.is_identity() { "float" } else { "double" };
    writeln!(out, "element vertex {}", vertices.positions.len())?;
    for axis in ["x", "y", "z"] {
        writeln!(out, "property {float} {axis}")?;
    }
    for axis in ["nx", "ny", "nz"] {
        writeln!(out, "property float {axis}")?;
    }
    if !vertices.texcoords.is_empty() {
        writeln!(out, "property float s\nproperty float t")?;
    }
    if !vertices.colors.is_empty() {
        writeln!(out, "{colors}\nproperty uchar alpha")?;
    }
    writeln!(out, "element face {}", vertices.triangles.len())?;
    writeln!(out, "property list uchar int vertex_indices")?;
    if has_colors {
        writeln!(out, "{colors}")?;
    }
    writeln!(out, "element edge {}", hard_edges(mesh).count())?;
    writeln!(out, "property int vertex1\nproperty int vertex2")?;
    writeln!(out, "{colors}\nproperty uint flags\nend_header")
}

/// The diffuse color of each triangle, white without one; `None` if no material has one.
fn face_colors(mesh: &EdgeMesh) -> Option<Vec<[u8; 3]>> {
    let diffuse = |run: &FillRun| mesh.fill.materials.get(run.material as usize)?.diffuse;
    if !face_runs(mesh).any(|(_, run)| diffuse(&run).is_some()) {
        return None;
    }
    let colors = face_runs(mesh).flat_map(|(faces, run)| {
        let color = diffuse(&run).unwrap_or([1.0; 3]).map(byte);
        faces.map(move |_| color)
    });
    Some(colors.collect())
}

#[expect(clippy::cast_possible_truncation, reason = "clamped")]
#[expect(clippy::cast_sign_loss, reason = "clamped")]
fn byte(part: f32) -> u8 {
    (part.clamp(0.0, 1.0) * 255.0).round() as u8
}

/// The ends and classes of each hard edge, including lines without a face.
fn hard_edges(mesh: &EdgeMesh) -> impl Iterator<Item = ([u32; 2], EdgeFlags)> {
    edges(mesh)
        .map(|records| ([records[0].v0, records[0].v1], hard_classes(records)))
        .filter(|(_, classes)| !classes.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::{BuildOptions, build_edge_mesh};
    use crate::model::Model;
    use crate::report::Report;

    fn write(positions: &[[f32; 3]], polygons: &[&[u32]]) -> (String, Vec<u8>) {
        let model = Model::from_polygons(positions, polygons);
        let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default());
        let mut bytes = Vec::new();
        write_ply(&mesh, "a\nb", &mut bytes).unwrap();
        let end = b"end_header\n";
        let at = bytes.windows(end.len()).position(|window| window == end).unwrap() + end.len();
        let data = bytes.split_off(at);
        (String::from_utf8(bytes).unwrap(), data)
    }

    #[test]
    fn a_triangle_in_full() {
        let (header, data) = write(&[[0., 0., 0.], [2., 0., 0.], [0., 2., 0.]], &[&[0, 1, 2]]);
        let rows: Vec<&str> = header.lines().filter(|line| !line.starts_with("comment")).collect();
        let expected = "ply|format binary_little_endian 1.0|element vertex 3|property float x|\
            property float y|property float z|property float nx|property float ny|\
            property float nz|element face 1|property list uchar int vertex_indices|\
            element edge 3|property int vertex1|property int vertex2|property uchar red|\
            property uchar green|property uchar blue|property uint flags|end_header";
        assert_eq!(rows.join("|"), expected);
        assert!(header.contains("\ncomment a b\n"), "{header}");
        assert!(header.contains("\ncomment edge flag 1, color 31 119 180: boundary\n"), "{header}");
        assert_eq!(data.len(), 3 * 24 + 13 + 3 * 15);
        assert_eq!(data[24..28], 2.0_f32.to_le_bytes());
        assert_eq!(data[72..85], [3, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0]);
        assert_eq!(data[85..100], [0, 0, 0, 0, 1, 0, 0, 0, 31, 119, 180, 1, 0, 0, 0]);
    }

    #[test]
    fn positions_of_a_mesh_with_a_frame_are_doubles() {
        let far = [[4.0e6, 0., 0.], [4.0e6 + 1.0, 0., 0.], [4.0e6, 1., 0.]];
        let (header, data) = write(&far, &[&[0, 1, 2]]);
        assert!(header.contains("\nproperty double x\n"), "{header}");
        assert_eq!(data[36..44], 4_000_001.0_f64.to_le_bytes());
    }

    #[test]
    fn an_empty_mesh_has_three_empty_elements() {
        let (header, data) = write(&[], &[]);
        for element in ["vertex", "face", "edge"] {
            assert!(header.contains(&format!("\nelement {element} 0\n")), "{header}");
        }
        assert!(data.is_empty());
    }
}
