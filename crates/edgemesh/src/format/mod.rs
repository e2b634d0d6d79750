//! Reads and writes files.
//!
//! - [`read`]: reads model files of all formats, with errors by file and line.
//! - [`mod@edge_mesh_file`]: reads and writes edge mesh files, whose lists are used in place.
//! - [`export`]: writes edge meshes for other programs: glTF, PLY, OBJ, JSON.
//! - `validate`: warns of rules of a format that a readable file breaks.
//! - `regular_file`: opens regular files, no pipes and devices.
//! - [`whole_file`]: writes a file whole or not at all.

mod edge_classes;
pub mod edge_mesh_file;
pub mod export;
mod little_endian;
pub mod read;
pub(crate) mod regular_file;
pub(crate) mod validate;
pub mod whole_file;
