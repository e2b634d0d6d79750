//! What a file says, before anything is made of it.
//!
//! - [`polygon_model`]: polygons, lines and their attributes.
//! - [`material`]: materials and their textures.
//! - [`rig`]: skins and morph targets.

pub mod material;
pub mod polygon_model;
pub mod rig;

pub use self::material::{MAX_PICTURE_BYTES, Material, Texture, TextureSource};
pub use self::polygon_model::{Attributes, Corner, Model, PolygonRun, Segment, Smoothing};
