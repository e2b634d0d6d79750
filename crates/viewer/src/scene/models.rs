//! Models in memory, with their places.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use edgemesh::build::BuildOptions;
use edgemesh::edge_mesh::{Bounds, InstancedMesh, MeshFrame};
use edgemesh::load::{LoadOptions, LoadedMesh, ModelSource, Progress, load_scene};
use edgemesh::report::Report;
use glam::DMat4;

use crate::error::Error;
use crate::scene::scene_file::SceneObject;

/// Models in memory, with their places.
#[derive(Debug, Clone)]
pub struct Scene {
    /// The models, each with its name and its report, without instances. Meshes that a model has
    /// in several places follow as models of their own, without reports.
    pub models: Vec<LoadedMesh>,
    /// How many of the models are files; those of instances follow.
    pub(crate) file_count: usize,
    /// The objects; a model can be in several, and has one for each of its instances.
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
    /// [`Error::Load`] for the first model that cannot be loaded, or if `progress` cancels;
    /// [`Error::TooManyObjects`] if models with many instances are placed many times.
    pub fn load(
        objects: &[SceneObject],
        options: &LoadOptions,
        progress: &dyn Progress,
    ) -> Result<Self, Error> {
        let mut paths: Vec<PathBuf> = Vec::new();
        let mut known: HashMap<&Path, usize> = HashMap::new();
        let mut placed = Vec::new();
        for (override_index, object) in objects.iter().enumerate() {
            let model = *known.entry(&object.model).or_insert_with(|| {
                paths.push(object.model.clone());
                paths.len() - 1
            });
            let world_from_object = object.scene_from_model;
            placed.push(PlacedObject { model, override_index, world_from_object });
        }
        // Transforms are in units of the files.
        let is_moved = placed.iter().any(|object| object.world_from_object != DMat4::IDENTITY);
        let models = load_scene(&paths, options, is_moved, progress)?;
        check_object_count(&models, &placed)?;
        let thresholds = options.crease_angles_rad();
        Ok(Self { thresholds, ..Self::placed(models, placed) })
    }

    /// A scene with each model once, without transforms. All must be in one frame.
    #[must_use]
    pub fn of(models: Vec<LoadedMesh>) -> Self {
        let in_place =
            |model| PlacedObject { model, override_index: 0, world_from_object: DMat4::IDENTITY };
        let objects = (0..models.len()).map(in_place).collect();
        Self::placed(models, objects)
    }

    /// A scene of models in one frame, in their places. The instances of a model become objects.
    #[must_use]
    pub fn placed(models: Vec<LoadedMesh>, objects: Vec<PlacedObject>) -> Self {
        let file_count = models.len();
        let own_boxes: Vec<Bounds> = models.iter().map(LoadedMesh::bounds).collect();
        let boxes = objects.iter().filter_map(|object| {
            let model = &models[object.model];
            let has_vertices = !model.mesh.positions.is_empty() || !model.instanced.is_empty();
            has_vertices.then(|| own_boxes[object.model].transformed(&object.world_from_object))
        });
        let bounds = boxes.reduce(|bounds, other| bounds.union(&other)).unwrap_or_default();
        let (models, objects) = with_instances(models, objects);
        let frame = models.first().map(|model| model.mesh.frame).unwrap_or_default();
        let built = BuildOptions::default();
        let thresholds = [built.ridge_angle_rad, built.valley_angle_rad];
        Self { models, file_count, objects, bounds, frame, thresholds }
    }
}

/// The most objects of models with instances: each has buffers and draws of its own.
const MAX_OBJECTS: usize = 20_000;

/// Checks that instances do not make too many objects.
fn check_object_count(models: &[LoadedMesh], objects: &[PlacedObject]) -> Result<(), Error> {
    let places = |model: &LoadedMesh| -> usize {
        model.instanced.iter().map(|instanced| instanced.placements.len()).sum()
    };
    let places: Vec<usize> = models.iter().map(places).collect();
    let count: usize = objects.iter().map(|object| places[object.model]).sum();
    if count > MAX_OBJECTS {
        Err(Error::TooManyObjects { count, limit: MAX_OBJECTS })
    } else {
        Ok(())
    }
}

/// Makes models of the instanced meshes, and an object for each of their places.
fn with_instances(
    mut models: Vec<LoadedMesh>,
    objects: Vec<PlacedObject>,
) -> (Vec<LoadedMesh>, Vec<PlacedObject>) {
    if models.iter().all(|model| model.instanced.is_empty()) {
        return (models, objects);
    }
    // The first model of each model's instances, and their places.
    let mut instances: Vec<(usize, Vec<Vec<DMat4>>)> = Vec::new();
    for at in 0..models.len() {
        let first = models.len();
        let (meshes, places): (Vec<LoadedMesh>, Vec<Vec<DMat4>>) =
            split_instances(&mut models[at]).into_iter().unzip();
        models.extend(meshes);
        instances.push((first, places));
    }
    let mut all = Vec::new();
    for object in objects {
        let (first, places) = &instances[object.model];
        // A model of instances alone has nothing else to draw.
        if places.is_empty() || !models[object.model].mesh.positions.is_empty() {
            all.push(object);
        }
        for (model, places) in (*first..).zip(places) {
            all.extend(places.iter().map(|&place| {
                let world_from_object = object.world_from_object * place;
                PlacedObject { model, world_from_object, ..object }
            }));
        }
    }
    (models, all)
}

/// Takes the instanced meshes of a model, as models with their places.
fn split_instances(model: &mut LoadedMesh) -> Vec<(LoadedMesh, Vec<DMat4>)> {
    let mut vertices = model.source.as_mut().map(|source| {
        (source.path.clone(), std::mem::take(&mut source.instanced_vertices).into_iter())
    });
    let own = |InstancedMesh { mesh, placements }| {
        let mut own = LoadedMesh::new(model.name.clone(), mesh, Report::default());
        own.source = vertices
            .as_mut()
            .and_then(|(path, lists)| Some(ModelSource::new(path.clone(), lists.next()?)));
        (own, placements)
    };
    std::mem::take(&mut model.instanced).into_iter().map(own).collect()
}

#[cfg(test)]
mod tests {
    use edgemesh::build::build_edge_mesh;
    use edgemesh::edge_mesh::EdgeMesh;
    use edgemesh::model::Model;
    use glam::DVec3;

    use super::*;

    fn triangle() -> EdgeMesh {
        let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let model = Model::from_polygons(&corners, &[&[0, 1, 2]]);
        build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default())
    }

    fn shift(x: f64) -> DMat4 {
        DMat4::from_translation(DVec3::new(x, 0.0, 0.0))
    }

    /// A model with two places of another mesh, itself in two places.
    #[test]
    fn instances_become_objects_of_one_model() {
        let placements = vec![shift(10.0), shift(20.0)];
        let mut model = LoadedMesh::new("a".into(), triangle(), Report::default());
        model.instanced = vec![InstancedMesh { mesh: triangle(), placements }];
        let object = |override_index: usize, x: f64| PlacedObject {
            model: 0,
            override_index,
            world_from_object: shift(x),
        };
        let scene = Scene::placed(vec![model.clone()], vec![object(0, 0.0), object(1, 100.0)]);
        let placed = |object: &PlacedObject| {
            (object.model, object.override_index, object.world_from_object.w_axis.x)
        };
        let objects: Vec<_> = scene.objects.iter().map(placed).collect();
        let first = [(0, 0, 0.0), (1, 0, 10.0), (1, 0, 20.0)];
        let second = [(0, 1, 100.0), (1, 1, 110.0), (1, 1, 120.0)];
        assert_eq!(objects, [first, second].concat());
        assert_eq!((scene.models.len(), scene.bounds.max[0]), (2, 121.0));
        assert!(scene.models.iter().all(|model| model.instanced.is_empty()));
        model.mesh = EdgeMesh::default();
        let scene = Scene::placed(vec![model], vec![object(0, 0.0)]);
        assert_eq!(scene.objects.iter().map(|at| at.model).collect::<Vec<_>>(), [1, 1]);
        assert_eq!(scene.bounds.min[0], 10.0, "an empty mesh has no place");
    }

    #[test]
    fn too_many_objects_are_refused() {
        let mut model = LoadedMesh::new("a".into(), triangle(), Report::default());
        let placements = vec![DMat4::IDENTITY; 1000];
        model.instanced = vec![InstancedMesh { mesh: triangle(), placements }];
        let object =
            PlacedObject { model: 0, override_index: 0, world_from_object: DMat4::IDENTITY };
        assert!(check_object_count(std::slice::from_ref(&model), &vec![object; 20]).is_ok());
        let error = check_object_count(&[model], &vec![object; 21]).unwrap_err();
        assert!(error.to_string().contains("21000 objects; the limit is 20000"), "{error}");
    }
}
