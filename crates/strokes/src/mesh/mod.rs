//! Edge meshes on the GPU.
//!
//! - [`layout`]: how edges lie in memory.
//! - [`buffers`]: a mesh, uploaded.
//! - `chunk`: its parts, where a binding cannot hold it.
//! - [`link_table`]: which edge follows which.

pub mod buffers;
mod chunk;
pub mod layout;
pub mod link_table;
