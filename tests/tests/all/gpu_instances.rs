//! Large meshes in several places, drawn as objects that share a mesh, against copies.

use edgemesh::load::{LoadOptions, NoProgress};
use edgemesh::view::Camera;
use image::RgbaImage;
use viewer::picture::renderer::{FrameStatistics, PictureInput, PictureOptions, PictureRenderer};
use viewer::scene::models::Scene;
use viewer::scene::scene_file::SceneObject;
use viewer::technique::Technique;

use crate::gpu_device::gpu;
use crate::gpu_render::technique;
use crate::instances::{Place, balls, places};

/// The scene of a file of balls.
fn scene(places: &[Place], are_shared: bool) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("balls.glb");
    std::fs::write(&path, balls(places, are_shared)).unwrap();
    let options = LoadOptions { with_instances: true, ..LoadOptions::default() };
    Scene::load(&[SceneObject::plain(&path)], &options, &NoProgress).unwrap()
}

fn picture(scene: &Scene, technique: &Technique, camera: &Camera) -> (RgbaImage, FrameStatistics) {
    let options = PictureOptions { size: [640, 400], samples: 1, ..PictureOptions::default() };
    let input = PictureInput::new(scene, technique);
    PictureRenderer::new(gpu(), input, &options).unwrap().render(camera).unwrap()
}

/// The share of pixels that differ by more than rounding.
fn difference(one: &RgbaImage, other: &RgbaImage) -> f64 {
    let differs = |(one, other): &(&image::Rgba<u8>, &image::Rgba<u8>)| {
        one.0.iter().zip(other.0).any(|(a, b)| a.abs_diff(b) > 8)
    };
    let count = one.pixels().zip(other.pixels()).filter(differs).count();
    count as f64 / f64::from(one.width() * one.height())
}

/// The mesh is uploaded once and the stretched copy once; the pictures are those of copies.
#[test]
fn instances_are_drawn_as_their_copies_are() {
    let (shared, copied) = (scene(&places(), true), scene(&places(), false));
    let objects = |scene: &Scene| (scene.models.len(), scene.objects.len());
    assert_eq!((objects(&shared), objects(&copied)), ((2, 5), (1, 1)));
    let camera = Camera::default_view(&copied.bounds);
    for (name, settings, most) in [
        ("ink", &[][..], 0.0005),
        ("ink", &["hidden.render=true", "strokes.width=0.05", "strokes.width_unit=model"], 0.0005),
        ("linked", &[], 0.002),
        ("phong", &[], 0.0005),
    ] {
        let own = technique(name, settings);
        let (one, of_one) = picture(&shared, &own, &camera);
        let (other, of_other) = picture(&copied, &own, &camera);
        let share = difference(&one, &other);
        let drawn = other.pixels().filter(|pixel| pixel.0 != [255; 4]).count();
        assert!(drawn > 3000, "{name}: {drawn}");
        assert!(share <= most, "{name} {settings:?}: {share}");
        let features = |of: &FrameStatistics| of.tally.map(|tally| tally.features());
        assert_eq!(features(&of_one), features(&of_other), "{name}");
    }
}
