//! From a scene and a technique to pictures in files.
//!
//! - [`renderer`]: one picture.
//! - [`tiles`]: a picture of any size, in tiles if it is too large for a texture.
//! - [`turntable`]: a camera that goes around.
//! - [`png`], [`animation`]: pictures as files.

pub mod animation;
pub mod png;
pub mod renderer;
pub mod tiles;
pub mod turntable;
