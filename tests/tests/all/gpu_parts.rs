//! Pictures drawn in tiles equal those drawn at once.

use edgemesh::edge_mesh::EdgeMesh;
use edgemesh::view::Camera;
use viewer::picture::png::compare;
use viewer::picture::renderer::{PictureInput, PictureOptions};
use viewer::picture::tiles::AnySizeRenderer;
use viewer::technique::Technique;

use crate::gpu_device::gpu;
use crate::gpu_render::{own_model, scene_of, technique};

/// 4 x 4 tiles of 768 pixels a side, of which 256 are kept.
const SIZE: [u32; 2] = [1000, 800];
const TILE_PX: u32 = 768;

/// The share of pixels that differ, and where the picture is written where that is much.
fn difference(mesh: &EdgeMesh, camera: &Camera, technique: &Technique, name: &str) -> f64 {
    let scene = scene_of(mesh);
    let options = PictureOptions { size: SIZE, ..PictureOptions::default() };
    let drawn = |tile_px| {
        let mut renderer = AnySizeRenderer::with_tiles(
            gpu(),
            PictureInput::new(&scene, technique),
            &options,
            tile_px,
        )
        .unwrap();
        let mut told = Vec::new();
        let picture = renderer.render(camera, &mut |done, total| {
            told.push((done, total));
            Ok(())
        });
        (picture.unwrap().0, told)
    };
    let (whole, told) = drawn(u32::MAX);
    assert!(told.is_empty(), "at once");
    let (tiles, told) = drawn(TILE_PX);
    let all: Vec<(u32, u32)> = (0..=16).map(|done| (done, 16)).collect();
    assert_eq!(told, all, "progress before each tile");
    let difference = compare(&tiles, &whole).unwrap();
    if let Some(folder) = std::env::var_os("TILES_OUT") {
        let folder = std::path::PathBuf::from(folder);
        for (picture, kind) in [(&whole, "whole"), (&tiles, "tiles"), (&difference.picture, "diff")]
        {
            picture.save(folder.join(format!("{name}-{kind}.png"))).unwrap();
        }
    }
    difference.share
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
    for (name, settings, cameras, allowed) in cases {
        let technique = technique(name, settings);
        for (camera, from) in cameras {
            let share = difference(&knot, camera, &technique, &format!("{name}-{from}"));
            assert!(share <= allowed, "{name}, {from}: {:.4} % differ", share * 100.0);
        }
    }
}
