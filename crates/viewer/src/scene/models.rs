//! Models in memory, and where they stand.

use std::path::PathBuf;

use edgemesh::build::BuildOptions;
use edgemesh::edge_mesh::{Bounds, MeshFrame};
use edgemesh::load::{LoadOptions, LoadedMesh, Progress, load_scene};
use glam::DMat4;

use crate::error::Error;
use crate::scene::scene_file::SceneObject;

/// Models in memory.
#[derive(Debug, Clone)]
pub struct Scene {
    /// Each model with its name and what was repaired in it.
    pub models: Vec<LoadedMesh>,
    /// Where they stand, and how they look.
    pub objects: Vec<PlacedObject>,
    /// The box around all of them.
    pub bounds: Bounds,
    /// Where the scene lies in the files, the same for all models.
    pub frame: MeshFrame,
    /// The angles in radians from which edges are ridges and valleys in the meshes.
    pub thresholds: [f64; 2],
}

/// A model in its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlacedObject {
    /// Index into [`Scene::models`].
    pub model: usize,
    /// Index into the techniques that objects have of their own; any other number for
    /// that of the scene.
    pub look: usize,
    /// Takes the model to the scene.
    pub world_from_object: DMat4,
}

impl Scene {
    /// Reads and builds the models of `objects`, each file once. Object number n
    /// has look number n.
    ///
    /// # Errors
    /// [`Error::Load`] for the first model that cannot be loaded, or if `progress` cancels.
    pub fn load(
        objects: &[SceneObject],
        options: &LoadOptions,
        progress: &dyn Progress,
    ) -> Result<Self, Error> {
        let mut paths: Vec<PathBuf> = Vec::new();
        let mut placed = Vec::new();
        for (look, object) in objects.iter().enumerate() {
            let known = paths.iter().position(|path| *path == object.model);
            let model = known.unwrap_or(paths.len());
            if known.is_none() {
                paths.push(object.model.clone());
            }
            let world_from_object = object.scene_from_model;
            placed.push(PlacedObject { model, look, world_from_object });
        }
        // Transforms are in the numbers of the files.
        let is_moved = placed.iter().any(|object| object.world_from_object != DMat4::IDENTITY);
        Ok(Self {
            thresholds: options.crease_angles_rad(),
            ..Self::placed(load_scene(&paths, options, is_moved, progress)?, placed)
        })
    }

    /// A scene of models that are in one frame, each once where it is.
    #[must_use]
    pub fn of(models: Vec<LoadedMesh>) -> Self {
        let in_place = |model| PlacedObject { model, look: 0, world_from_object: DMat4::IDENTITY };
        let objects = (0..models.len()).map(in_place).collect();
        Self::placed(models, objects)
    }

    /// A scene of models that are in one frame, in their places.
    #[must_use]
    pub fn placed(models: Vec<LoadedMesh>, objects: Vec<PlacedObject>) -> Self {
        let boxes = objects.iter().filter_map(|object| {
            let mesh = &models[object.model].mesh;
            let has_vertices = !mesh.positions.is_empty();
            has_vertices.then(|| mesh.bounds.transformed(&object.world_from_object))
        });
        let bounds = boxes.reduce(|bounds, other| bounds.union(&other)).unwrap_or_default();
        let frame = models.first().map(|model| model.mesh.frame).unwrap_or_default();
        let built = BuildOptions::default();
        let thresholds = [built.ridge_angle_rad, built.valley_angle_rad];
        Self { models, objects, bounds, frame, thresholds }
    }
}
