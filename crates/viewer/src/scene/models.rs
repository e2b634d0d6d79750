//! Models in memory, with their places.

use std::path::PathBuf;

use edgemesh::build::BuildOptions;
use edgemesh::edge_mesh::{Bounds, MeshFrame};
use edgemesh::load::{LoadOptions, LoadedMesh, Progress, load_scene};
use glam::DMat4;

use crate::error::Error;
use crate::scene::scene_file::SceneObject;

/// Models in memory, with their places.
#[derive(Debug, Clone)]
pub struct Scene {
    /// The models, each with its name and its report.
    pub models: Vec<LoadedMesh>,
    /// The objects; a model can be in several.
    pub objects: Vec<PlacedObject>,
    /// The box around all objects.
    pub bounds: Bounds,
    /// The mesh frame of all models.
    pub frame: MeshFrame,
    /// The crease angles of the meshes in radians, for ridges and valleys.
    pub(crate) thresholds: [f64; 2],
}

/// A model in its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlacedObject {
    /// Index into [`Scene::models`].
    pub model: usize,
    /// Index into the overrides, the techniques of single objects; past their end for the
    /// technique of the scene.
    pub override_index: usize,
    /// Transform from the model to the scene.
    pub world_from_object: DMat4,
}

impl Scene {
    /// Reads and builds the models of `objects`, each file once. Each object has the override
    /// of its own index.
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
        for (override_index, object) in objects.iter().enumerate() {
            let known = paths.iter().position(|path| *path == object.model);
            let model = known.unwrap_or(paths.len());
            if known.is_none() {
                paths.push(object.model.clone());
            }
            let world_from_object = object.scene_from_model;
            placed.push(PlacedObject { model, override_index, world_from_object });
        }
        // Transforms are in units of the files.
        let is_moved = placed.iter().any(|object| object.world_from_object != DMat4::IDENTITY);
        Ok(Self {
            thresholds: options.crease_angles_rad(),
            ..Self::placed(load_scene(&paths, options, is_moved, progress)?, placed)
        })
    }

    /// A scene with each model once, without transforms. All must be in one frame.
    #[must_use]
    pub fn of(models: Vec<LoadedMesh>) -> Self {
        let in_place =
            |model| PlacedObject { model, override_index: 0, world_from_object: DMat4::IDENTITY };
        let objects = (0..models.len()).map(in_place).collect();
        Self::placed(models, objects)
    }

    /// A scene of models in one frame, in their places.
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
