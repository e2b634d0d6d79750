//! Pictures in parts are those that are drawn at once.

use edgemesh::edge_mesh::EdgeMesh;
use edgemesh::view::camera::Camera;
use image::RgbaImage;
use viewer::picture::png::compare;
use viewer::picture::renderer::PictureOptions;
use viewer::picture::tiles::AnySizeRenderer;
use viewer::scene::models::Scene;
use viewer::technique::Technique;

use crate::gpu_device::gpu;
use crate::gpu_render::{own_model, scene_of, technique};

/// 4 x 4 parts of 768 pixels a side, of which 256 are taken.
const SIZE: [u32; 2] = [1000, 800];
const PART_PX: u32 = 768;

/// Draws a mesh at once and in parts. The renderers go on from technique to technique.
struct Drawn {
    scene: Scene,
    at_once: Option<AnySizeRenderer>,
    in_parts: Option<AnySizeRenderer>,
    /// Linked strokes need a picture of the whole before the parts.
    in_linked_parts: Option<AnySizeRenderer>,
}

impl Drawn {
    fn new(mesh: &EdgeMesh) -> Self {
        let scene = scene_of(mesh);
        Self { scene, at_once: None, in_parts: None, in_linked_parts: None }
    }

    /// The share of pixels that differ, and where the picture is written where that is much.
    fn difference(&mut self, camera: &Camera, technique: &Technique, name: &str) -> f64 {
        let Self { scene, at_once, in_parts, in_linked_parts } = self;
        let (whole, told) = drawn(at_once, scene, technique, camera, u32::MAX);
        assert!(told.is_empty(), "at once");
        let in_parts = if name.starts_with("linked") { in_linked_parts } else { in_parts };
        let (parts, told) = drawn(in_parts, scene, technique, camera, PART_PX);
        let all: Vec<(u32, u32)> = (0..=16).map(|done| (done, 16)).collect();
        assert_eq!(told, all, "each part is told");
        let difference = compare(&parts, &whole).unwrap();
        if let Some(folder) = std::env::var_os("PARTS_OUT") {
            let folder = std::path::PathBuf::from(folder);
            let pictures = [(&whole, "whole"), (&parts, "parts"), (&difference.picture, "diff")];
            for (picture, kind) in pictures {
                picture.save(folder.join(format!("{name}-{kind}.png"))).unwrap();
            }
        }
        difference.share
    }
}

/// The picture by a renderer that is made where there is none, and what it tells of its parts.
fn drawn(
    renderer: &mut Option<AnySizeRenderer>,
    scene: &Scene,
    technique: &Technique,
    camera: &Camera,
    part_px: u32,
) -> (RgbaImage, Vec<(u32, u32)>) {
    let options = PictureOptions { size: SIZE, ..PictureOptions::default() };
    let renderer = match renderer {
        Some(renderer) => {
            renderer.reload(scene, technique, &[], &options).unwrap();
            renderer
        }
        None => renderer.insert(
            AnySizeRenderer::with_parts(gpu(), scene, technique, &[], &options, part_px).unwrap(),
        ),
    };
    let mut told = Vec::new();
    let picture = renderer.render(camera, &mut |done, total| {
        told.push((done, total));
        Ok(())
    });
    (picture.unwrap().0, told)
}

/// A technique with settings, from where it is seen, and the share that may differ.
type Case<'a> = (&'a str, &'a [&'a str], &'a [(&'a Camera, &'a str)], f64);

/// Surfaces, detectors, strokes edge by edge, linked strokes with all that varies along
/// them, patterns of the picture, from outside and from so near that much is cut off.
#[test]
fn parts_are_the_same_picture() {
    let knot = own_model("torus_knot");
    let far = Camera::default_view(&knot.bounds);
    let near = Camera { eye: far.target + (far.eye - far.target) * 0.4, ..far };
    let flat = Camera { is_orthographic: true, ..far };
    let linked = ["strokes.wobble=3", "strokes.taper=30,60", "strokes.width=5"];
    // Where strokes are linked, the smaller picture of the whole tells where they end.
    let cases: [Case; 8] = [
        ("ink", &[], &[(&far, "far"), (&near, "near"), (&flat, "flat")], 0.0001),
        ("linked", &linked, &[(&far, "far"), (&near, "near"), (&flat, "flat")], 0.001),
        ("hidden_line", &[], &[(&flat, "flat")], 0.0001),
        ("charcoal", &["strokes.parameterization=screen"], &[(&near, "near")], 0.0001),
        ("hatching", &[], &[(&near, "near")], 0.0001),
        ("outline_combined", &[], &[(&far, "far")], 0.0001),
        ("outline_wide", &[], &[(&near, "near")], 0.0001),
        ("watercolour", &[], &[(&far, "far")], 0.0001),
    ];
    let mut drawn = Drawn::new(&knot);
    for (name, settings, cameras, allowed) in cases {
        let technique = technique(name, settings);
        for (camera, from) in cameras {
            let share = drawn.difference(camera, &technique, &format!("{name}-{from}"));
            assert!(share <= allowed, "{name}, {from}: {:.4} % differ", share * 100.0);
        }
    }
}
