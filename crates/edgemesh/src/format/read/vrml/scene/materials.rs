//! Materials of both versions.
//!
//! Exporters often write one material for each shape. Those with equal names and values
//! become one material, because a boundary between materials is drawn.
//!
//! VRML does not define the encoding of colors, and programs display its numbers
//! directly. So they are kept as sRGB. A shininess of 1 is the exponent 128 (VRML 97
//! 4.14.4), and the ambient color of VRML 97 is a fraction of the diffuse color.

use super::number_list::to_f32;
use crate::format::read::vrml::parse::{NodeRef, Numbers};
use crate::model::{Material, Texture};

/// The specular exponent of a shininess of 1.
const FULL_SHININESS: f64 = 128.0;

/// The value of a material, for comparison: its name, its texture, and the bits of its
/// numbers.
#[derive(Debug, PartialEq, Eq, Hash)]
pub(super) struct MaterialKey {
    name: String,
    texture: Option<Texture>,
    colors: [Option<[u32; 3]>; 3],
    numbers: [Option<u32>; 2],
}

impl MaterialKey {
    pub(super) fn of(material: &Material) -> Self {
        let colors = [material.ambient, material.diffuse, material.specular];
        Self {
            name: material.name.clone(),
            texture: material.diffuse_texture.clone(),
            colors: colors.map(|color| color.map(|color| color.map(f32::to_bits))),
            numbers: [material.shininess, material.opacity].map(|number| number.map(f32::to_bits)),
        }
    }
}

/// The material of a VRML 97 `Material` node.
pub(super) fn of_node(node: NodeRef, diffuse_texture: Option<Texture>) -> Material {
    let diffuse = node.vector("diffuseColor", [0.8; 3]);
    let ambient = node.number("ambientIntensity", 0.2);
    Material {
        name: name_of(node),
        ambient: Some(diffuse.map(|part| to_f32(part * ambient))),
        diffuse: Some(diffuse.map(to_f32)),
        specular: Some(node.vector("specularColor", [0.0; 3]).map(to_f32)),
        shininess: Some(to_f32(node.number("shininess", 0.2) * FULL_SHININESS)),
        opacity: Some(to_f32(1.0 - node.number("transparency", 0.0))),
        diffuse_texture,
    }
}

/// The material number `at` of a VRML 1.0 `Material` node, whose fields are lists. A
/// shorter list is repeated.
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
    fn lists_of_materials_are_for_faces() {
        let scene = |binding: &str, index: &str| {
            indices(&format!(
                "#VRML V1.0 ascii\nMaterial {{ diffuseColor [ 1 0 0, 0 1 0 ] transparency 0.5 }}
                 MaterialBinding {{ value {binding} }}
                 Coordinate3 {{ point [ 0 0 0, 1 0 0, 0 1 0 ] }}
                 IndexedFaceSet {{ coordIndex [ 0,1,2,-1, 0,1,2,-1, 0,1,2 ] {index} }}"
            ))
        };
        let (materials, numbers) = scene("PER_FACE", "");
        assert_eq!(numbers, [0, 1, 0], "the list is repeated");
        assert_eq!(materials[1].diffuse, Some([0.0, 1.0, 0.0]));
        assert_eq!((materials[1].opacity, materials[1].ambient), (Some(0.5), Some([0.2; 3])));
        assert_eq!(scene("OVERALL", "").1, [0]);
        let (materials, _) = scene("PER_FACE_INDEXED", "materialIndex [ 1, 1, 0 ]");
        assert_eq!(materials[0].diffuse, Some([0.0, 1.0, 0.0]));
        assert_eq!(materials[1].diffuse, Some([1.0, 0.0, 0.0]));
    }
}
