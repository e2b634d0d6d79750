//! Writes edge meshes for other programs.
//!
//! ```text
//!             glTF, GLB   triangles, hard edges and lines, silhouettes with
//!            /            their normals (EXT_mesh_primitive_edge_visibility)
//! EdgeMesh --- PLY        triangles, hard edges with colors and class bits
//!            \ OBJ        triangles, hard edges as a polyline for each chain
//!             JSON        the whole edge mesh, with words for the classes
//! ```
//!
//! The readers of this project give the edges of all but JSON, which they do not read, their
//! classes back (`format/edge_classes.rs`). Texture coordinates are in all but JSON,
//! materials in glTF and, with a library beside it, in OBJ, skins, morph targets and
//! instances in glTF.
//!
//! In the words of the glTF extension, a *hard* edge is drawn in every view, and a
//! *silhouette* edge is another one that some view draws. An edge of more than two
//! faces has several records, and perhaps copies of its vertices, but is one edge
//! here.
//!
//! Positions and lengths are in the units of the model file. If the mesh has a frame
//! ([`MeshFrame`](crate::edge_mesh::MeshFrame)), they have 64 bits. glTF has only 32, so
//! there the positions stay in the frame, and the node has its transform.
//!
//! Equal meshes give equal bytes.

mod edge_records;
mod face_runs;
mod file_number;
mod format;
mod gltf;
mod json;
mod lines;
mod mtl;
mod names;
mod obj;
mod one_line;
mod parts;
mod ply;
mod vertices;
mod write;

pub use format::ExportFormat;
pub use mtl::LIBRARY_HEAD;
pub use parts::Parts;
pub use write::{material_library, obj_with_library, to_bytes, to_bytes_with};
