//! The content of a model file, before it is built: polygons and lines with their attributes,
//! materials with their textures, and the rig (skins and morph targets).

mod material;
mod polygon_model;
mod rig;

pub(crate) use self::material::MAX_PICTURE_BYTES;
pub use self::material::{Material, Texture, TextureSource};
pub(crate) use self::polygon_model::WHITE;
pub use self::polygon_model::{
    Attributes, Corner, InstancedModel, Model, PolygonRun, Segment, Smoothing, StatedClasses,
    StatedEdge,
};
pub use self::rig::{
    Displacement, Influence, MeshRig, NodeTransform, Pose, Rig, RigNode, RigPart, Skin,
};
