//! Shows a texture between passes in place of the picture, by one more pass at the end of the
//! technique.

use crate::technique::Technique;
use crate::technique::library::Library;
use crate::technique::mistake::Mistakes;
use crate::technique::pass::{Assignment, Pass};
use crate::technique::program::FieldKind;
use crate::technique::texture_format::{PassTexture, TextureFormat};
use crate::technique::texture_name::TextureName;
use crate::technique::value::Value;

/// A texture that is shown.
#[derive(Debug, Clone, PartialEq)]
pub struct Inspection {
    /// The texture.
    pub texture: PassTexture,
    /// The value shown as black.
    pub(crate) low: f32,
    /// The value shown as white.
    pub(crate) high: f32,
}

impl Inspection {
    /// Shows a texture, with black at 0 and white at 1.
    #[must_use]
    pub const fn of(texture: PassTexture) -> Self {
        Self { texture, low: 0.0, high: 1.0 }
    }

    /// Whether its values have a range that can be chosen.
    #[must_use]
    pub(crate) fn has_range(&self) -> bool {
        let format = self.texture.format;
        format != TextureFormat::DEPTH && format.number_kind() == FieldKind::Float
    }

    /// The technique with a last pass that shows the texture; `None` if it has no such
    /// texture.
    #[must_use]
    pub fn shown(&self, technique: &Technique, library: &Library) -> Option<Technique> {
        let format = self.texture.format;
        let (component, variable) = match format.number_kind() {
            _ if format == TextureFormat::DEPTH => ("shade_depth", "depth_texture"),
            FieldKind::Uint => ("show_ids", "texture"),
            _ => ("show_texture", "texture"),
        };
        let component = library.components().get(component)?.clone();
        let texture = Value::Texture(TextureName::generated(&self.texture.name));
        let mut values = vec![(variable, texture)];
        if self.has_range() {
            let count = format.channel_count().cast_signed();
            values.extend([
                ("low", Value::Numbers(vec![self.low])),
                ("high", Value::Numbers(vec![self.high])),
                ("number_count", Value::Int(count)),
            ]);
        }
        let assignments = values.into_iter().filter_map(|(name, value)| {
            let (index, _) = component.variable(name)?;
            Some(Assignment { index, value, place: None })
        });
        let assignments = assignments.collect();
        let place = component.place.clone();
        // No pass of a file has a space in its name.
        let name = "shown texture".to_owned();
        let mut mistakes = Mistakes::default();
        let pass = Pass::new(name, component, place, assignments, &mut mistakes)?;
        let mut shown = technique.clone();
        shown.passes.push(pass);
        Some(shown)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::technique::plan::Plan;
    use crate::technique::program::ShaderFiles;

    #[test]
    fn every_texture_of_every_technique_can_be_shown() {
        let library = Library::shipped();
        let mut shown = 0;
        for name in library.technique_names() {
            let (technique, _) = library.technique(name).unwrap();
            let plan = |technique: &Technique| {
                let plan = Plan::of(technique, &ShaderFiles::default());
                plan.unwrap_or_else(|mistakes| panic!("{name}: {mistakes}"))
            };
            for texture in plan(&technique).textures {
                let texture = PassTexture { name: texture.name, format: texture.format };
                let inspection = Inspection::of(texture);
                let with_pass = inspection.shown(&technique, &library).unwrap();
                assert_eq!(plan(&with_pass).passes.len(), technique.passes.len() + 1);
                shown += 1;
            }
        }
        assert!(shown > 30, "{shown}");
    }
}
