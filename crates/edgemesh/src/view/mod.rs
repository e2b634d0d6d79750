//! What one view makes of an edge mesh, on the CPU.
//!
//! - [`camera`]: the eye and the clip-space matrix, the same for every command.
//! - [`projection`]: from clip space to pixels.
//! - [`facing`]: which side of a face the eye is on.
//! - [`feature`]: which edges are features of the view.
//! - [`feature_counts`]: how many of each class there are.

pub mod camera;
pub mod facing;
pub mod feature;
pub mod feature_counts;
pub mod projection;
