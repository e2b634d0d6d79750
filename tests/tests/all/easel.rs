//! Pictures of one mesh, one technique after another: pipelines and meshes that one picture
//! needed serve the next.

use edgemesh::edge_mesh::EdgeMesh;
use edgemesh::view::Camera;
use image::RgbaImage;
use strokes::Gpu;
use viewer::picture::renderer::{PictureInput, PictureOptions, PictureRenderer};
use viewer::scene::models::Scene;
use viewer::technique::Technique;

use crate::gpu_render::scene_of;

/// Draws a mesh on a device.
pub(crate) struct Easel<'a> {
    gpu: &'a Gpu,
    scene: Scene,
    /// One for each set of options.
    renderers: Vec<PictureRenderer>,
}

impl<'a> Easel<'a> {
    pub(crate) fn new(gpu: &'a Gpu, mesh: &EdgeMesh) -> Self {
        Self { gpu, scene: scene_of(mesh), renderers: Vec::new() }
    }

    /// The picture that a new renderer would draw.
    pub(crate) fn picture(
        &mut self,
        camera: &Camera,
        technique: &Technique,
        options: &PictureOptions,
    ) -> RgbaImage {
        let key = |of: &PictureOptions| (of.size, of.samples, of.layout, of.stage);
        let known = self.renderers.iter().position(|known| key(known.options()) == key(options));
        let at = known.unwrap_or(self.renderers.len());
        if let Some(renderer) = self.renderers.get_mut(at) {
            renderer.reload(PictureInput::new(&self.scene, technique), options).unwrap();
        } else {
            let renderer =
                PictureRenderer::new(self.gpu, PictureInput::new(&self.scene, technique), options);
            self.renderers.push(renderer.unwrap());
        }
        self.renderers[at].render(camera).unwrap().0
    }
}
