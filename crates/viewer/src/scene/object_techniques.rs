//! The overrides of scene files.

use super::scene_file::SceneObject;
use crate::error::Error;
use crate::technique::Technique;
use crate::technique::library::Library;
use crate::technique::mistake::Mistakes;

/// The technique of each object: its own or `default`, with its settings; empty if no object
/// has a technique or a setting. `warn` receives warnings.
///
/// # Errors
/// [`Error::Technique`], [`Error::ObjectSetting`].
pub(crate) fn object_techniques(
    objects: &[SceneObject],
    library: &Library,
    default: &Technique,
    warn: &mut dyn FnMut(&Mistakes),
) -> Result<Vec<Technique>, Error> {
    if objects.iter().all(|object| object.technique.is_none() && object.settings.is_empty()) {
        return Ok(Vec::new());
    }
    let of_object = |object: &SceneObject| {
        let mut technique = match &object.technique {
            None => default.clone(),
            Some(name) => {
                let (technique, warnings) = library.technique(name)?;
                warn(&warnings);
                technique
            }
        };
        for setting in &object.settings {
            let warnings = technique
                .set(setting)
                .map_err(|reason| Error::ObjectSetting { model: object.model.clone(), reason })?;
            warn(&warnings);
        }
        Ok(technique)
    };
    objects.iter().map(of_object).collect()
}
