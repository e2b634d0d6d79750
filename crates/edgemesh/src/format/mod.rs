//! Files in and out.
//!
//! - [`read`]: model files of all formats, every error with file and line.
//! - [`mod@edge_mesh_file`]: edge meshes on disk, with a checksum, used where they lie.
//! - [`export`]: the mesh and its edges for other programs: glTF, PLY, OBJ, JSON.
//! - [`whole_file`]: files that are written whole or not at all.

pub mod edge_mesh_file;
pub mod export;
pub mod read;
pub mod whole_file;
