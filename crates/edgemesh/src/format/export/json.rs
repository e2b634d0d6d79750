//! JSON with the whole edge mesh, for scripts.
//!
//! ```text
//! {"name": "cube.obj",
//!  "frame": {"origin": [0.0, 0.0, 0.0], "scale": 1.0},
//!  "bounds": {"min": [x, y, z], "max": [x, y, z]},
//!  "counts": {"vertices": 8, ...},        as in `info --json`
//!  "positions": [[x, y, z], ...],
//!  "triangles": [[a, b, c], ...],         indices into positions
//!  "edges": [{"vertices": [a, b],         indices into positions
//!             "faces": [a, b],            left and right of a -> b, indices
//!                                         into triangles; null for a missing one
//!             "classes": ["ridge", ...],  the names of its classes
//!             "chain": 3,                 index into chains, or null
//!             "arc_start": 0.5}, ...],    length of the chain before it, or null
//!  "chains": [{"class": "ridge",
//!              "length": 4.0,
//!              "is_loop": true,
//!              "vertices": [a, b, ...]},  a loop ends with its first vertex
//!             ...]}
//! ```
//!
//! Positions, bounds and lengths are in the units of the model file. The frame is the
//! transform of positions before they were rounded to 32 bits:
//! `(in_file - origin) * scale`. Numbers have as many digits as are needed to read them
//! back unchanged. Each element of a list is on a separate line ([`lines`](super::lines)).
//!
//! An edge of more than two faces is listed once for each pair of its faces. Edges are in
//! the order of the records: by the smaller, then the larger vertex, with lines without a
//! face last.
//!
//! Rejected: building the document as one value, which takes about ten times the memory of
//! the mesh.

use std::io::{self, Write};

use serde::ser::{Serialize, SerializeMap as _, Serializer};
use serde_json::{Value, json};

use super::edge_records::chain_vertices;
use super::file_number::{FileNumber, in_file, length_in_file};
use super::lines::LineFormatter;
use crate::edge_mesh::{Chain, EdgeMesh, EdgeRecord, class_names};
use crate::index::{NONE, to_u32};

/// Writes a mesh without its fill.
///
/// # Errors
/// Those of `out`.
pub(super) fn write_json(mesh: &EdgeMesh, name: &str, out: &mut impl Write) -> io::Result<()> {
    let mut serializer =
        serde_json::Serializer::with_formatter(&mut *out, LineFormatter::default());
    Document { mesh, name }.serialize(&mut serializer)?;
    out.write_all(b"\n")
}

struct Document<'a> {
    mesh: &'a EdgeMesh,
    name: &'a str,
}

impl Serialize for Document<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mesh = self.mesh;
        let links = links_by_record(mesh);
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("name", self.name)?;
        map.serialize_entry("frame", &frame(mesh))?;
        map.serialize_entry("bounds", &Bounds::of(mesh))?;
        map.serialize_entry("counts", &counts(mesh))?;
        map.serialize_entry(
            "positions",
            &List(|| mesh.positions.iter().map(|&p| in_file(mesh, p))),
        )?;
        map.serialize_entry("triangles", &List(|| &mesh.triangles))?;
        let edges =
            || mesh.records.iter().zip(&links).map(|(record, &link)| Edge::of(mesh, record, link));
        map.serialize_entry("edges", &List(edges))?;
        map.serialize_entry(
            "chains",
            &List(|| mesh.chains.chains.iter().map(|chain| ChainInMesh { mesh, chain })),
        )?;
        map.end()
    }
}

/// Serializes the items of an iterator, one by one.
struct List<F>(F);

impl<F, I> Serialize for List<F>
where
    F: Fn() -> I,
    I: IntoIterator<Item: Serialize>,
{
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0())
    }
}

/// The link of each record, or [`NONE`].
fn links_by_record(mesh: &EdgeMesh) -> Vec<u32> {
    let mut links = vec![NONE; mesh.records.len()];
    for (at, link) in mesh.chains.links.iter().enumerate() {
        links[link.record as usize] = to_u32(at);
    }
    links
}

fn frame(mesh: &EdgeMesh) -> Value {
    json!({"origin": mesh.frame.origin.to_array(), "scale": mesh.frame.scale})
}

#[derive(serde::Serialize)]
struct Bounds {
    min: [FileNumber; 3],
    max: [FileNumber; 3],
}

impl Bounds {
    fn of(mesh: &EdgeMesh) -> Self {
        Self { min: in_file(mesh, mesh.bounds.min), max: in_file(mesh, mesh.bounds.max) }
    }
}

fn counts(mesh: &EdgeMesh) -> Value {
    let counts = &mesh.counts;
    json!({
        "vertices": counts.vertices,
        "welded_vertices": counts.welded_vertices,
        "triangles": counts.triangles,
        "degenerate_triangles": counts.degenerate_triangles,
        "duplicate_triangles": counts.duplicate_triangles,
        "edges": counts.edges.edges,
        "diagonal_edges": counts.diagonal_edges,
        "boundary_edges": counts.edges.boundary,
        "non_manifold_edges": counts.edges.non_manifold,
        "inconsistent_edges": counts.edges.inconsistent,
        "components": counts.components,
        "records": mesh.records.len()
    })
}

#[derive(serde::Serialize)]
struct Edge {
    vertices: [u32; 2],
    faces: [Option<u32>; 2],
    classes: Vec<&'static str>,
    chain: Option<u32>,
    arc_start: Option<FileNumber>,
}

impl Edge {
    fn of(mesh: &EdgeMesh, record: &EdgeRecord, link: u32) -> Self {
        let EdgeRecord { v0, v1, face_a, face_b, word } = *record;
        let link = mesh.chains.links.get(link as usize);
        Self {
            vertices: [v0, v1],
            faces: [face_a, face_b].map(|face| (face != NONE).then_some(face)),
            classes: class_names(word.flags()).collect(),
            chain: link.map(|link| link.chain),
            arc_start: link.map(|link| length_in_file(mesh, link.arc_start)),
        }
    }
}

/// A chain of a mesh.
struct ChainInMesh<'a> {
    mesh: &'a EdgeMesh,
    chain: &'a Chain,
}

impl Serialize for ChainInMesh<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self { mesh, chain } = self;
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("class", &class_names(chain.class).next())?;
        map.serialize_entry("length", &length_in_file(mesh, chain.length))?;
        map.serialize_entry("is_loop", &(chain.is_loop == 1))?;
        map.serialize_entry("vertices", &List(|| chain_vertices(mesh, chain)))?;
        map.end()
    }
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
        write_json(&mesh, name, &mut bytes).unwrap();
        String::from_utf8(bytes).unwrap()
    }

    #[test]
    fn a_triangle_and_a_line_in_full() {
        let corners = [[0., 0., 0.1], [3., 0., 0.1], [0., 4., 0.1], [5., 0., 0.1]];
        let mut model = Model::from_polygons(&corners, &[&[0, 1, 2]]);
        model.segments.push(Segment { ends: [1, 3], line: 0 });
        let text = write(&model, "gr\u{fc}n \"a\"\n");
        let (before, lists) = text.split_once("\"positions\"").unwrap();
        let before: Value = serde_json::from_str(&format!("{before}\"\":0}}")).unwrap();
        assert_eq!(before["name"], "gr\u{fc}n \"a\"\n");
        assert_eq!(before["frame"], json!({"origin": [0.0, 0.0, 0.0], "scale": 1.0}));
        assert_eq!(before["counts"]["boundary_edges"], 3);
        let expected = r#":[
[0.0,0.0,0.1],
[3.0,0.0,0.1],
[0.0,4.0,0.1],
[5.0,0.0,0.1]],
"triangles":[
[0,1,2]],
"edges":[
{"vertices":[0,1],"faces":[0,null],"classes":["boundary"],"chain":0,"arc_start":0.0},
{"vertices":[2,0],"faces":[0,null],"classes":["boundary"],"chain":1,"arc_start":0.0},
{"vertices":[1,2],"faces":[0,null],"classes":["boundary"],"chain":2,"arc_start":0.0},
{"vertices":[1,3],"faces":[null,null],"classes":["marked"],"chain":3,"arc_start":0.0}],
"chains":[
{"class":"boundary","length":3.0,"is_loop":false,"vertices":[0,1]},
{"class":"boundary","length":4.0,"is_loop":false,"vertices":[2,0]},
{"class":"boundary","length":5.0,"is_loop":false,"vertices":[1,2]},
{"class":"marked","length":2.0,"is_loop":false,"vertices":[1,3]}]}
"#;
        assert_eq!(lists, expected);
    }

    #[test]
    fn lengths_are_in_units_of_the_model_file() {
        let corners = [[0., 0., 0.], [3e20, 0., 0.], [0., 4e20, 0.]];
        let text = write(&Model::from_polygons(&corners, &[&[0, 1, 2]]), "");
        let json: Value = serde_json::from_str(&text).unwrap();
        assert!(json["frame"]["scale"].as_f64().unwrap() < 1e-19, "{text}");
        let lengths = [&json["chains"][2]["length"], &json["bounds"]["max"][1]];
        for (length, expected) in lengths.into_iter().zip([5e20, 4e20]) {
            assert!((length.as_f64().unwrap() / expected - 1.0).abs() < 1e-6, "{length}");
        }
    }

    #[test]
    fn an_empty_mesh_is_a_document_of_empty_lists() {
        let json: Value = serde_json::from_str(&write(&Model::default(), "")).unwrap();
        for list in ["positions", "triangles", "edges", "chains"] {
            assert_eq!(json[list], json!([]), "{list}");
        }
    }
}
