//! Materials for shaders, with defaults for values that a model does not have.

use bytemuck::{Pod, Zeroable};
use edgemesh::edge_mesh::FillMesh;
use edgemesh::model::Material;

use crate::scene::models::Scene;

/// A material for the Phong model. WGSL twin: `Material` in
/// `shaders/common/surface.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct MaterialUniform {
    /// Ambient color; w is 0.
    pub ambient: [f32; 4],
    /// Diffuse color and opacity.
    pub diffuse: [f32; 4],
    /// Specular color and shininess.
    pub specular: [f32; 4],
}

/// The default ambient color, as a factor of the diffuse color.
const AMBIENT_SHARE: f32 = 0.2;

/// The default specular exponent.
const DEFAULT_SHININESS: f32 = 32.0;

/// Whether surfaces behind a material show through it.
pub(crate) fn is_transparent(material: &Material) -> bool {
    !material.is_opaque()
}

/// Whether any surface of a scene is transparent.
pub(crate) fn has_glass(scene: &Scene) -> bool {
    let of_mesh = |fill: &FillMesh| {
        let materials =
            fill.runs.iter().filter_map(|run| fill.materials.get(run.material as usize));
        materials.into_iter().any(is_transparent)
    };
    scene.models.iter().any(|model| of_mesh(&model.mesh.fill))
}

impl Default for MaterialUniform {
    /// The material of surfaces without one: light gray with a soft highlight.
    fn default() -> Self {
        Self {
            ambient: [0.15, 0.15, 0.15, 0.0],
            diffuse: [0.75, 0.75, 0.75, 1.0],
            specular: [0.3, 0.3, 0.3, DEFAULT_SHININESS],
        }
    }
}

impl MaterialUniform {
    /// A material with defaults: a light gray diffuse color, or white under a texture; a
    /// fifth of the diffuse color as ambient color; no highlight.
    ///
    /// Many exporters write an ambient color of pure white by default, so it counts as
    /// missing.
    #[must_use]
    pub(crate) fn of(material: &Material) -> Self {
        let default = Self::default();
        let [r, g, b, _] = match material.diffuse_texture {
            Some(_) => [1.0; 4],
            None => default.diffuse,
        };
        let diffuse = material.diffuse.unwrap_or([r, g, b]);
        let is_given = |ambient: &[f32; 3]| *ambient != [1.0; 3];
        let ambient =
            material.ambient.filter(is_given).unwrap_or(diffuse.map(|value| value * AMBIENT_SHARE));
        let specular = material.specular.unwrap_or([0.0; 3]);
        let shininess = material.shininess.unwrap_or(DEFAULT_SHININESS);
        let with = |[r, g, b]: [f32; 3], w| [r, g, b, w];
        Self {
            ambient: with(ambient, 0.0),
            diffuse: with(diffuse, material.opacity.unwrap_or(1.0)),
            specular: with(specular, shininess),
        }
    }
}

impl MaterialUniform {
    /// A material under vertex colors: as [`MaterialUniform::of`], but white where the model has
    /// no diffuse color.
    #[must_use]
    pub(crate) fn of_colored(material: &Material) -> Self {
        Self::of(&Material {
            diffuse: material.diffuse.or(Some([1.0; 3])),
            diffuse_texture: None,
            name: String::new(),
            ..*material
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_material_without_a_value_has_its_default() {
        let red = Material { diffuse: Some([1.0, 0.0, 0.0]), ..Material::default() };
        let uniform = MaterialUniform::of(&red);
        assert_eq!(uniform.ambient, [0.2, 0.0, 0.0, 0.0]);
        assert_eq!(uniform.specular, [0.0, 0.0, 0.0, DEFAULT_SHININESS]);
        let white = Material { ambient: Some([1.0; 3]), ..red.clone() };
        assert_eq!(MaterialUniform::of(&white), uniform, "white counts as missing");
        let dark = Material { ambient: Some([0.0; 3]), ..red };
        assert_eq!(MaterialUniform::of(&dark).ambient, [0.0; 4]);
    }
}
