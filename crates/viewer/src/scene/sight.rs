//! What of a scene a camera sees first, and whether it sees anything.

use edgemesh::view::{Sight, SightIndex};

use super::models::{PlacedObject, Scene};

/// The nearest surfaces of a scene.
#[derive(Debug, Clone)]
pub(crate) struct SceneSight {
    models: Vec<SightIndex>,
    objects: Vec<PlacedObject>,
}

impl SceneSight {
    pub(crate) fn of(scene: &Scene) -> Self {
        Self {
            models: scene.models.iter().map(|model| SightIndex::of(&model.mesh)).collect(),
            objects: scene.objects.clone(),
        }
    }

    /// Whether there is neither a surface nor a line.
    pub(crate) fn is_empty(&self) -> bool {
        self.objects.iter().all(|object| self.models[object.model].is_empty())
    }

    /// The distance of the nearest surface in sight along the line of sight; `None` if there is
    /// none.
    pub(crate) fn nearest(&self, sight: &Sight) -> Option<f64> {
        let of_object = |object: &PlacedObject| {
            self.models[object.model].nearest(&sight.in_object(&object.world_from_object))
        };
        self.objects.iter().filter_map(of_object).min_by(f64::total_cmp)
    }
}
