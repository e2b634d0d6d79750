//! `strokes`: feature edges by the stroke renderer.
//!
//! Passes that follow each other are one look and are drawn from one detection: what
//! is hidden, then what is visible, then silhouettes. What lies under them is the
//! framebuffer as it is; where no pass has drawn the scene there, its depth is filled
//! first, so that lines are hidden by surfaces that are not drawn.

use std::sync::Arc;

use strokes::gpu::device::Gpu;
use strokes::gpu::target_formats::TargetFormats;
use strokes::gpu::timer::TimedPasses;
use strokes::mesh::buffers::MeshBuffers;
use strokes::renderer::object::Object;
use strokes::renderer::{
    DetectionPath, Fill, FrameRequest, PreparedLook, Renderer, RendererOptions,
};

use super::stroke_style::look_of;
use super::{Encoding, GraphOptions};
use crate::error::Error;
use crate::scene::models::Scene;
use crate::technique::Technique;
use crate::technique::core::CoreComponent;
use crate::technique::pass::Pass;

/// The stroke renderer and the meshes that its groups share.
#[derive(Debug)]
pub(crate) struct StrokePasses {
    renderer: Renderer,
    meshes: Vec<Option<Arc<MeshBuffers>>>,
    folders: Vec<std::path::PathBuf>,
}

/// What stays while techniques come and go: renderers with the pipelines that they have
/// built, each for its kind of target, and the meshes.
#[derive(Debug, Default)]
pub(crate) struct StrokeStore {
    renderers: Vec<Renderer>,
    meshes: Vec<Option<Arc<MeshBuffers>>>,
}

/// Targets with a stencil and without.
const MOST_RENDERERS: usize = 2;

/// Passes that are drawn together.
#[derive(Debug)]
pub(crate) struct StrokeGroup {
    pub(crate) objects: Vec<Object>,
}

/// Whether a pass of strokes is done and asks what is beside its lines.
pub(crate) fn needs_stencil(technique: &Technique, looks: &[Technique]) -> bool {
    let is_silhouette = |pass: &Pass| {
        pass.is_rendered()
            && pass.component.core == CoreComponent::Strokes
            && pass.string("visibility") == "silhouette"
    };
    let mut all = std::iter::once(technique).chain(looks).flat_map(|look| &look.passes);
    all.any(is_silhouette)
}

impl StrokePasses {
    /// For strokes in a scene; what is in `store` is taken out of it, as far as it is
    /// still good.
    pub(crate) fn new(
        gpu: &Gpu,
        scene: &Scene,
        options: &GraphOptions,
        formats: TargetFormats,
        (folders, store): (&[std::path::PathBuf], &mut StrokeStore),
    ) -> Result<Self, Error> {
        let GraphOptions { layout, path, .. } = *options;
        let options = RendererOptions { layout, path, formats }.possible();
        let renderer = match store.renderers.iter().position(|known| *known.options() == options) {
            Some(at) => store.renderers.remove(at),
            None => Renderer::new(gpu, options)?,
        };
        let mut meshes = std::mem::take(&mut store.meshes);
        meshes.resize(scene.models.len(), None);
        Ok(Self { renderer, meshes, folders: folders.to_vec() })
    }

    /// Leaves everything for those who come after it.
    pub(crate) fn put_back(self, store: &mut StrokeStore) {
        store.meshes = self.meshes;
        store.renderers.push(self.renderer);
        if store.renderers.len() > MOST_RENDERERS {
            store.renderers.remove(0);
        }
    }

    /// Whether vertex shaders detect.
    pub(crate) fn counts_nothing(&self) -> bool {
        self.renderer.options().path == DetectionPath::Vertex
    }

    /// Prepares the look of `passes` for the objects of `scene`; those with a look of
    /// their own have all passes of strokes from there.
    pub(crate) fn group(
        &mut self,
        gpu: &Gpu,
        scene: &Scene,
        passes: &[&Pass],
        looks: &[Technique],
    ) -> Result<StrokeGroup, Error> {
        let look = |passes: &[&Pass], folders: &[std::path::PathBuf]| {
            look_of(passes, folders, &scene.frame, scene.thresholds)
        };
        let mut all = vec![look(passes, &self.folders)?];
        for own in looks {
            let is_drawn =
                |pass: &&Pass| pass.is_rendered() && pass.component.core == CoreComponent::Strokes;
            let passes: Vec<&Pass> = own.passes.iter().filter(is_drawn).collect();
            all.push(look(&passes, &own.folders)?);
        }
        // Objects that look alike share pipelines and textures.
        let mut prepared: Vec<Arc<PreparedLook>> = Vec::with_capacity(all.len());
        for (at, look) in all.iter().enumerate() {
            let same = all[..at].iter().position(|known| known == look);
            prepared.push(match same {
                Some(same) => prepared[same].clone(),
                None => self.renderer.prepare(gpu, look)?,
            });
        }
        let is_linked = prepared.iter().any(|look| look.is_linked());
        let mut objects = Vec::with_capacity(scene.objects.len());
        for placed in &scene.objects {
            let mesh = self.mesh(gpu, scene, placed.model, is_linked)?;
            let look = prepared.get(placed.look + 1).unwrap_or(&prepared[0]);
            let mut object = self.renderer.object(gpu, &mesh, look);
            object.world_from_object = placed.world_from_object;
            objects.push(object);
        }
        Ok(StrokeGroup { objects })
    }

    /// The mesh of a model, uploaded once, and again where links are needed.
    fn mesh(
        &mut self,
        gpu: &Gpu,
        scene: &Scene,
        model: usize,
        is_linked: bool,
    ) -> Result<Arc<MeshBuffers>, Error> {
        if let Some(known) = &self.meshes[model]
            && (!is_linked || known.has_links())
        {
            return Ok(known.clone());
        }
        let loaded = &scene.models[model];
        let upload = if is_linked { MeshBuffers::with_links } else { MeshBuffers::new };
        let layout = self.renderer.options().layout;
        let mesh = upload(&gpu.device, &loaded.mesh, layout)
            .map_err(|reason| Error::MeshTooLarge { model: loaded.name.clone(), reason })?;
        Ok(self.meshes[model].insert(Arc::new(mesh)).clone())
    }

    pub(crate) fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        encoding: &mut Encoding,
        group: &mut StrokeGroup,
        timer: Option<TimedPasses>,
    ) {
        let fill = match (encoding.has_depth, encoding.is_fresh) {
            (true, _) => Fill::Done,
            (false, true) => Fill::Clear([0.0; 4]),
            (false, false) => Fill::Depth,
        };
        let request = FrameRequest {
            targets: encoding.framebuffer,
            view: encoding.view,
            uniform: encoding.uniform,
            fill,
            overview: encoding.overview,
            resolves: false,
            timer,
        };
        self.renderer.encode(encoding.gpu, encoder, &mut group.objects, &request);
        (encoding.is_fresh, encoding.has_depth) = (false, true);
    }
}
