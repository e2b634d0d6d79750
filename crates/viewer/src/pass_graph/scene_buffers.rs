//! The models of a scene on the GPU, each once. They stay when the technique changes.

use std::sync::Arc;

use strokes::{Gpu, MeshBuffers, MeshInstance, MeshOptions};

use crate::error::Error;
use crate::scene::models::{PlacedObject, Scene};

/// The models of a scene on the GPU.
#[derive(Debug, Default)]
pub(crate) struct SceneBuffers {
    meshes: Vec<Option<Arc<MeshBuffers>>>,
}

impl SceneBuffers {
    /// The objects of `scene` in their places. A model is uploaded once, and again if a
    /// technique needs more of it.
    pub(crate) fn instances(
        &mut self,
        gpu: &Gpu,
        scene: &Scene,
        needs: MeshOptions,
    ) -> Result<Vec<MeshInstance>, Error> {
        self.meshes.resize(scene.models.len(), None);
        let mut counts = vec![0_u32; scene.models.len()];
        scene.objects.iter().for_each(|placed| counts[placed.model] += 1);
        let shared = counts.iter().filter(|count| **count > 1).sum();
        let instance = |placed: &PlacedObject| {
            let objects = if counts[placed.model] > 1 { shared } else { 1 };
            let needs = MeshOptions { objects, ..needs };
            let mesh = self.mesh(gpu, scene, placed.model, needs)?;
            Ok(MeshInstance::new(&mesh, placed.world_from_object))
        };
        scene.objects.iter().map(instance).collect()
    }

    fn mesh(
        &mut self,
        gpu: &Gpu,
        scene: &Scene,
        model: usize,
        needs: MeshOptions,
    ) -> Result<Arc<MeshBuffers>, Error> {
        let known =
            self.meshes[model].as_ref().filter(|mesh| mesh.options().layout == needs.layout);
        let mut options = needs;
        if let Some(mesh) = known {
            let has = mesh.options();
            options.links |= has.links;
            options.surface |= has.surface;
            if options == has {
                return Ok(mesh.clone());
            }
        }
        let loaded = &scene.models[model];
        let mesh = MeshBuffers::new(&gpu.device, &loaded.mesh, options)
            .map_err(|reason| Error::MeshTooLarge { model: loaded.name.clone(), reason })?;
        Ok(self.meshes[model].insert(Arc::new(mesh)).clone())
    }
}
