//! Edge meshes for other programs.
//!
//! ```text
//!             glTF, GLB   triangles, hard edges and lines, silhouettes with
//!            /            their normals (EXT_mesh_primitive_edge_visibility)
//! EdgeMesh --- PLY        triangles, hard edges with colours and class bits
//!            \ OBJ        triangles, hard edges as a polyline a chain
//!             JSON        all of it, with words for the classes
//! ```
//!
//! A *hard* edge is of a class that every view draws; a *silhouette* edge is any
//! other that some view draws. An edge of more than two faces has several
//! records, and may have copies of its vertices, but is one edge here.
//!
//! Positions and lengths are in the units of the file that the mesh is from.
//! Where the mesh was moved ([`MeshFrame`](crate::edge_mesh::MeshFrame)), they are written in
//! 64 bits; glTF, which has but 32, keeps the mesh's own and places its node.
//!
//! The same mesh gives the same bytes.

mod edge_visibility;
mod gltf;
mod json;
mod lines;
mod obj;
mod ply;

use std::ffi::OsStr;
use std::path::Path;
use std::{fmt, io};

use glam::Vec3;
use serde::Serialize;

use crate::edge_mesh::record::{EdgeFlags, EdgeRecord};
use crate::edge_mesh::{Chain, ChainLink, EdgeMesh};

/// A format that edge meshes are written in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExportFormat {
    /// glTF 2.0 in one binary file.
    Glb,
    /// glTF 2.0 as JSON, its data inside.
    Gltf,
    /// PLY in little-endian bytes.
    Ply,
    /// Wavefront OBJ.
    Obj,
    /// JSON with everything in it.
    Json,
}

impl ExportFormat {
    /// All formats.
    pub const ALL: [Self; 5] = [Self::Glb, Self::Gltf, Self::Ply, Self::Obj, Self::Json];

    /// The usual ending of such a file's name.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Glb => "glb",
            Self::Gltf => "gltf",
            Self::Ply => "ply",
            Self::Obj => "obj",
            Self::Json => "json",
        }
    }

    /// The format of files whose names end like that of `path`, in letters of
    /// any case.
    #[must_use]
    pub fn of_name(path: &Path) -> Option<Self> {
        let extension = path.extension().and_then(OsStr::to_str)?;
        Self::ALL.into_iter().find(|format| extension.eq_ignore_ascii_case(format.as_str()))
    }
}

/// The file that holds `mesh`, which is called `name` in it.
///
/// # Errors
/// `FileTooLarge` for a GLB of 4 GiB or more, whose header cannot say how large
/// it is.
pub fn to_bytes(mesh: &EdgeMesh, name: &str, format: ExportFormat) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    match format {
        ExportFormat::Glb => gltf::write_glb(mesh, name, &mut bytes)?,
        ExportFormat::Gltf => gltf::write_gltf(mesh, name, &mut bytes)?,
        ExportFormat::Ply => ply::write_ply(mesh, name, &mut bytes)?,
        ExportFormat::Obj => obj::write_obj(mesh, name, &mut bytes)?,
        ExportFormat::Json => json::write_json(mesh, name, &mut bytes)?,
    }
    Ok(bytes)
}

/// A coordinate or a length in units of the file: in 32 bits as the mesh has it,
/// in 64 where the mesh was moved.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(untagged)]
enum FileNumber {
    Single(f32),
    Double(f64),
}

impl fmt::Display for FileNumber {
    /// The shortest text that reads back the same.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = match *self {
            Self::Single(number) => f64::from(number).abs(),
            Self::Double(number) => number.abs(),
        };
        let is_plain = size == 0.0 || (1e-5..1e15).contains(&size);
        match (self, is_plain) {
            (Self::Single(number), true) => write!(formatter, "{number}"),
            (Self::Single(number), false) => write!(formatter, "{number:e}"),
            (Self::Double(number), true) => write!(formatter, "{number}"),
            (Self::Double(number), false) => write!(formatter, "{number:e}"),
        }
    }
}

/// A position of `mesh` in its file.
fn in_file(mesh: &EdgeMesh, position: [f32; 3]) -> [FileNumber; 3] {
    if mesh.frame.is_identity() {
        return position.map(FileNumber::Single);
    }
    mesh.frame.to_file(Vec3::from(position).as_dvec3()).to_array().map(FileNumber::Double)
}

/// A length of `mesh` in units of its file.
fn length_in_file(mesh: &EdgeMesh, length: f32) -> FileNumber {
    if mesh.frame.is_identity() {
        return FileNumber::Single(length);
    }
    FileNumber::Double(f64::from(length) / mesh.frame.scale)
}

/// The records of each edge: one, or several where more than two faces share it;
/// lines that are no edge of a face come last.
fn edges(mesh: &EdgeMesh) -> impl Iterator<Item = &[EdgeRecord]> {
    mesh.records.chunk_by(|a, b| welded_ends(mesh, a) == welded_ends(mesh, b))
}

/// The ends of an edge as the file has them, the smaller one first.
fn welded_ends(mesh: &EdgeMesh, record: &EdgeRecord) -> [u32; 2] {
    let [a, b] = [record.v0, record.v1].map(|vertex| mesh.welded_vertex(vertex));
    [a.min(b), a.max(b)]
}

/// The classes of an edge that every view draws.
fn hard_classes(records: &[EdgeRecord]) -> EdgeFlags {
    let all = records.iter().fold(EdgeFlags::empty(), |flags, record| flags | record.flags);
    all & EdgeFlags::ALWAYS_DRAWN
}

/// The vertices along a chain; those of a loop end with the first.
fn chain_vertices<'a>(mesh: &'a EdgeMesh, chain: &Chain) -> impl Iterator<Item = u32> + 'a {
    let links = &mesh.chains.links[chain.link_range()];
    let first = links.first().map(|link| link_ends(mesh, link)[0]);
    first.into_iter().chain(links.iter().map(|link| link_ends(mesh, link)[1]))
}

/// The vertices of an edge in the order of its chain.
fn link_ends(mesh: &EdgeMesh, link: &ChainLink) -> [u32; 2] {
    let EdgeRecord { v0, v1, .. } = mesh.records[link.record as usize];
    if link.is_reversed == 1 { [v1, v0] } else { [v0, v1] }
}

/// A name for a file whose statements end with their lines.
fn one_line(name: &str) -> String {
    name.replace(char::is_control, " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_files_tell_the_format() {
        let format = |name: &str| ExportFormat::of_name(Path::new(name));
        for expected in ExportFormat::ALL {
            assert_eq!(format(&format!("a.b/c.{}", expected.as_str())), Some(expected));
        }
        assert_eq!(format("A.GlTF"), Some(ExportFormat::Gltf));
        for name in ["glb", "a.stl", "a.glb.txt", ""] {
            assert_eq!(format(name), None, "{name}");
        }
    }

    #[test]
    fn numbers_are_as_short_as_they_can_be() {
        let text = |number: f32| FileNumber::Single(number).to_string();
        assert_eq!([0.0, -0.0, 1.0, -0.1, 1e-7].map(text), ["0", "-0", "1", "-0.1", "1e-7"]);
        assert_eq!(text(f32::MAX), "3.4028235e38");
        assert_eq!(FileNumber::Double(0.1 + 0.2).to_string(), "0.30000000000000004");
        assert_eq!(FileNumber::Double(-4e-40).to_string(), "-4e-40");
    }

    #[test]
    fn names_stay_in_their_line() {
        assert_eq!(one_line("gr\u{fc}n \"a\"\r\nf 1 2 3"), "gr\u{fc}n \"a\"  f 1 2 3");
    }
}
