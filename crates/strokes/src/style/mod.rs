//! What lines look like.
//!
//! - [`drawing_style`]: the layers of a drawing, with a stroke style each.
//! - [`link_style`]: how edges are linked into strokes.
//! - [`brush`]: stroke textures.

pub mod brush;
pub mod drawing_style;
pub mod link_style;
