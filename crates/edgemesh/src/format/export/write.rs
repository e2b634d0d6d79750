//! Writes an edge mesh in any of the formats.

use std::io;
use std::path::Path;

use super::format::ExportFormat;
use super::parts::Parts;
use super::{gltf, json, mtl, obj, ply};
use crate::edge_mesh::EdgeMesh;
use crate::index::NONE;
use crate::report::Report;

/// The bytes of a file with `mesh`; `name` is its name in the file.
///
/// # Errors
/// [`FileTooLarge`](io::ErrorKind::FileTooLarge) for a GLB file of 4 GiB or more, whose
/// length does not fit into its header. Fails if a picture of a material cannot be read.
pub fn to_bytes(mesh: &EdgeMesh, name: &str, format: ExportFormat) -> io::Result<Vec<u8>> {
    to_bytes_with(mesh, Parts::default(), name, format)
}

/// As [`to_bytes`], with what glTF alone has; other formats leave it out.
///
/// # Errors
/// As [`to_bytes`].
pub fn to_bytes_with(
    mesh: &EdgeMesh,
    parts: Parts,
    name: &str,
    format: ExportFormat,
) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    match format {
        ExportFormat::Glb => gltf::write_glb(mesh, parts, name, &mut bytes)?,
        ExportFormat::Gltf => gltf::write_gltf(mesh, parts, name, &mut bytes)?,
        ExportFormat::Ply => ply::write_ply(mesh, name, &mut bytes)?,
        ExportFormat::Obj => obj::write_obj(mesh, name, None, &mut bytes)?,
        ExportFormat::Json => json::write_json(mesh, name, &mut bytes)?,
    }
    Ok(bytes)
}

/// The bytes of an OBJ file that names `library` as its material library.
///
/// # Errors
/// None: writing to memory does not fail.
pub fn obj_with_library(mesh: &EdgeMesh, name: &str, library: &str) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    obj::write_obj(mesh, name, Some(library), &mut bytes)?;
    Ok(bytes)
}

/// The material library (MTL) of an OBJ file in `folder`; `None` if no triangle has a material.
/// Textures that it cannot name are warnings in `report`.
#[must_use]
pub fn material_library(mesh: &EdgeMesh, folder: &Path, report: &mut Report) -> Option<String> {
    let is_used = mesh.fill.runs.iter().any(|run| run.material != NONE);
    is_used.then(|| mtl::library(&mesh.fill.materials, folder, report))
}
