//! Materials by name, with the colour that lines and fills can use.

use gltf_json as json;
use json::material::AlphaMode;
use json::validation::Checked;

use crate::model::Material;

/// The material as the model has it.
///
/// The factor alone: textures are not opened, and how metallic or rough a
/// surface is has no counterpart in a specular colour and exponent.
pub(super) fn material(json: &json::Material) -> Material {
    let [red, green, blue, alpha] = json.pbr_metallic_roughness.base_color_factor.0;
    // Only where it is blended does the alpha of a material mean anything.
    let is_blended = matches!(json.alpha_mode, Checked::Valid(AlphaMode::Blend));
    Material {
        name: json.name.clone().unwrap_or_default(),
        diffuse: Some([red, green, blue]),
        opacity: Some(if is_blended { alpha } else { 1.0 }),
        ..Material::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(json: &str) -> Material {
        material(&serde_json::from_str(json).unwrap())
    }

    #[test]
    fn colours_come_from_the_base_colour_factor() {
        let glass = parsed(
            r#"{"name": "glass", "alphaMode": "BLEND",
                "pbrMetallicRoughness": {"baseColorFactor": [0.25, 0.5, 1, 0.125]}}"#,
        );
        assert_eq!((glass.name.as_str(), glass.diffuse), ("glass", Some([0.25, 0.5, 1.0])));
        assert_eq!(glass.opacity, Some(0.125));
        let opaque = parsed(r#"{"pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0]}}"#);
        assert_eq!(opaque.opacity, Some(1.0), "an opaque material has no alpha");
        let plain = parsed("{}");
        assert_eq!((plain.name.as_str(), plain.diffuse), ("", Some([1.0; 3])));
    }
}
