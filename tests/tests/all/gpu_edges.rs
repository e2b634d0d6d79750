//! Edge detectors in closed form: their results for a constant, a step, a ramp and a
//! corner by the formulas of the papers.

use std::fmt::Write as _;
use std::path::Path;

use edgemesh::build::{BuildOptions, build_edge_mesh};
use edgemesh::edge_mesh::EdgeMesh;
use edgemesh::format::read::read_model;
use edgemesh::view::Camera;
use glam::DVec3;
use strokes::read_texels;
use viewer::picture::renderer::{PictureInput, PictureOptions, PictureRenderer};
use viewer::technique::library::Library;

use crate::gpu_device::gpu;
use crate::gpu_render::scene_of;

/// Pixels per side of the picture, which shows 8 x 8 units.
const SIDE: u32 = 32;
/// Units per pixel.
const PIXEL: f64 = 8.0 / 32.0;

/// A strip of the scene from the bottom to the top of the picture: its left and right ends
/// with their heights toward the eye.
type Strip = [[f64; 2]; 2];

/// Strips as a model, each with its own material.
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

/// The middle row of a detector's output.
fn row(mesh: &EdgeMesh, folder: &Path, passes: &str) -> Vec<f32> {
    let texels = texels(mesh, folder, passes);
    let start = (SIDE * SIDE / 2) as usize;
    texels[start..start + SIDE as usize].iter().map(|texel| texel[0]).collect()
}

/// The texels of the texture `out`, row by row.
fn texels(mesh: &EdgeMesh, folder: &Path, passes: &str) -> Vec<[f32; 4]> {
    let path = folder.join("detector.toml");
    std::fs::write(&path, passes).unwrap();
    let technique =
        Library::shipped().technique_file(&path).unwrap_or_else(|mistakes| panic!("{mistakes}")).0;
    let options = PictureOptions { size: [SIDE; 2], samples: 1, ..PictureOptions::default() };
    let scene = scene_of(mesh);
    let mut renderer =
        PictureRenderer::new(gpu(), PictureInput::new(&scene, &technique), &options).unwrap();
    renderer.render(&camera()).unwrap();
    read_texels(gpu(), renderer.generated("out_color").unwrap()).unwrap()
}

/// A camera that looks along -z, at 8 units of height.
fn camera() -> Camera {
    Camera {
        eye: DVec3::new(0.0, 0.0, 10.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        fov_y_rad: 2.0 * 0.4_f64.atan(),
        is_orthographic: true,
    }
}

/// A detector after a pass that draws its inputs; its lines are white on black.
fn detector(component: &str, more: &str) -> String {
    let reads = match component {
        name if name.contains("normals") => "normal_texture = \"<generated>:scene_normal\"",
        name if name.contains("ids") => "id_texture = \"<generated>:scene_region\"",
        name if name.contains("planes") => {
            "normal_texture = \"<generated>:scene_normal\"\ndepth_texture = \"<generated>:scene_depth\""
        }
        name if name.contains("chiang") || name.contains("combined") => {
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

/// Compares a row with the expected values of some columns, and zero elsewhere.
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
/// Rises by a quarter of a unit per unit.
const RAMP: [Strip; 1] = [[[-20.0, -5.0], [20.0, 5.0]]];
/// Falls off to both sides of x = 0 by half a unit per unit.
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
    // Forty units per unit: depth differences find edges everywhere.
    let steep = [[[-20.0, -800.0], [20.0, 800.0]]];
    for (of, what) in [(&FLAT[..], "a constant"), (&RAMP, "a ramp"), (&steep, "a steep ramp")] {
        expect(&measure(of, 0.05), &[], what);
    }
    // The step is 0.4 units, at 0.25 units per pixel.
    for (threshold, is_edge) in [(1.59, 1.0), (1.61, 0.0)] {
        let edges = BESIDE.map(|column| (column, is_edge));
        expect(&measure(&STEP, threshold), &edges, "a step in pixels");
    }
}

/// As in the thesis: a boundary between two texels makes both of them edges.
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

/// The output of passes that read a pattern: a WGSL expression of the texel's column and
/// row, the same for all four channels.
pub(crate) fn of_pattern(folder: &Path, pattern: &str, passes: &str) -> Vec<[f32; 4]> {
    let program = format!(
        "@fragment\nfn pattern(@builtin(position) at: vec4f) -> @location(0) vec4f {{\n\
         let column = floor(at.x);\nlet row = floor(at.y);\nreturn vec4f({pattern});\n}}\n"
    );
    std::fs::write(folder.join("pattern.wgsl"), program).unwrap();
    let passes = format!(
        "[component.pattern]\ninherits = \"process_texture\"\n\
         modify = {{ fragment_program = {{ default = \"pattern:pattern\" }} }}\n\
         [[pass]]\ncomponent = \"pattern\"\nrender_target = \"pattern\"\n\
         render_target_format = \"rgba32f\"\n{passes}"
    );
    texels(&strips(folder, &FLAT), folder, &passes)
}

/// A channel of the middle row.
fn middle_row(texels: &[[f32; 4]], channel: usize) -> Vec<f32> {
    let start = (SIDE * SIDE / 2) as usize;
    texels[start..start + SIDE as usize].iter().map(|texel| texel[channel]).collect()
}

const STEP_PATTERN: &str = "select(0.2, 0.6, column >= 16.0)";
const RAMP_PATTERN: &str = "0.01 * column";
/// Up to x = 16 and down again.
const CORNER_PATTERN: &str = "0.02 * min(column, 31.0 - column)";
/// The quarter to the right and below.
const QUARTER_PATTERN: &str = "select(0.0, 1.0, column >= 16.0 && row >= 16.0)";

fn all_columns(value: impl Fn(usize) -> f64) -> Vec<(usize, f64)> {
    (0..32).map(|column| (column, value(column))).collect()
}

#[test]
fn sobel_gives_the_gradient_by_its_kernels() {
    let folder = tempfile::tempdir().unwrap();
    let gradient = |pattern: &str, magnitude: &str| {
        let passes = format!(
            "[[pass]]\ncomponent = \"sobel_gradient\"\ntexture = \"<generated>:pattern_color\"\n\
             magnitude = \"{magnitude}\"\nrender_target = \"out\""
        );
        of_pattern(folder.path(), pattern, &passes)
    };
    expect(&middle_row(&gradient("0.7", "root"), 2), &[], "a constant");
    let step = BESIDE.map(|column| (column, 4.0 * 0.4));
    expect(&middle_row(&gradient(STEP_PATTERN, "root"), 2), &step, "a step");
    // At the rims the texel itself stands for what lies beyond.
    let rim = |column: usize| if column == 0 || column == 31 { 4.0 } else { 8.0 };
    let ramp = all_columns(|column| rim(column) * 0.01);
    expect(&middle_row(&gradient(RAMP_PATTERN, "root"), 0), &ramp, "a ramp");
    let corner = all_columns(|column| match column {
        15 => 4.0 * 0.02,
        16 => -4.0 * 0.02,
        0..15 => rim(column) * 0.02,
        _ => -rim(column) * 0.02,
    });
    expect(&middle_row(&gradient(CORNER_PATTERN, "root"), 0), &corner, "a corner");
    // Equations 3.1 to 3.3 at the corner of a quarter: one texel of nine inside, and from
    // within the other way around.
    for (magnitude, factor) in [("root", 2.0_f64.sqrt()), ("sum", 2.0)] {
        let found = gradient(QUARTER_PATTERN, magnitude);
        for (column, row, along) in [(15, 15, 1.0), (16, 16, 3.0)] {
            let texel = found[row * 32 + column].map(f64::from);
            let wanted = [along, along, factor * along, std::f64::consts::FRAC_PI_4];
            let error = texel.iter().zip(wanted).map(|(found, want)| (found - want).abs());
            assert!(error.fold(0.0, f64::max) < 1e-5, "{magnitude}: {texel:?}, not {wanted:?}");
        }
    }
}

#[test]
fn sobel_draws_lines_intensities_and_orientations() {
    let folder = tempfile::tempdir().unwrap();
    let found = |pattern: &str, more: &str| {
        let passes = format!(
            "[[pass]]\ncomponent = \"edge_detect_sobel\"\nrender_target = \"out\"\n\
             texture = \"<generated>:pattern_color\"\nrender_target_format = \"rgba32f\"\n\
             edge_color = \"#ffffff\"\nbackground_color = \"#000000\"\n{more}"
        );
        of_pattern(folder.path(), pattern, &passes)
    };
    for (threshold, is_edge) in [(1.59, 1.0), (1.61, 0.0)] {
        let lines = middle_row(&found(STEP_PATTERN, &format!("threshold = {threshold}")), 0);
        expect(&lines, &BESIDE.map(|column| (column, is_edge)), "a step by its threshold");
    }
    let intensities = "threshold = 0.5\nshow = \"intensities\"";
    let step = BESIDE.map(|column| (column, 0.5 * 1.6));
    expect(&middle_row(&found(STEP_PATTERN, intensities), 0), &step, "intensities");
    // A gradient to the right has the hue at angle 0, red; one downward a later hue.
    let hues = found(STEP_PATTERN, "threshold = 1\nshow = \"orientation\"");
    let wanted = [1.0, 0.25, 0.25];
    let found = hues[16 * 32 + 16];
    assert!((0..3).all(|at| (found[at] - wanted[at]).abs() < 1e-5), "{found:?}, not {wanted:?}");
    // Only green changes: a tenth less than its weight in the intensity.
    let passes = |channels: &str| {
        format!(
            "[[pass]]\ncomponent = \"sobel_gradient\"\ntexture = \"<generated>:pattern_color\"\n\
             channels = \"{channels}\"\nrender_target = \"out\""
        )
    };
    let green = "0.0, select(0.0, 1.0, column >= 16.0), 0.5, 1.0";
    for (channels, size) in [("intensity", 0.6 * 4.0), ("largest", 4.0)] {
        let found = middle_row(&of_pattern(folder.path(), green, &passes(channels)), 2);
        expect(&found, &BESIDE.map(|column| (column, size)), channels);
    }
}

/// Equation 3.6, less its mean over the window, summed over columns.
fn laplacian_weights(sigma: f64) -> Vec<(i32, f64)> {
    #[expect(clippy::cast_possible_truncation, reason = "a few texels")]
    let reach = (4.0 * sigma).ceil() as i32;
    let weight = |x: i32, y: i32| {
        let sigma_2 = sigma * sigma;
        let part = f64::from(x * x + y * y) / (2.0 * sigma_2);
        -(1.0 - part) * (-part).exp() / (std::f64::consts::PI * sigma_2 * sigma_2)
    };
    let column = |x: i32| (-reach..=reach).map(|y| weight(x, y)).sum::<f64>();
    let columns: Vec<(i32, f64)> = (-reach..=reach).map(|x| (x, column(x))).collect();
    let mean = columns.iter().map(|column| column.1).sum::<f64>() / f64::from(2 * reach + 1);
    columns.into_iter().map(|(x, weight)| (x, weight - mean)).collect()
}

#[test]
fn laplacian_of_gaussian_is_its_sum_and_crosses_zero_at_a_step() {
    let folder = tempfile::tempdir().unwrap();
    let sigma = 1.2;
    let passes = format!(
        "[[pass]]\ncomponent = \"laplacian_of_gaussian\"\nsigma = {sigma}\n\
         texture = \"<generated>:pattern_color\"\nrender_target = \"out\"\n\
         render_target_format = \"rgba32f\""
    );
    let laplacian = |pattern: &str| middle_row(&of_pattern(folder.path(), pattern, &passes), 0);
    let sum = |value: &dyn Fn(i32) -> f64| {
        all_columns(|column| {
            let at = i32::try_from(column).unwrap();
            let texels = laplacian_weights(sigma).into_iter();
            texels.map(|(x, weight)| weight * value((at + x).clamp(0, 31))).sum()
        })
    };
    expect(&laplacian("0.7"), &[], "a constant");
    let step = sum(&|column| if column >= 16 { 0.6 } else { 0.2 });
    assert!(step[15].1 > 0.01 && step[16].1 < -0.01, "{step:?}");
    expect(&laplacian(STEP_PATTERN), &step, "a step");
    let ramp = sum(&|column| 0.01 * f64::from(column));
    assert!(ramp[16].1.abs() < 1e-9, "{ramp:?}");
    expect(&laplacian(RAMP_PATTERN), &ramp, "a ramp");
    let corner = sum(&|column| 0.02 * f64::from(column.min(31 - column)));
    expect(&laplacian(CORNER_PATTERN), &corner, "a corner");

    let crossings = |pattern: &str, threshold: f64| {
        let passes = passes.replace("\"out\"", "\"second\"").replace("rgba32f", "r32f");
        let passes = format!(
            "{passes}\n[[pass]]\ncomponent = \"edge_detect_zero_crossings\"\n\
             texture = \"<generated>:second_color\"\nrender_target = \"out\"\n\
             render_target_format = \"rgba32f\"\nthreshold = {threshold}\n\
             edge_color = \"#ffffff\"\nbackground_color = \"#000000\""
        );
        middle_row(&of_pattern(folder.path(), pattern, &passes), 0)
    };
    let height = step[15].1 - step[16].1;
    for (threshold, is_edge) in [(height - 1e-4, 1.0), (height + 1e-4, 0.0)] {
        let edges = BESIDE.map(|column| (column, is_edge));
        expect(&crossings(STEP_PATTERN, threshold), &edges, "zero crossings of a step");
    }
    expect(&crossings("0.7", 1e-4), &[], "zero crossings of a constant");
    expect(&crossings(RAMP_PATTERN, 0.01), &[], "zero crossings of a ramp");
}

/// Card and Mitchell, Listings 9 and 10: two of four diagonal taps are beyond a step.
#[test]
fn five_taps_look_along_the_diagonals() {
    let folder = tempfile::tempdir().unwrap();
    let lines = |component: &str, pattern: &str, threshold: f64| {
        let passes = format!(
            "[[pass]]\ncomponent = \"{component}\"\nrender_target = \"out\"\n\
             normal_texture = \"<generated>:pattern_color\"\nthreshold = {threshold}\n\
             render_target_format = \"rgba32f\"\nedge_color = \"#ffffff\"\n\
             background_color = \"#000000\""
        );
        of_pattern(folder.path(), pattern, &passes)
    };
    let of_depth = |pattern: &str, threshold: f64| {
        middle_row(&lines("edge_detect_depth_5_taps", pattern, threshold), 0)
    };
    expect(&of_depth("0.7", 0.001), &[], "a constant");
    for (threshold, is_edge) in [(0.79, 1.0), (0.81, 0.0)] {
        let edges = BESIDE.map(|column| (column, is_edge));
        expect(&of_depth(STEP_PATTERN, threshold), &edges, "a step");
    }
    // Four taps; at the rims half of them are clamped to the texel inside.
    let inner = |least: f64| all_columns(|column| f64::from(column % 31 != 0) * least);
    expect(&of_depth(RAMP_PATTERN, 0.0399), &inner(1.0), "a ramp");
    expect(&of_depth(RAMP_PATTERN, 0.0401), &[], "a ramp below the threshold");
    // Both sides of the top are equally low: two taps differ.
    let but_top = all_columns(|column| f64::from(![0, 15, 16, 31].contains(&column)));
    expect(&of_depth(CORNER_PATTERN, 0.0799), &but_top, "a corner");

    // Normals along z and 60 degrees from it toward x: (sqrt(3)/2, 0, 1/2).
    let tilted = "select(vec3f(0.5, 0.5, 1.0), vec3f(0.9330127, 0.5, 0.75), column >= 16.0), 1.0";
    for (threshold, is_edge) in [(0.49, 0.0), (0.51, 1.0)] {
        let found = lines("edge_detect_normals_5_taps", tilted, threshold);
        let edges = BESIDE.map(|column| (column, is_edge));
        expect(&middle_row(&found, 0), &edges, "normals by their threshold");
    }
}

/// Chiang et al., section III.C: both Sobel operators, and the extra filter.
#[test]
fn chiang_adds_gradients_and_drops_edges_without_a_step_of_depth() {
    let folder = tempfile::tempdir().unwrap();
    let measure = |of: &[Strip], more: &str| {
        let mesh = strips(folder.path(), of);
        row(&mesh, folder.path(), &detector("edge_detect_chiang", more))
    };
    // The depth map goes from end to end of the bounding sphere, with a margin.
    let mesh = strips(folder.path(), &STEP);
    let range = |mesh: &EdgeMesh| 2.02 * mesh.bounds.radius();
    // The gradient is four times the step, and so is the sum of the differences to three of
    // eight neighbors, with the middle one twice.
    let height = 4.0 * 0.4 / range(&mesh);
    let edges = |is_edge: f64| BESIDE.map(|column| (column, is_edge));
    for (factor, is_edge) in [(0.999, 1.0), (1.001, 0.0)] {
        let threshold = format!("{:.9}", factor * height);
        let depths = format!("depth_threshold = {threshold}\nextra_filter = false");
        expect(&measure(&STEP, &depths), &edges(is_edge), "a step by the threshold");
        let extra = format!("depth_threshold = 0.00001\nextra_threshold = {threshold}");
        expect(&measure(&STEP, &extra), &edges(is_edge), "a step by the extra threshold");
    }
    expect(&measure(&FLAT, "depth_threshold = 0.00001\nextra_filter = false"), &[], "a constant");
    // A corner is an edge in normals alone: x goes from -1 / sqrt(5) to 1 / sqrt(5), which
    // is half of that in colors, times four.
    let gradient = 4.0 / 5.0_f64.sqrt();
    for (factor, is_edge) in [(0.999, 1.0), (1.001, 0.0)] {
        let normals = format!("normal_threshold = {:.9}\ndepth_threshold = 16", factor * gradient);
        let unfiltered = format!("{normals}\nextra_filter = false");
        expect(&measure(&CORNER, &unfiltered), &edges(is_edge), "a corner");
        // On either side of the top the depth changes as on a slope: the three neighbors on
        // one side are half a pixel lower, and those beyond the top are level.
        expect(&measure(&CORNER, &format!("{normals}\nextra_threshold = 1")), &[], "filtered");
    }
    // As printed, derivatives keep their signs: only an increase of depth or brightness to
    // the right counts.
    let printed = format!(
        "depth_threshold = {:.9}\nextra_filter = false\n\
                           gradient = \"printed\"",
        0.5 * height
    );
    expect(&measure(&STEP, &printed), &[], "a step toward the eye as printed");
    let away = [STEP[0].map(|[x, z]| [x, z + 0.4]), STEP[1].map(|[x, z]| [x, z - 0.4])];
    expect(&measure(&away, &printed), &edges(1.0), "a step away from the eye as printed");
}

#[test]
fn combined_detector_has_a_color_for_each_kind() {
    let folder = tempfile::tempdir().unwrap();
    let found = |of: &[Strip], more: &str| {
        let passes = detector(
            "edge_detect_combined",
            &format!(
                "id_texture = \"<generated>:scene_region\"\ndepth_unit = \"scene\"\n\
                 normal_color = \"#200000\"\ndepth_color = \"#400000\"\n\
                 id_color = \"#800000\"\n{more}"
            ),
        );
        row(&strips(folder.path(), of), folder.path(), &passes)
    };
    let edges = |color: f64| BESIDE.map(|column| (column, color / 255.0));
    let [normal, depth, id, several] = [32.0, 64.0, 128.0, 255.0];
    let level = [[[-20.0, 0.0], [0.0, 0.0]], [[0.0, 0.0], [20.0, 0.0]]];
    let all = "normal_threshold = 0.9\ndepth_threshold = 0.2";
    let without = |kinds: &[&str]| {
        kinds.iter().fold(all.to_owned(), |text, kind| format!("{text}\ndetect_{kind} = false"))
    };
    expect(&found(&FLAT, all), &[], "a constant");
    expect(&found(&level, all), &edges(id), "materials alone");
    expect(&found(&STEP, all), &edges(several), "a step between materials");
    expect(&found(&STEP, &without(&["ids"])), &edges(depth), "a step alone");
    expect(&found(&CORNER, all), &edges(several), "a corner between materials");
    expect(&found(&CORNER, &without(&["ids"])), &edges(normal), "a corner alone");
    expect(&found(&CORNER, &without(&["ids", "normals"])), &[], "a corner without its detectors");
    // Without thresholds the strongest gives the color: the factor times 1 - cosine.
    let cosine = (1.0 - 0.25) / (1.0 + 0.25);
    let strength =
        format!("{}\napply_threshold = false\nnormal_threshold = 2.0", without(&["ids"]))
            .replace("normal_threshold = 0.9\n", "");
    let rims = |column: usize| column == 0 || column == 31;
    let normal_strength = 2.0 * (1.0 - cosine);
    let bend = |of: f64| 0.2 * of * 0.5 * PIXEL;
    let wanted = all_columns(|column| match column {
        15 | 16 => normal_strength * normal / 255.0,
        // At the rims only the depth bends.
        _ if rims(column) => bend(1.0) * depth / 255.0,
        _ => 0.0,
    });
    expect(&found(&CORNER, &strength), &wanted, "without thresholds");
}
