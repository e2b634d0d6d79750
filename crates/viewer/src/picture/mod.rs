//! From a scene and a technique to picture files.
//!
//! - `renderer`: one picture.
//! - `tiles`: a picture of any size, in tiles if it is too large for a texture.
//! - `turntable`: a camera that turns around the scene.
//! - `png`, `animation`: picture files.

pub(crate) mod animation;
pub mod png;
pub mod renderer;
pub mod tiles;
pub(crate) mod turntable;
