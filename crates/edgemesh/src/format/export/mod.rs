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
mod edge_visibility;
mod file_number;
mod format;
mod gltf;
mod json;
mod lines;
mod obj;
mod one_line;
mod ply;
mod write;

pub use format::ExportFormat;
pub use write::to_bytes;
