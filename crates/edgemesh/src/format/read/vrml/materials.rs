//! Materials, once each in the order of their use.
//!
//! Exporters write one material for each shape; those of equal names and values
//! are one here, since a border between materials is a line of the drawing.
//!
//! VRML does not say how its colours are coded, and programs show its numbers as
//! they are: they are display values, and kept. A shininess of 1 stands for the
//! exponent 128 (VRML 97 4.14.4), and the ambient colour of VRML 97 is a part of
//! the diffuse one.

use super::document::{NodeRef, Numbers};
use super::lists::to_f32;
use super::scene::Scene;
use crate::index::to_u32;
use crate::model::{Material, Texture};

/// The specular exponent at a shininess of 1.
const FULL_SHININESS: f64 = 128.0;

/// All that tells materials apart: the name, the texture, and the bits of the
/// numbers.
#[derive(Debug, PartialEq, Eq, Hash)]
pub(super) struct MaterialKey {
    name: String,
    texture: Option<Texture>,
    colors: [Option<[u32; 3]>; 3],
    numbers: [Option<u32>; 2],
}

impl MaterialKey {
    fn of(material: &Material) -> Self {
        let colors = [material.ambient, material.diffuse, material.specular];
        Self {
            name: material.name.clone(),
            texture: material.diffuse_texture.clone(),
            colors: colors.map(|color| color.map(|color| color.map(f32::to_bits))),
            numbers: [material.shininess, material.opacity].map(|number| number.map(f32::to_bits)),
        }
    }
}

impl Scene<'_> {
    /// The index of a material in the model.
    pub(super) fn material(&mut self, material: Material) -> u32 {
        let materials = &mut self.model.materials;
        *self.materials.entry(MaterialKey::of(&material)).or_insert_with(|| {
            materials.push(material);
            to_u32(materials.len() - 1)
        })
    }
}

/// What a VRML 97 `Appearance` says; `None` where it says nothing.
pub(super) fn of_appearance(scene: &mut Scene, appearance: NodeRef) -> Option<Material> {
    let texture = appearance.node_of("texture");
    let diffuse_texture = texture.and_then(|node| scene.texture(node, "url"));
    if diffuse_texture.is_some()
        && let Some(transform) = appearance.node_of("textureTransform")
    {
        scene.warn_unread(transform);
    }
    let Some(node) = appearance.node_of("material") else {
        return diffuse_texture
            .map(|texture| Material { diffuse_texture: Some(texture), ..Material::default() });
    };
    let diffuse = node.vector("diffuseColor", [0.8; 3]);
    let ambient = node.number("ambientIntensity", 0.2);
    Some(Material {
        name: name_of(node),
        ambient: Some(diffuse.map(|part| to_f32(part * ambient))),
        diffuse: Some(diffuse.map(to_f32)),
        specular: Some(node.vector("specularColor", [0.0; 3]).map(to_f32)),
        shininess: Some(to_f32(node.number("shininess", 0.2) * FULL_SHININESS)),
        opacity: Some(to_f32(1.0 - node.number("transparency", 0.0))),
        diffuse_texture,
    })
}

/// The material number `at` of a VRML 1.0 `Material`, whose fields are lists.
/// Where a list is shorter it begins again.
pub(super) fn of_lists(node: Option<NodeRef>, texture: Option<&Texture>, at: usize) -> Material {
    let diffuse_texture = texture.cloned();
    let Some(node) = node else { return Material { diffuse_texture, ..Material::default() } };
    let color = |field, default: f64| {
        let found = repeated(node.numbers(field).chunks::<3>(), at);
        Some(found.unwrap_or([default; 3]).map(to_f32))
    };
    let number = |field, default| {
        let Numbers { values, .. } = node.numbers(field);
        repeated(values, at).unwrap_or(default)
    };
    Material {
        name: name_of(node),
        ambient: color("ambientColor", 0.2),
        diffuse: color("diffuseColor", 0.8),
        specular: color("specularColor", 0.0),
        shininess: Some(to_f32(number("shininess", 0.2) * FULL_SHININESS)),
        opacity: Some(to_f32(1.0 - number("transparency", 0.0))),
        diffuse_texture,
    }
}

fn repeated<T: Copy>(list: &[T], at: usize) -> Option<T> {
    list.get(at.checked_rem(list.len())?).copied()
}

fn name_of(node: NodeRef) -> String {
    node.name().map(|name| name.to_string()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use crate::format::read::vrml::tests::sound;
    use crate::index::NONE;
    use crate::model::Material;

    fn indices(text: &str) -> (Vec<Material>, Vec<u32>) {
        let model = sound(text);
        let mut indices = model.per_polygon(|run| run.material);
        // One for each box.
        indices.dedup();
        (model.materials, indices)
    }

    #[test]
    fn appearances_have_the_defaults_of_the_specification() {
        let text = "Shape { geometry Box { } }
            Shape { appearance Appearance { } geometry Box { } }
            Shape { appearance Appearance { material DEF M Material { } } geometry Box { } }
            Shape { appearance Appearance { material Material { diffuseColor 1 0.5 0
            ambientIntensity 0.5 specularColor 0 0 1 shininess 0.5 transparency 0.25 } }
            geometry Box { } }";
        let (materials, indices) = indices(text);
        assert_eq!(indices, [NONE, 0, 1]);
        let expected = Material {
            name: "M".into(),
            ambient: Some([0.16; 3]),
            diffuse: Some([0.8; 3]),
            specular: Some([0.0; 3]),
            shininess: Some(25.6),
            opacity: Some(1.0),
            diffuse_texture: None,
        };
        assert_eq!(materials[0], expected);
        let expected = Material {
            name: String::new(),
            ambient: Some([0.5, 0.25, 0.0]),
            diffuse: Some([1.0, 0.5, 0.0]),
            specular: Some([0.0, 0.0, 1.0]),
            shininess: Some(64.0),
            opacity: Some(0.75),
            diffuse_texture: None,
        };
        assert_eq!(materials[1], expected);
    }

    #[test]
    fn equal_materials_are_one() {
        let shape = "Shape { appearance Appearance { material Material { shininess 1 } }
            geometry Box { } }";
        let (materials, indices) = indices(&shape.repeat(3));
        assert_eq!((materials.len(), indices), (1, vec![0]));
    }

    #[test]
    fn lists_of_materials_go_by_face() {
        let scene = |binding: &str, index: &str| {
            indices(&format!(
                "#VRML V1.0 ascii\nMaterial {{ diffuseColor [ 1 0 0, 0 1 0 ] transparency 0.5 }}
                 MaterialBinding {{ value {binding} }}
                 Coordinate3 {{ point [ 0 0 0, 1 0 0, 0 1 0 ] }}
                 IndexedFaceSet {{ coordIndex [ 0,1,2,-1, 0,1,2,-1, 0,1,2 ] {index} }}"
            ))
        };
        let (materials, numbers) = scene("PER_FACE", "");
        assert_eq!(numbers, [0, 1, 0], "the list begins again");
        assert_eq!(materials[1].diffuse, Some([0.0, 1.0, 0.0]));
        assert_eq!((materials[1].opacity, materials[1].ambient), (Some(0.5), Some([0.2; 3])));
        assert_eq!(scene("OVERALL", "").1, [0]);
        let (materials, _) = scene("PER_FACE_INDEXED", "materialIndex [ 1, 1, 0 ]");
        assert_eq!(materials[0].diffuse, Some([0.0, 1.0, 0.0]));
        assert_eq!(materials[1].diffuse, Some([1.0, 0.0, 0.0]));
    }
}
