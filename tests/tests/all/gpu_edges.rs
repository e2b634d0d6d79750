//! Detectors of edges in closed form: what a constant, a step, a ramp and a corner give,
//! by the formulas of the papers.

use std::fmt::Write as _;
use std::path::Path;

use edgemesh::build::{BuildOptions, build_edge_mesh};
use edgemesh::camera::Camera;
use edgemesh::edge_mesh::EdgeMesh;
use edgemesh::read::read_model;
use glam::DVec3;
use strokes::readback::read_texels;
use viewer::render::{PictureOptions, PictureRenderer};
use viewer::technique::library::Library;

use crate::gpu_device::gpu;
use crate::gpu_render::scene_of;

/// Pixels a side of the picture, which shows 8 x 8 units.
const SIDE: u32 = 32;
/// Units a pixel.
const PIXEL: f64 = 8.0 / 32.0;

/// A strip of the scene that goes all through the picture from below to above: left and
/// right end with their heights toward the eye.
type Strip = [[f64; 2]; 2];

/// Strips as a model, each of a material of its own.
fn strips(folder: &Path, strips: &[Strip]) -> EdgeMesh {
    let mut text = String::new();
    for (at, [left, right]) in strips.iter().enumerate() {
        let _ = writeln!(text, "usemtl m{at}");
        for ([x, z], y) in [(left, -20), (right, -20), (right, 20), (left, 20)] {
            let _ = writeln!(text, "v {x} {y} {z}");
        }
        let _ = writeln!(text, "f -4 -3 -2 -1");
    }
    let path = folder.join("strips.obj");
    std::fs::write(&path, text).unwrap();
    let (model, mut report) = read_model(&path).unwrap();
    build_edge_mesh(&model, &BuildOptions::default(), &mut report)
}

/// What a detector writes along the middle row.
fn row(mesh: &EdgeMesh, folder: &Path, passes: &str) -> Vec<f32> {
    let path = folder.join("detector.toml");
    std::fs::write(&path, passes).unwrap();
    let technique =
        Library::shipped().technique_file(&path).unwrap_or_else(|mistakes| panic!("{mistakes}")).0;
    let options = PictureOptions { size: [SIDE; 2], samples: 1, ..PictureOptions::default() };
    let scene = scene_of(mesh);
    let mut renderer = PictureRenderer::new(gpu(), &scene, &technique, &[], &options).unwrap();
    let camera = Camera {
        eye: DVec3::new(0.0, 0.0, 10.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        // 8 units high at a distance of 10.
        fov_y_rad: 2.0 * 0.4_f64.atan(),
        is_orthographic: true,
    };
    renderer.render(&camera).unwrap();
    let texels: Vec<[f32; 4]> =
        read_texels(gpu(), renderer.generated("out_color").unwrap(), 16).unwrap();
    let start = (SIDE * SIDE / 2) as usize;
    texels[start..start + SIDE as usize].iter().map(|texel| texel[0]).collect()
}

/// A detector behind a pass that draws all that it may read, its lines white on black.
fn detector(component: &str, more: &str) -> String {
    let reads = match component {
        name if name.contains("normals") => "normal_texture = \"<generated>:scene_normal\"",
        name if name.contains("ids") => "id_texture = \"<generated>:scene_region\"",
        name if name.contains("planes") => {
            "normal_texture = \"<generated>:scene_normal\"\ndepth_texture = \"<generated>:scene_depth\""
        }
        _ => "depth_texture = \"<generated>:scene_depth\"",
    };
    format!(
        "[[pass]]\ncomponent = \"render_scene_data\"\nregions = \"materials\"\n\
         render_target_format = \"rgba8, rgba32f, rgba8\"\n\n\
         [[pass]]\ncomponent = \"{component}\"\n{reads}\nrender_target = \"out\"\n\
         render_target_format = \"rgba32f\"\nedge_color = \"#ffffff\"\n\
         background_color = \"#000000\"\n{more}\n"
    )
}

/// Compares a row with what is wanted in some columns, and nothing elsewhere.
fn expect(row: &[f32], wanted: &[(usize, f64)], what: &str) {
    for (column, found) in row.iter().enumerate() {
        let want = wanted.iter().find(|known| known.0 == column).map_or(0.0, |known| known.1);
        let error = (f64::from(*found) - want).abs();
        assert!(error < 1e-5, "{what}, column {column}: {found}, not {want}");
    }
}

/// The columns on both sides of x = 0.
const BESIDE: [usize; 2] = [15, 16];

const FLAT: [Strip; 1] = [[[-20.0, 0.0], [20.0, 0.0]]];
const STEP: [Strip; 2] = [[[-20.0, 0.0], [0.0, 0.0]], [[0.0, 0.4], [20.0, 0.4]]];
/// Rises by a quarter of a unit a unit.
const RAMP: [Strip; 1] = [[[-20.0, -5.0], [20.0, 5.0]]];
/// Falls off to both sides of x = 0 by half a unit a unit.
const CORNER: [Strip; 2] = [[[-20.0, -10.0], [0.0, 0.0]], [[0.0, 0.0], [20.0, -10.0]]];

#[test]
fn depth_deltas_are_the_largest_difference() {
    let folder = tempfile::tempdir().unwrap();
    let passes = detector(
        "edge_detect_depth_deltas",
        "apply_threshold = false\nthreshold = 0.5\nunit = \"scene\"",
    );
    let measure = |of: &[Strip]| row(&strips(folder.path(), of), folder.path(), &passes);
    expect(&measure(&FLAT), &[], "a constant");
    expect(&measure(&STEP), &BESIDE.map(|column| (column, 0.5 * 0.4)), "a step");
    let all: Vec<(usize, f64)> = (0..32).map(|column| (column, 0.5 * 0.25 * PIXEL)).collect();
    expect(&measure(&RAMP), &all, "a ramp");
    let all: Vec<(usize, f64)> = (0..32).map(|column| (column, 0.5 * 0.5 * PIXEL)).collect();
    expect(&measure(&CORNER), &all, "a corner");
}

#[test]
fn depth_laplacians_are_nothing_on_planes() {
    let folder = tempfile::tempdir().unwrap();
    let passes = detector(
        "edge_detect_depth_2nd_derivative",
        "apply_threshold = false\nthreshold = 0.5\nunit = \"scene\"",
    );
    let measure = |of: &[Strip]| row(&strips(folder.path(), of), folder.path(), &passes);
    let rims = |column: usize| column == 0 || column == 31;
    expect(&measure(&FLAT), &[], "a constant");
    expect(&measure(&STEP), &BESIDE.map(|column| (column, 0.5 * 0.4)), "a step");
    // At the rims the texel itself stands for what lies beyond.
    let beyond =
        |slope: f64| (0..32).filter(move |c| rims(*c)).map(move |c| (c, 0.5 * slope * PIXEL));
    let ramp: Vec<(usize, f64)> = beyond(0.25).collect();
    expect(&measure(&RAMP), &ramp, "a ramp");
    let corner = BESIDE.map(|column| (column, 0.5 * 0.5 * PIXEL)).into_iter().chain(beyond(0.5));
    expect(&measure(&CORNER), &corner.collect::<Vec<_>>(), "a corner");
}

#[test]
fn normals_give_their_dot_products() {
    let folder = tempfile::tempdir().unwrap();
    let measure = |of: &[Strip], more: &str| {
        let passes = detector("edge_detect_normals", more);
        row(&strips(folder.path(), of), folder.path(), &passes)
    };
    let factor = "apply_threshold = false\nthreshold = 0.5";
    for (of, what) in [(&FLAT[..], "a constant"), (&STEP, "a step"), (&RAMP, "a ramp")] {
        expect(&measure(of, factor), &[], what);
    }
    // The normals (-1/2, 1) and (1/2, 1): Equation 3.8 with one of four that differs.
    let cosine = (1.0 - 0.25) / (1.0 + 0.25);
    let corner = BESIDE.map(|column| (column, 0.5 * (1.0 - cosine)));
    expect(&measure(&CORNER, factor), &corner, "a corner");
    // Equation 3.7: an edge if and only if the cosine is below the threshold.
    for (threshold, is_edge) in [(cosine - 0.01, 0.0), (cosine + 0.01, 1.0)] {
        let found = measure(&CORNER, &format!("threshold = {threshold}"));
        expect(&found, &BESIDE.map(|column| (column, is_edge)), "a corner by its threshold");
    }
}

#[test]
fn planes_have_no_edges_however_steep_and_steps_have() {
    let folder = tempfile::tempdir().unwrap();
    let measure = |of: &[Strip], threshold: f64| {
        let passes = detector("edge_detect_planes", &format!("threshold = {threshold:.3}"));
        row(&strips(folder.path(), of), folder.path(), &passes)
    };
    // Forty units a unit: what a depth difference calls an edge everywhere.
    let steep = [[[-20.0, -800.0], [20.0, 800.0]]];
    for (of, what) in [(&FLAT[..], "a constant"), (&RAMP, "a ramp"), (&steep, "a steep ramp")] {
        expect(&measure(of, 0.05), &[], what);
    }
    // The step is 0.4 units of 0.25 a pixel.
    for (threshold, is_edge) in [(1.59, 1.0), (1.61, 0.0)] {
        let edges = BESIDE.map(|column| (column, is_edge));
        expect(&measure(&STEP, threshold), &edges, "a step in pixels");
    }
}

/// As the thesis says: a boundary between two texels makes an edge of both.
#[test]
fn detected_edges_are_two_pixels_wide() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = strips(folder.path(), &STEP);
    let corner = strips(folder.path(), &CORNER);
    for (component, more, mesh) in [
        ("edge_detect_depth_deltas", "threshold = 0.1\nunit = \"scene\"", &mesh),
        ("edge_detect_depth_2nd_derivative", "threshold = 0.1\nunit = \"scene\"", &mesh),
        ("edge_detect_planes", "threshold = 1", &mesh),
        ("edge_detect_ids", "", &mesh),
        ("edge_detect_normals", "threshold = 0.9", &corner),
    ] {
        let found = row(mesh, folder.path(), &detector(component, more));
        expect(&found, &BESIDE.map(|column| (column, 1.0)), component);
    }
}
