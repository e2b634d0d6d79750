//! OBJ: triangles with texture coordinates, colors and materials, and hard edges as polylines.
//!
//! Source: Alias|Wavefront, *Advanced Visualizer Manual*, appendix B1: `v`, `vt`, `f`, `l`, `g`,
//! `o`, `mtllib`, `usemtl`.
//!
//! ```text
//! v 0 0 0 1 0.5 0   positions: the shortest text that is read back unchanged; with colors, if
//!                     the mesh has any: a place of several colors is written once for each
//! vt 0.5 1          the different texture coordinates
//! usemtl bark       before the triangles of each material
//! f 1/1 2/4 3/2     triangles
//! g marked ridge    for each set of classes:
//! l 1 2 3 1           a polyline for each part of a chain with them; a loop ends with its
//!                     first vertex
//! ```
//!
//! The first line says whose groups these are, and the reader of this project gives the edges
//! their classes back. To other readers, and to it without that line, they are lines.
//!
//! Normals are not written, because those of a welded mesh are not for shading. Opacities of colors
//! have no place in the format.

use std::io::{self, Write};

use indexmap::{IndexMap, IndexSet};
use rustc_hash::FxBuildHasher;

use super::edge_records::{classes_of_records, link_ends};
use super::face_runs::face_runs;
use super::file_number::in_file;
use super::names::{MaterialNames, statement_name};
use crate::edge_mesh::{CHAIN_CLASSES, Chain, ChainLink, EdgeFlags, EdgeMesh, class_names};
use crate::format::edge_classes::STATES_CLASSES;
use crate::index::{NONE, to_u32};

/// Writes a mesh with its chains; `library` is the name of its material library.
///
/// # Errors
/// Those of `out`.
pub(super) fn write_obj(
    mesh: &EdgeMesh,
    name: &str,
    library: Option<&str>,
    out: &mut impl Write,
) -> io::Result<()> {
    writeln!(out, "# {STATES_CLASSES}")?;
    writeln!(out, "# A mesh of Edgemesh {}, and its hard edges", env!("CARGO_PKG_VERSION"))?;
    writeln!(out, "# as polylines (l), in groups by class (g)")?;
    if let Some(library) = library {
        writeln!(out, "mtllib {library}")?;
    }
    let name = statement_name(name);
    if !name.is_empty() {
        writeln!(out, "o {name}")?;
    }
    let places = ColoredPlaces::of(mesh);
    write_places(mesh, &places, out)?;
    write_faces(mesh, &places, out)?;
    write_chains(mesh, out)
}

/// The vertices of a file: a place of several colors has one for each.
struct ColoredPlaces {
    /// The vertex of the mesh and the color of each vertex. Those of the mesh come first, in their
    /// order, with the first color of their corners, or white. Empty if the mesh has no colors:
    /// then the vertices are those of the mesh.
    list: IndexSet<(u32, [u8; 4]), FxBuildHasher>,
}

impl ColoredPlaces {
    fn of(mesh: &EdgeMesh) -> Self {
        let Some(&any) = mesh.fill.colors.first() else {
            return Self { list: IndexSet::default() };
        };
        let corners = || mesh.triangles.iter().flatten().zip(&mesh.fill.indices);
        let mut firsts = vec![None; mesh.positions.len()];
        for (&vertex, &corner) in corners() {
            let color = mesh.fill.colors.get(corner as usize).copied().unwrap_or(any);
            firsts[vertex as usize].get_or_insert(color);
        }
        let firsts = firsts.into_iter().map(|color| color.unwrap_or([u8::MAX; 4]));
        let mut list: IndexSet<(u32, [u8; 4]), FxBuildHasher> = (0..).zip(firsts).collect();
        for (&vertex, &corner) in corners() {
            list.insert((vertex, mesh.fill.colors[corner as usize]));
        }
        Self { list }
    }

    /// The index of the vertex of a corner.
    fn of_corner(&self, mesh: &EdgeMesh, corner: usize, vertex: u32) -> u32 {
        if self.list.is_empty() {
            return vertex;
        }
        let color = mesh.fill.colors[mesh.fill.indices[corner] as usize];
        to_u32(self.list.get_index_of(&(vertex, color)).unwrap_or_default())
    }
}

fn write_places(mesh: &EdgeMesh, places: &ColoredPlaces, out: &mut impl Write) -> io::Result<()> {
    if places.list.is_empty() {
        for &position in &mesh.positions {
            let [x, y, z] = in_file(mesh, position);
            writeln!(out, "v {x} {y} {z}")?;
        }
    }
    for &(vertex, [red, green, blue, _]) in &places.list {
        let [x, y, z] = in_file(mesh, mesh.positions[vertex as usize]);
        let [red, green, blue] = [red, green, blue].map(|part| f32::from(part) / 255.0);
        writeln!(out, "v {x} {y} {z} {red} {green} {blue}")?;
    }
    Ok(())
}

/// Writes triangles with their texture coordinates and materials.
fn write_faces(mesh: &EdgeMesh, places: &ColoredPlaces, out: &mut impl Write) -> io::Result<()> {
    let texcoords = Texcoords::of(mesh);
    for texcoord in &texcoords.list {
        let [u, v] = texcoord.map(f32::from_bits);
        writeln!(out, "vt {u} {v}")?;
    }
    let names = MaterialNames::of(&mesh.fill.materials);
    let mut material = NONE;
    for (faces, run) in face_runs(mesh) {
        if run.material != material {
            material = run.material;
            writeln!(out, "usemtl {}", names.name(material))?;
        }
        for face in faces {
            write!(out, "f")?;
            for (corner, &vertex) in mesh.triangles[face].iter().enumerate() {
                let corner = 3 * face + corner;
                write!(out, " {}", places.of_corner(mesh, corner, vertex) + 1)?;
                if run.has_texcoords == 1 {
                    write!(out, "/{}", texcoords.of_corner(mesh, corner) + 1)?;
                }
            }
            writeln!(out)?;
        }
    }
    Ok(())
}

/// The different texture coordinates of a mesh.
struct Texcoords {
    /// As bits.
    list: IndexSet<[u32; 2], FxBuildHasher>,
}

impl Texcoords {
    fn of(mesh: &EdgeMesh) -> Self {
        let textured = face_runs(mesh).filter(|(_, run)| run.has_texcoords == 1);
        let corners = textured.flat_map(|(faces, _)| 3 * faces.start..3 * faces.end);
        Self { list: corners.map(|corner| texcoord_bits(mesh, corner)).collect() }
    }

    /// The index of the texture coordinate of a corner.
    fn of_corner(&self, mesh: &EdgeMesh, corner: usize) -> u32 {
        to_u32(self.list.get_index_of(&texcoord_bits(mesh, corner)).unwrap_or_default())
    }
}

fn texcoord_bits(mesh: &EdgeMesh, corner: usize) -> [u32; 2] {
    mesh.fill.vertices[mesh.fill.indices[corner] as usize].texcoord.map(f32::to_bits)
}

fn write_chains(mesh: &EdgeMesh, out: &mut impl Write) -> io::Result<()> {
    let of_record = classes_of_records(mesh);
    for class in CHAIN_CLASSES {
        let mut groups = IndexMap::<u32, Vec<Vec<u32>>>::new();
        for chain in mesh.chains.chains.iter().filter(|chain| chain.class == class) {
            for (classes, line) in lines_of(mesh, chain, &of_record) {
                groups.entry(classes.bits()).or_default().push(line);
            }
        }
        for (classes, lines) in groups {
            let words: Vec<&str> = class_names(EdgeFlags::from_bits_truncate(classes)).collect();
            writeln!(out, "g {}", words.join(" "))?;
            for line in lines {
                write!(out, "l")?;
                for vertex in line {
                    write!(out, " {}", vertex + 1)?;
                }
                writeln!(out)?;
            }
        }
    }
    Ok(())
}

/// The parts of a chain whose edges have the same classes, with their vertices.
fn lines_of<'a>(
    mesh: &'a EdgeMesh,
    chain: &Chain,
    of_record: &'a [EdgeFlags],
) -> impl Iterator<Item = (EdgeFlags, Vec<u32>)> + 'a {
    let links = &mesh.chains.links[chain.link_range()];
    let classes = |link: &ChainLink| of_record[link.record as usize];
    links.chunk_by(move |a, b| classes(a) == classes(b)).map(move |part| {
        let first = part.first().map(|link| link_ends(mesh, link)[0]);
        let vertices = first.into_iter().chain(part.iter().map(|link| link_ends(mesh, link)[1]));
        (part.first().map_or(EdgeFlags::empty(), classes), vertices.collect())
    })
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
        write_obj(&mesh, name, None, &mut bytes).unwrap();
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
