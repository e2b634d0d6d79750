//! From lists and ribbons to pixels.
//!
//! - `expand`: the vertices of each live stroke, once.
//! - [`fill`]: surfaces, which hide lines.
//! - [`stroke`]: strokes edge by edge.
//! - [`coverage`]: linked strokes, each pixel once.
//! - [`silhouette`]: strokes against what is not their object.
//! - [`targets`]: what is drawn into.

pub mod coverage;
pub(crate) mod expand;
pub mod fill;
pub mod silhouette;
pub mod stroke;
pub(crate) mod stroke_indices;
pub(crate) mod stroke_layouts;
pub mod targets;
