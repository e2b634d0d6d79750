//! The `Appearance` node of VRML 97: a material and a texture.

use super::materials::of_node;
use super::scene_builder::SceneBuilder;
use crate::format::read::vrml::parse::NodeRef;
use crate::model::Material;

/// The material of an `Appearance` node; `None` if it has neither a material nor a
/// texture.
pub(super) fn appearance(builder: &mut SceneBuilder, node: NodeRef) -> Option<Material> {
    let texture = node.node_of("texture");
    let diffuse_texture = texture.and_then(|node| builder.texture(node, "url"));
    if diffuse_texture.is_some()
        && let Some(transform) = node.node_of("textureTransform")
    {
        builder.warn_unsupported(transform);
    }
    match node.node_of("material") {
        Some(material) => Some(of_node(material, diffuse_texture)),
        None if diffuse_texture.is_some() => {
            Some(Material { diffuse_texture, ..Material::default() })
        }
        None => None,
    }
}
