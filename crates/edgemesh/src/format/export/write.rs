//! Writes an edge mesh in any of the formats.

use std::io;

use super::format::ExportFormat;
use super::{gltf, json, obj, ply};
use crate::edge_mesh::EdgeMesh;

/// The bytes of a file with `mesh`; `name` is its name in the file.
///
/// # Errors
/// [`FileTooLarge`](io::ErrorKind::FileTooLarge) for a GLB file of 4 GiB or more, whose
/// length does not fit into its header.
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
