//! What a file says, before anything is made of it.
//!
//! - [`polygon_model`]: polygons, lines and their attributes.
//! - [`material`]: materials and their textures.
//! - [`rig`]: skins and morph targets.

mod material;
mod polygon_model;
mod rig;

pub(crate) use self::material::MAX_PICTURE_BYTES;
pub use self::material::{Material, Texture, TextureSource};
pub use self::polygon_model::{Attributes, Corner, Model, PolygonRun, Segment, Smoothing};
pub use self::rig::{Displacement, Influence, NodeTransform, Pose, Rig, RigNode, RigPart, Skin};
