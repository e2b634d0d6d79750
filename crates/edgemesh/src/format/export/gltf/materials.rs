//! Materials with their textures, from Phong to metallic-roughness.
//!
//! Based on: glTF 2.0, sections 3.8 (textures) and 3.9 (materials). The inverse of the reader
//! (`format/read/gltf/material.rs`), for dielectrics:
//!
//! ```text
//! base color  linear(diffuse), with the opacity as alpha
//! roughness   (2 / (shininess + 2))^(1/4)
//! ```
//!
//! The specular color and the ambient color have no place there. Pictures become part of the
//! file, because a name of a file elsewhere would not be found from the place of the export.

use std::io;

use indexmap::IndexSet;
use serde_json::{Value, json};

use super::binary_data::BinaryData;
use crate::model::{Material, Texture};

/// The lists of a document that describe materials.
pub(super) struct MaterialLists {
    pub(super) materials: Vec<Value>,
    pub(super) textures: Vec<Value>,
    pub(super) images: Vec<Value>,
}

impl MaterialLists {
    /// The lists for `materials`, in their order. The pictures are added to `data`.
    ///
    /// # Errors
    /// Fails if a picture cannot be read.
    pub(super) fn new(materials: &[Material], data: &mut BinaryData) -> io::Result<Self> {
        let used = materials.iter().filter_map(|material| material.diffuse_texture.as_ref());
        let pictures: IndexSet<&Texture> = used.collect();
        let images = pictures.iter().map(|picture| image(picture, data));
        let images = images.collect::<io::Result<Vec<Value>>>()?;
        let textures = (0..images.len()).map(|image| json!({"source": image})).collect();
        let texture_of = |material: &Material| {
            material.diffuse_texture.as_ref().and_then(|picture| pictures.get_index_of(picture))
        };
        let materials = materials.iter().map(|own| material(own, texture_of(own))).collect();
        Ok(Self { materials, textures, images })
    }
}

fn image(picture: &Texture, data: &mut BinaryData) -> io::Result<Value> {
    let unreadable = |error: io::Error| {
        io::Error::new(
            error.kind(),
            format!("the texture '{}' cannot be read: {error}", picture.name),
        )
    };
    let bytes = picture.source.encoded().map_err(unreadable)?;
    let kind = if bytes.starts_with(b"\x89PNG") { "image/png" } else { "image/jpeg" };
    let view = data.push_view(bytes.iter().copied());
    Ok(json!({"name": picture.name, "mimeType": kind, "bufferView": view}))
}

fn material(material: &Material, texture: Option<usize>) -> Value {
    let Material { name, diffuse, shininess, opacity, .. } = material;
    let [red, green, blue] = diffuse.unwrap_or([1.0; 3]).map(linear);
    let alpha = opacity.unwrap_or(1.0).clamp(0.0, 1.0);
    let roughness =
        shininess.map_or(1.0, |exponent| (2.0 / (exponent.max(0.0) + 2.0)).sqrt().sqrt());
    let mut surface = json!({
        "baseColorFactor": [red, green, blue, alpha],
        "metallicFactor": 0.0,
        "roughnessFactor": roughness
    });
    if let Some(index) = texture {
        surface["baseColorTexture"] = json!({"index": index});
    }
    let mut material = json!({"pbrMetallicRoughness": surface});
    if !name.is_empty() {
        material["name"] = name.as_str().into();
    }
    if alpha < 1.0 {
        material["alphaMode"] = "BLEND".into();
    }
    material
}

/// The linear value of an sRGB color component (IEC 61966-2-1).
pub(super) fn linear(coded: f32) -> f32 {
    let coded = f64::from(coded.clamp(0.0, 1.0));
    let linear = match coded <= 0.040_45 {
        true => coded / 12.92,
        false => ((coded + 0.055) / 1.055).powf(2.4),
    };
    #[expect(clippy::cast_possible_truncation, reason = "colors have 32 bits")]
    let linear = linear as f32;
    linear
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::TextureSource;

    #[test]
    fn colors_are_linear_and_highlights_have_their_width() {
        let glass = Material {
            name: "glass".into(),
            diffuse: Some([0.0, 0.5, 1.0]),
            shininess: Some(30.0),
            opacity: Some(0.25),
            ..Material::default()
        };
        let written = material(&glass, None);
        let surface = &written["pbrMetallicRoughness"];
        let color = surface["baseColorFactor"].as_array().unwrap();
        let expected = [0.0, 0.214_041, 1.0, 0.25];
        for (found, expected) in color.iter().zip(expected) {
            assert!((found.as_f64().unwrap() - expected).abs() < 1e-5, "{written}");
        }
        // 2 / 0.5^4 - 2 is 30.
        assert!((surface["roughnessFactor"].as_f64().unwrap() - 0.5).abs() < 1e-6, "{written}");
        assert_eq!((&written["name"], &written["alphaMode"]), (&json!("glass"), &json!("BLEND")));
    }

    #[test]
    fn a_picture_of_two_materials_is_stored_once() {
        let source = TextureSource::Bytes(b"\x89PNG....".as_slice().into());
        let texture = Some(Texture { name: "bark".into(), source });
        let bark = Material { diffuse_texture: texture, ..Material::default() };
        let mut data = BinaryData::default();
        let lists =
            MaterialLists::new(&[bark.clone(), Material::default(), bark], &mut data).unwrap();
        assert_eq!(data.bytes, *b"\x89PNG....");
        let bark = json!({"name": "bark", "mimeType": "image/png", "bufferView": 0});
        assert_eq!((lists.images, lists.textures), (vec![bark], vec![json!({"source": 0})]));
        let texture = |k: usize| &lists.materials[k]["pbrMetallicRoughness"]["baseColorTexture"];
        assert_eq!([texture(0), texture(1)], [&json!({"index": 0}), &Value::Null]);
        let gone = Texture {
            name: "gone.png".into(),
            source: TextureSource::File("/none/gone.png".into()),
        };
        let error = image(&gone, &mut data).unwrap_err().to_string();
        assert!(error.contains("'gone.png' cannot be read"), "{error}");
    }
}
