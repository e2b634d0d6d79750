//! What one eye sees of a scene.
//!
//! - `frame`: the uniform of a view (eye, light, picture), and that of an object in it.
//! - `view_state`: the buffers of one eye.
//! - `tile`: a part of a picture that is too large to be drawn at once.
//! - `detect`: which edges are drawn.
//! - `live_lists`: the lists of those edges.

pub(crate) mod detect;
pub(crate) mod frame;
pub(crate) mod live_lists;
pub(crate) mod tile;
pub(crate) mod view_state;
