//! Edge meshes on the GPU.
//!
//! - [`layout`]: how edges lie in memory.
//! - [`buffers`]: a mesh, uploaded; [`geometry`]: what a pose moves of it; [`surface`]: its
//!   triangles with material ranges.
//! - [`instance`]: a mesh in its place.
//! - `chunk`: parts of a mesh that fit a binding; `capacity`: how much room each gets.
//! - [`link_table`]: which edge follows which.

pub mod buffers;
pub(crate) mod capacity;
mod chunk;
pub mod geometry;
pub mod instance;
pub mod layout;
pub mod link_table;
pub mod surface;

pub use self::buffers::{MeshBuffers, MeshOptions, MeshTooLarge};
pub use self::instance::MeshInstance;
pub use self::layout::Layout;
