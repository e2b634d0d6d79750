//! The look of lines.
//!
//! - `drawing_style`: the layers of a drawing, with a stroke style each.
//! - `link_style`: how edges are linked into strokes.
//! - `brush`: stroke textures.

pub(crate) mod brush;
pub(crate) mod drawing_style;
pub(crate) mod link_style;
