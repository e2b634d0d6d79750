//! From lists and ribbons to pixels.
//!
//! - `expand`: the vertices of each live stroke, once.
//! - `fill`: surfaces, which hide lines.
//! - `stroke`, with `stroke_layouts` and `stroke_indices`: strokes edge by edge.
//! - `coverage`: linked strokes, each pixel once.
//! - `silhouette`: stencil values, which tell objects apart.
//! - `targets`: the textures that are drawn into.

pub(crate) mod coverage;
pub(crate) mod expand;
pub(crate) mod fill;
pub(crate) mod silhouette;
pub(crate) mod stroke;
pub(crate) mod stroke_indices;
pub(crate) mod stroke_layouts;
pub(crate) mod targets;
