//! Materials by name, with the looks that lines and fills can use.
//!
//! Based on: glTF 2.0, section 3.9.2 (metallic-roughness) and appendix B.
//!
//! A model has the attributes of Phong, as display values. They come from the
//! factors of metallic-roughness, which are linear, with m the metallic one:
//!
//! ```text
//! diffuse    sRGB(base (1 - m / 2))
//! specular   sRGB((0.04 (1 - m) + base m) (1 - roughness))
//! shininess  2 / a^2 - 2, from 1 to 1000, where a = roughness^2
//! ambient    none
//! ```
//!
//! The specular colour is how much a surface mirrors straight on, and less the
//! rougher it is: Phong's highlights are as bright when they are wide, which a
//! rough surface's are not. The exponent is that of Blinn and Phong whose
//! highlight is as wide as that of the roughness. A metal has no diffuse colour: it shows what is around it. Nothing
//! is around it here, and it would be black but for its highlights, so half of
//! its base colour stays.
//!
//! A picture of how metallic and rough a surface is is not read. Where there is
//! one, its factors are 1 as a rule and say nothing; the surface then counts as
//! no metal, and as rough as its factor says.
//!
//! `KHR_materials_unlit` needs nothing of its own: the base colour is there.

use gltf_json as json;
use json::material::AlphaMode;
use json::validation::Checked;

use crate::model::Material;

/// How much of light a surface that is no metal mirrors straight on.
const PLAIN_REFLECTANCE: f32 = 0.04;

/// How much of the base colour of a metal is diffuse.
const DIFFUSE_OF_METAL: f32 = 0.5;

/// The exponents that a model may have.
const LEAST_SHININESS: f32 = 1.0;
const MOST_SHININESS: f32 = 1000.0;

/// The material as the model has it, without its texture.
pub(super) fn material(json: &json::Material) -> Material {
    let looks = &json.pbr_metallic_roughness;
    let [red, green, blue, alpha] = looks.base_color_factor.0;
    let base = [red, green, blue];
    let metallic = match looks.metallic_roughness_texture {
        None => looks.metallic_factor.0,
        Some(_) => 0.0,
    };
    let plain = PLAIN_REFLECTANCE * (1.0 - metallic);
    let smoothness = 1.0 - looks.roughness_factor.0.clamp(0.0, 1.0);
    // Only where it is blended does the alpha of a material mean anything.
    let is_blended = matches!(json.alpha_mode, Checked::Valid(AlphaMode::Blend));
    Material {
        name: json.name.clone().unwrap_or_default(),
        ambient: None,
        diffuse: Some(base.map(|part| srgb(part * (1.0 - metallic * (1.0 - DIFFUSE_OF_METAL))))),
        specular: Some(base.map(|part| srgb((plain + part * metallic) * smoothness))),
        shininess: Some(shininess(looks.roughness_factor.0)),
        opacity: Some(if is_blended { alpha } else { 1.0 }),
        diffuse_texture: None,
    }
}

/// The exponent of a highlight as wide as that of a roughness.
fn shininess(roughness: f32) -> f32 {
    let slope = roughness * roughness;
    // A mirror has no end of it.
    (2.0 / (slope * slope) - 2.0).clamp(LEAST_SHININESS, MOST_SHININESS)
}

/// A linear part of a colour as a display value (IEC 61966-2-1).
fn srgb(linear: f32) -> f32 {
    let linear = f64::from(linear.clamp(0.0, 1.0));
    let coded = match linear <= 0.003_130_8 {
        true => 12.92 * linear,
        false => 1.055 * linear.powf(1.0 / 2.4) - 0.055,
    };
    #[expect(clippy::cast_possible_truncation, reason = "a colour is in 32 bits")]
    let coded = coded as f32;
    coded
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(json: &str) -> Material {
        material(&serde_json::from_str(json).unwrap())
    }

    fn assert_close(found: Option<[f32; 3]>, expected: [f32; 3]) {
        let found = found.unwrap();
        let is_close = found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-4);
        assert!(is_close, "{found:?} is not {expected:?}");
    }

    #[test]
    fn colours_are_display_values() {
        let values = [-1.0, 0.0, 0.001, 0.04, 0.214_041, 0.5, 1.0, 7.0].map(srgb);
        let expected = [0.0, 0.0, 0.012_92, 0.220_916, 0.5, 0.735_357, 1.0, 1.0];
        let is_close = values.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-5);
        assert!(is_close, "{values:?}");
        assert_eq!((srgb(0.0), srgb(1.0)), (0.0, 1.0));
    }

    #[test]
    fn a_dielectric_has_its_base_colour_and_a_grey_highlight() {
        let glass = parsed(
            r#"{"name": "glass", "alphaMode": "BLEND", "pbrMetallicRoughness": {
                "baseColorFactor": [0.25, 0.5, 1, 0.125], "metallicFactor": 0,
                "roughnessFactor": 0.5}}"#,
        );
        assert_eq!((glass.name.as_str(), glass.opacity), ("glass", Some(0.125)));
        assert_close(glass.diffuse, [0.537_099, 0.735_357, 1.0]);
        assert_close(glass.specular, [0.151_704; 3]);
        assert_eq!((glass.ambient, glass.shininess), (None, Some(30.0)), "2 / 0.25^2 - 2");
    }

    #[test]
    fn a_metal_mirrors_its_base_colour_and_is_not_black() {
        let gold = parsed(
            r#"{"pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0, 1],
                "metallicFactor": 1, "roughnessFactor": 0.25}}"#,
        );
        assert_close(gold.specular, [0.880_825, 0.646_077, 0.0]);
        assert_close(gold.diffuse, [0.735_357, 0.537_099, 0.0]);
        assert_eq!(gold.shininess, Some(510.0));
        assert_eq!(gold.opacity, Some(1.0), "an opaque material has no alpha");
        let plain = parsed("{}");
        assert_eq!((plain.name.as_str(), plain.shininess), ("", Some(1.0)));
        assert_close(plain.specular, [0.0; 3]);
    }

    #[test]
    fn a_picture_of_metal_and_roughness_is_no_metal() {
        let mapped =
            parsed(r#"{"pbrMetallicRoughness": {"metallicRoughnessTexture": {"index": 0}}}"#);
        assert_close(mapped.diffuse, [1.0; 3]);
        assert_close(mapped.specular, [0.0; 3]);
    }

    #[test]
    fn exponents_stay_within_their_bounds() {
        let exponents = [0.0, 0.1, 0.75, 1.0, 3.0].map(shininess);
        assert_eq!(exponents[..2], [1000.0; 2]);
        assert!((exponents[2] - 4.320_987).abs() < 1e-4, "{exponents:?}");
        assert_eq!(exponents[3..], [1.0; 2]);
    }
}
