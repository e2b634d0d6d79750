//! Materials: metallic-roughness converted to Phong.
//!
//! Based on: glTF 2.0, section 3.9.2 (metallic-roughness) and appendix B.
//!
//! A [`Material`] has the parameters of Phong shading, with sRGB colors. They are
//! computed from the linear factors of metallic-roughness, with m the metallic one:
//!
//! ```text
//! diffuse    sRGB(base (1 - m / 2))
//! specular   sRGB((0.04 (1 - m) + base m) (1 - roughness))
//! shininess  2 / a^2 - 2, from 1 to 1000, where a = roughness^2
//! ambient    none
//! ```
//!
//! The specular color is the reflectance at normal incidence, reduced with the
//! roughness: wide highlights of Phong are as bright as narrow ones, those of a rough
//! surface are not. The exponent is that of a Blinn-Phong highlight as wide as that
//! of the roughness. A metal has no diffuse color, because it mirrors its
//! environment. Without an environment it would be black except for its highlights,
//! so half of its base color stays.
//!
//! A metallic-roughness texture is not read. The factors beside it are usually 1, so
//! the surface counts as a dielectric, with the roughness of its factor.
//!
//! `KHR_materials_unlit` needs no special case: the base color is the same.

use gltf_json as json;
use json::material::AlphaMode;
use json::validation::Checked;

use crate::model::Material;

/// The reflectance of a dielectric at normal incidence.
const DIELECTRIC_REFLECTANCE: f32 = 0.04;

/// The part of the base color of a metal that is diffuse.
const DIFFUSE_OF_METAL: f32 = 0.5;

/// The range of exponents.
const LEAST_SHININESS: f32 = 1.0;
const MOST_SHININESS: f32 = 1000.0;

/// The Phong material, without its texture.
pub(super) fn material(json: &json::Material) -> Material {
    let pbr = &json.pbr_metallic_roughness;
    let [red, green, blue, alpha] = pbr.base_color_factor.0;
    let base = [red, green, blue];
    let metallic = match pbr.metallic_roughness_texture {
        None => pbr.metallic_factor.0,
        Some(_) => 0.0,
    };
    let dielectric = DIELECTRIC_REFLECTANCE * (1.0 - metallic);
    let smoothness = 1.0 - pbr.roughness_factor.0.clamp(0.0, 1.0);
    // Alpha has a meaning only in blended materials.
    let is_blended = matches!(json.alpha_mode, Checked::Valid(AlphaMode::Blend));
    Material {
        name: json.name.clone().unwrap_or_default(),
        ambient: None,
        diffuse: Some(base.map(|part| srgb(part * (1.0 - metallic * (1.0 - DIFFUSE_OF_METAL))))),
        specular: Some(base.map(|part| srgb((dielectric + part * metallic) * smoothness))),
        shininess: Some(shininess(pbr.roughness_factor.0)),
        opacity: Some(if is_blended { alpha } else { 1.0 }),
        diffuse_texture: None,
    }
}

/// The exponent of a highlight as wide as that of `roughness`.
fn shininess(roughness: f32) -> f32 {
    let slope = roughness * roughness;
    // Infinite for a mirror.
    (2.0 / (slope * slope) - 2.0).clamp(LEAST_SHININESS, MOST_SHININESS)
}

/// Encodes a linear color component as sRGB (IEC 61966-2-1).
pub(super) fn srgb(linear: f32) -> f32 {
    let linear = f64::from(linear.clamp(0.0, 1.0));
    let coded = match linear <= 0.003_130_8 {
        true => 12.92 * linear,
        false => 1.055 * linear.powf(1.0 / 2.4) - 0.055,
    };
    #[expect(clippy::cast_possible_truncation, reason = "colors have 32 bits")]
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
    fn colors_are_srgb() {
        let values = [-1.0, 0.0, 0.001, 0.04, 0.214_041, 0.5, 1.0, 7.0].map(srgb);
        let expected = [0.0, 0.0, 0.012_92, 0.220_916, 0.5, 0.735_357, 1.0, 1.0];
        let is_close = values.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-5);
        assert!(is_close, "{values:?}");
        assert_eq!((srgb(0.0), srgb(1.0)), (0.0, 1.0));
    }

    #[test]
    fn a_dielectric_has_its_base_color_and_a_gray_highlight() {
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
    fn a_metal_has_a_highlight_of_its_base_color_and_is_not_black() {
        let gold = parsed(
            r#"{"pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0, 1],
                "metallicFactor": 1, "roughnessFactor": 0.25}}"#,
        );
        assert_close(gold.specular, [0.880_825, 0.646_077, 0.0]);
        assert_close(gold.diffuse, [0.735_357, 0.537_099, 0.0]);
        assert_eq!(gold.shininess, Some(510.0));
        assert_eq!(gold.opacity, Some(1.0), "the alpha of an opaque material is ignored");
        let plain = parsed("{}");
        assert_eq!((plain.name.as_str(), plain.shininess), ("", Some(1.0)));
        assert_close(plain.specular, [0.0; 3]);
    }

    #[test]
    fn a_metallic_roughness_texture_stands_for_a_dielectric() {
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
