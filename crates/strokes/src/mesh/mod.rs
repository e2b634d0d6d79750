//! Edge meshes on the GPU.
//!
//! - `layout`: how edges lie in memory.
//! - `buffers`: an uploaded mesh; `geometry`: its positions and normals, which a pose can write;
//!   `surface`: its triangles with material ranges.
//! - `instance`: a mesh in its place.
//! - `chunk`: parts of a mesh that fit a binding; `capacity`: how much room each gets.
//! - `link_table`: which edge follows which.

pub(crate) mod buffers;
pub(crate) mod capacity;
mod chunk;
pub(crate) mod geometry;
pub(crate) mod instance;
pub(crate) mod layout;
pub(crate) mod link_table;
pub(crate) mod surface;
