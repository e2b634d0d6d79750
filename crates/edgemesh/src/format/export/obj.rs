//! OBJ: triangles, and hard edges as polylines.
//!
//! Source: Alias|Wavefront, *Advanced Visualizer Manual*, appendix B1: `v`, `f`, `l`, `g`,
//! `o`.
//!
//! ```text
//! v 0 0 0       positions: the shortest text that is read back unchanged
//! f 1 2 3       triangles
//! g ridge       for each class with chains:
//! l 1 2 3 1       a polyline for each chain; a loop ends with its first vertex
//! ```
//!
//! A reader that reads `l` as marked edges, as that of this project does, gets all hard
//! edges back as marked edges. An edge of several classes is in the group of the class of
//! its chain.
//!
//! Normals are not written, because those of a welded mesh are not for shading.

use std::io::{self, Write};

use super::edge_records::chain_vertices;
use super::file_number::in_file;
use super::one_line::one_line;
use crate::edge_mesh::{CHAIN_CLASSES, EdgeMesh, class_names};

/// Writes a mesh with its chains.
///
/// # Errors
/// Those of `out`.
pub(super) fn write_obj(mesh: &EdgeMesh, name: &str, out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "# Edgemesh {}: a mesh, and its hard edges", env!("CARGO_PKG_VERSION"))?;
    writeln!(out, "# as polylines (l), in groups by class (g)")?;
    // A backslash would continue the line, a hash would begin a comment.
    let name = one_line(name).replace(['\\', '#'], "_");
    if !name.trim().is_empty() {
        writeln!(out, "o {}", name.trim())?;
    }
    for &position in &mesh.positions {
        let [x, y, z] = in_file(mesh, position);
        writeln!(out, "v {x} {y} {z}")?;
    }
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|vertex| vertex + 1);
        writeln!(out, "f {a} {b} {c}")?;
    }
    write_chains(mesh, out)
}

fn write_chains(mesh: &EdgeMesh, out: &mut impl Write) -> io::Result<()> {
    for class in CHAIN_CLASSES {
        let mut chains = mesh.chains.chains.iter().filter(|chain| chain.class == class).peekable();
        if chains.peek().is_some() {
            writeln!(out, "g {}", class_names(class).next().unwrap_or_default())?;
        }
        for chain in chains {
            write!(out, "l")?;
            for vertex in chain_vertices(mesh, chain) {
                write!(out, " {}", vertex + 1)?;
            }
            writeln!(out)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::{BuildOptions, build_edge_mesh};
    use crate::model::{Model, Segment};
    use crate::report::Report;

    fn write(model: &Model, name: &str) -> String {
        let mesh = build_edge_mesh(model, &BuildOptions::default(), &mut Report::default());
        let mut bytes = Vec::new();
        write_obj(&mesh, name, &mut bytes).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        let rows: Vec<&str> = text.lines().filter(|line| !line.starts_with('#')).collect();
        rows.join("\n")
    }

    #[test]
    fn a_strip_and_a_line_in_full() {
        let positions: Vec<[f32; 3]> =
            (0..6_u8).map(|k| [f32::from(k / 2), f32::from(k % 2), -0.1]).collect();
        let mut model = Model::from_polygons(&positions, &[&[0, 2, 3, 1], &[2, 4, 5, 3]]);
        model.segments.push(Segment { ends: [0, 5], line: 0 });
        let expected = "o a strip\n\
            v 0 0 -0.1\nv 0 1 -0.1\nv 1 0 -0.1\nv 1 1 -0.1\nv 2 0 -0.1\nv 2 1 -0.1\n\
            f 1 3 4\nf 1 4 2\nf 3 5 6\nf 3 6 4\n\
            g marked\nl 1 6\n\
            g boundary\nl 2 1\nl 1 3 5\nl 6 4 2\nl 5 6";
        assert_eq!(write(&model, " a strip"), expected);
    }

    #[test]
    fn a_loop_ends_with_its_first_vertex() {
        let corner = |k: u8| {
            let (y, x) = (f32::from(k) * std::f32::consts::TAU / 12.0).sin_cos();
            [x, y, 0.0]
        };
        let corners: Vec<[f32; 3]> = (0..12).map(corner).collect();
        let polygon: Vec<u32> = (0..12).collect();
        let text = write(&Model::from_polygons(&corners, &[&polygon]), "");
        assert!(text.ends_with("g boundary\nl 1 2 3 4 5 6 7 8 9 10 11 12 1"), "{text}");
        assert!(text.starts_with("v 1 0 0\n"), "no name, no object: {text}");
    }

    #[test]
    fn names_do_not_break_lines() {
        let named = |name: &str| write(&Model::default(), name);
        assert_eq!(named("gr\u{fc}n \"a\"\nf 1 2 3\\"), "o gr\u{fc}n \"a\" f 1 2 3_");
        assert_eq!(named(" \r\n"), "");
    }
}
