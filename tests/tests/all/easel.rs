//! Pictures of several meshes in several techniques by few renderers: pipelines and meshes
//! that one picture needed serve the next.

use edgemesh::edge_mesh::EdgeMesh;
use edgemesh::load::Loaded;
use edgemesh::report::Report;
use edgemesh::view::camera::Camera;
use glam::DMat4;
use image::RgbaImage;
use strokes::gpu::device::Gpu;
use strokes::mesh::layout::Layout;
use strokes::render::pipelines::DetectionStage;
use viewer::picture::renderer::{PictureOptions, PictureRenderer};
use viewer::scene::models::Scene;
use viewer::technique::Technique;

use crate::gpu_device::gpu;
use crate::gpu_render::{own_model, picture_with, technique};

/// Draws one of its meshes at a time.
pub(crate) struct Easel<'a> {
    gpu: &'a Gpu,
    /// All meshes; those that are not drawn are scaled to nothing.
    scene: Scene,
    /// One for each layout and detection stage.
    renderers: Vec<PictureRenderer>,
}

impl<'a> Easel<'a> {
    pub(crate) fn new<'m>(gpu: &'a Gpu, meshes: impl IntoIterator<Item = &'m EdgeMesh>) -> Self {
        let loaded = |mesh: &EdgeMesh| Loaded::new("test".into(), mesh.clone(), Report::default());
        let scene = Scene::of(meshes.into_iter().map(loaded).collect());
        Self { gpu, scene, renderers: Vec::new() }
    }

    /// The picture of mesh number `mesh` that a new renderer of that mesh alone would draw.
    /// Techniques that go on from the frame before see that of the picture before.
    pub(crate) fn picture(
        &mut self,
        mesh: usize,
        camera: &Camera,
        technique: &Technique,
        options: &PictureOptions,
    ) -> RgbaImage {
        self.show(mesh);
        let key = |of: &PictureOptions| (of.layout, of.stage);
        let known = self.renderers.iter().position(|known| key(known.options()) == key(options));
        let at = known.unwrap_or(self.renderers.len());
        if let Some(renderer) = self.renderers.get_mut(at) {
            renderer.reload(&self.scene, technique, &[], options).unwrap();
        } else {
            let renderer = PictureRenderer::new(self.gpu, &self.scene, technique, &[], options);
            self.renderers.push(renderer.unwrap());
        }
        self.renderers[at].render(camera).unwrap().0
    }

    /// The camera that a picture of mesh number `mesh` has by default.
    pub(crate) fn default_view(&self, mesh: usize) -> Camera {
        Camera::default_view(&self.scene.models[mesh].mesh.bounds)
    }

    /// Makes the scene one of a mesh alone.
    fn show(&mut self, mesh: usize) {
        let shown = &self.scene.models[mesh].mesh;
        (self.scene.bounds, self.scene.frame) = (shown.bounds, shown.frame);
        for (at, object) in self.scene.objects.iter_mut().enumerate() {
            object.world_from_object = if at == mesh { DMat4::IDENTITY } else { DMat4::ZERO };
        }
    }
}

/// Tests that share renderers check nothing less than tests with a renderer for each picture.
#[test]
fn a_shared_renderer_draws_the_bytes_of_a_new_one() {
    let meshes = ["torus_knot", "bracket"].map(own_model);
    let mut easel = Easel::new(gpu(), &meshes);
    let techniques = [
        technique("ink", &["hidden.render=true", "silhouette.render=true"]),
        technique("linked", &["strokes.wobble=3", "strokes.brush=pen"]),
        technique("pen", &["strokes.width_unit=model", "strokes.width=0.05"]),
        technique("outline_combined", &[]),
    ];
    let stages =
        [(Layout::Indexed, DetectionStage::Compute), (Layout::Replicated, DetectionStage::Vertex)];
    // Each renderer draws another mesh, technique and size than before.
    for (step, technique) in techniques.iter().enumerate() {
        for (at, mesh) in meshes.iter().enumerate() {
            let (layout, stage) = stages[(step + at) % 2];
            let size = [[64, 96][step % 2]; 2];
            let options = PictureOptions { size, layout, stage, ..PictureOptions::default() };
            let camera = easel.default_view(at);
            let shared = easel.picture(at, &camera, technique, &options);
            let new = picture_with(mesh, &camera, technique, &options);
            assert!(shared == new, "{}, mesh {at}, {layout:?} {stage:?}", technique.name);
        }
    }
}
