//! Pictures drawn in tiles equal those drawn at once.

use edgemesh::edge_mesh::EdgeMesh;
use edgemesh::view::Camera;
use image::RgbaImage;
use viewer::picture::png::compare;
use viewer::picture::renderer::{PictureInput, PictureOptions};
use viewer::picture::tiles::AnySizeRenderer;
use viewer::scene::models::Scene;
use viewer::technique::Technique;

use crate::gpu_device::gpu;
use crate::gpu_render::{own_model, scene_of, technique};

/// 4 x 4 tiles of 768 pixels a side, of which 256 are kept.
const SIZE: [u32; 2] = [1000, 800];
const TILE_PX: u32 = 768;

/// Draws a mesh at once and in tiles. Each renderer goes on from technique to technique.
struct Pictures {
    scene: Scene,
    whole: Option<AnySizeRenderer>,
    tiles: Option<AnySizeRenderer>,
    /// Linked strokes need a picture of the whole before the tiles.
    linked_tiles: Option<AnySizeRenderer>,
}

impl Pictures {
    fn new(mesh: &EdgeMesh) -> Self {
        Self { scene: scene_of(mesh), whole: None, tiles: None, linked_tiles: None }
    }

    /// The share of pixels that differ. With `TILES_OUT`, the pictures are written to that
    /// folder.
    fn difference(&mut self, camera: &Camera, technique: &Technique, name: &str) -> f64 {
        let input = PictureInput::new(&self.scene, technique);
        let (whole, progress) = render(&mut self.whole, input, camera, u32::MAX);
        assert!(progress.is_empty(), "at once");
        let is_linked = name.starts_with("linked");
        let renderer = if is_linked { &mut self.linked_tiles } else { &mut self.tiles };
        let (tiles, progress) = render(renderer, input, camera, TILE_PX);
        let all: Vec<(u32, u32)> = (0..=16).map(|done| (done, 16)).collect();
        assert_eq!(progress, all, "progress before each tile");
        let difference = compare(&tiles, &whole).unwrap();
        if let Some(folder) = std::env::var_os("TILES_OUT") {
            let folder = std::path::PathBuf::from(folder);
            let pictures = [(&whole, "whole"), (&tiles, "tiles"), (&difference.picture, "diff")];
            for (picture, kind) in pictures {
                picture.save(folder.join(format!("{name}-{kind}.png"))).unwrap();
            }
        }
        difference.share
    }
}

/// The picture, by the renderer or by a new one, and the progress that is reported.
fn render(
    renderer: &mut Option<AnySizeRenderer>,
    input: PictureInput,
    camera: &Camera,
    tile_px: u32,
) -> (RgbaImage, Vec<(u32, u32)>) {
    let options = PictureOptions { size: SIZE, ..PictureOptions::default() };
    let renderer = match renderer {
        Some(renderer) => {
            renderer.reload(input, &options).unwrap();
            renderer
        }
        None => {
            renderer.insert(AnySizeRenderer::with_tiles(gpu(), input, &options, tile_px).unwrap())
        }
    };
    let mut reports = Vec::new();
    let picture = renderer.render(camera, &mut |done, total| {
        reports.push((done, total));
        Ok(())
    });
    (picture.unwrap().0, reports)
}

/// A technique with settings, from where it is seen, and the share that may differ.
type Case<'a> = (&'a str, &'a [&'a str], &'a [(&'a Camera, &'a str)], f64);

/// Surfaces, detectors, strokes edge by edge, linked strokes with all that varies along
/// them, patterns of the picture, from outside and from so near that much is cut off.
#[test]
fn tiles_are_the_same_picture() {
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
    let mut pictures = Pictures::new(&knot);
    for (name, settings, cameras, allowed) in cases {
        let technique = technique(name, settings);
        for (camera, from) in cameras {
            let share = pictures.difference(camera, &technique, &format!("{name}-{from}"));
            assert!(share <= allowed, "{name}, {from}: {:.4} % differ", share * 100.0);
        }
    }
}
