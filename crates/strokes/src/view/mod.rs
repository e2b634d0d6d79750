//! What one eye sees of a scene.
//!
//! - [`frame`]: the eye, the light and the picture, as shaders know them.
//! - [`view_state`]: what the GPU keeps for one eye.
//! - [`tile`]: a part of a picture that is too large to be drawn at once.
//! - [`detect`]: which edges are drawn.
//! - [`live_lists`]: the lists of those edges.

pub mod detect;
pub mod frame;
pub mod live_lists;
pub mod tile;
pub mod view_state;
