//! Files in and out.
//!
//! - [`read`]: model files of all formats, every error with file and line.
//! - [`mod@edge_mesh_file`]: edge meshes on disk, with a checksum, used where they lie.
//! - [`export`]: the mesh and its edges for other programs: glTF, PLY, OBJ, JSON.

pub mod edge_mesh_file;
pub mod export;
mod little_endian;
pub mod read;
pub(crate) mod validate;
