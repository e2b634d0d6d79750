//! Table I of Chiang et al. again: one detector on the CPU and on the GPU, at 512x512
//! pixels, for models of four sizes: `cargo bench -p viewer --bench table_1`.
//!
//! Both draw the normal map and the depth map on the adapter. On the GPU a pass detects
//! edges there; on the CPU both maps are read back and all cores detect
//! (`edgemesh::oracle::detector::chiang`). A frame is timed until its edges are there;
//! the frames of both take turns, and medians count. The detectors alone are beside them:
//! the GPU's by timestamps, the CPU's without reading back.
//!
//! `EDGEMESH_BENCH_MODELS=A.obj:B.ply` measures models of your own instead of four of the
//! project's.

#![expect(clippy::unwrap_used, reason = "a bench fails by panicking")]
#![expect(clippy::print_stdout, reason = "the table is its result")]

use std::path::{Path, PathBuf};
use std::time::Instant;

use edgemesh::build::{BuildOptions, build_edge_mesh};
use edgemesh::format::read::read_model;
use edgemesh::load::LoadedMesh;
use edgemesh::oracle::detector::Image;
use edgemesh::oracle::detector::chiang::{ChiangOptions, chiang};
use edgemesh::oracle::detector::depth::DepthMapping;
use edgemesh::view::Camera;
use glam::Vec2;
use strokes::{FrameUniform, Gpu, Tile, read_texels};
use viewer::picture::renderer::{PictureInput, PictureOptions, PictureRenderer};
use viewer::scene::lighting::Lighting;
use viewer::scene::models::Scene;
use viewer::technique::Technique;
use viewer::technique::library::Library;

/// Frames of each; the median counts.
const FRAMES: usize = 41;

/// Both maps.
const MAPS: &str = "
[[pass]]
component = 'render_normals'
render_target = 'maps'
render_target_format = 'rgba8'
";

/// Edges of both maps, with every constant as the component has it.
const DETECTOR: &str = "
[[pass]]
name = 'detector'
component = 'edge_detect_chiang'
normal_texture = '<generated>:maps_color'
depth_texture = '<generated>:maps_depth'
";

/// The same constants.
const OPTIONS: ChiangOptions = ChiangOptions {
    normal_threshold: 0.8,
    depth_threshold: 0.1,
    extra_threshold: Some(0.06),
    is_as_printed: false,
};

fn technique(passes: &str) -> Technique {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("table_1.toml");
    std::fs::write(&path, passes).unwrap();
    Library::shipped().technique_file(&path).unwrap().0
}

/// Milliseconds of frames, and of the detector alone.
#[derive(Default)]
struct Times {
    frames: Vec<f64>,
    detector: Vec<f64>,
}

fn median_seconds(times_ms: &[f64]) -> f64 {
    let mut times = times_ms.to_vec();
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).map_or(f64::NAN, |median| median / 1e3)
}

/// One model: its line of the table.
fn measure(gpu: &Gpu, path: &Path, side: u32, frames: usize) {
    let (model, mut report) = read_model(path).unwrap();
    let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut report);
    let triangles = mesh.triangles.len();
    let scene = Scene::of(vec![LoadedMesh::new(path.display().to_string(), mesh, report)]);
    let options = PictureOptions { size: [side; 2], samples: 1, ..PictureOptions::default() };
    let renderer = |passes: &str| {
        PictureRenderer::new(gpu, PictureInput::new(&scene, &technique(passes)), &options)
    };
    let mut on_gpu = renderer(&format!("{MAPS}{DETECTOR}")).unwrap();
    let mut maps = renderer(MAPS).unwrap();
    let camera = Camera::default_view(&scene.bounds);
    let view = camera.view(&scene.bounds, 1.0);
    let around = Lighting::default().surroundings(&view, &scene.bounds, &scene.frame);
    let frame = FrameUniform::new(&view, &Tile::whole(Vec2::splat(side as f32)), &around);
    let mapping = DepthMapping { projection: frame.projection, range: frame.depth_range };
    let [mut of_gpu, mut of_cpu] = [Times::default(), Times::default()];
    for _ in 0..frames {
        let statistics = on_gpu.render(&camera).unwrap().1;
        of_gpu.frames.push(statistics.frame_ms);
        let pass = statistics.passes.iter().find(|pass| pass.0 == "detector");
        of_gpu.detector.extend(pass.and_then(|pass| pass.1));

        let drawn_ms = maps.render(&camera).unwrap().1.frame_ms;
        let started = Instant::now();
        let normals = read_texels(gpu, maps.generated("maps_color").unwrap()).unwrap();
        let depths = read_texels(gpu, maps.generated("maps_depth").unwrap()).unwrap();
        let normals = Image::new(side as usize, normals).unwrap();
        let depths = Image::new(side as usize, depths).unwrap();
        let detecting = Instant::now();
        chiang(&normals, &depths, &mapping, &OPTIONS).unwrap();
        of_cpu.detector.push(detecting.elapsed().as_secs_f64() * 1e3);
        of_cpu.frames.push(drawn_ms + started.elapsed().as_secs_f64() * 1e3);
    }
    let [cpu, gpu, cpu_detector, gpu_detector] =
        [&of_cpu.frames, &of_gpu.frames, &of_cpu.detector, &of_gpu.detector]
            .map(|times| median_seconds(times));
    println!(
        "{:<16}{triangles:>10}{cpu:>12.6}{gpu:>12.6}{:>8.2}{cpu_detector:>16.6}{gpu_detector:>12.6}\
         {:>8.2}",
        path.file_stem().unwrap_or_default().to_string_lossy(),
        cpu / gpu,
        cpu_detector / gpu_detector
    );
}

fn main() {
    // `cargo test --benches` only asks whether it runs.
    let is_test = !std::env::args().any(|argument| argument == "--bench");
    let (side, frames) = if is_test { (64, 1) } else { (512, FRAMES) };
    let gpu = pollster::block_on(Gpu::open(None)).unwrap();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models");
    let own = ["cube", "bracket", "wave_blob", "torus_knot"];
    let models: Vec<PathBuf> = match std::env::var_os("EDGEMESH_BENCH_MODELS") {
        Some(paths) if !is_test => std::env::split_paths(&paths).collect(),
        _ => own.map(|name| folder.join(format!("{name}.obj"))).into(),
    };
    println!("{side}x{side}, {}, {} cores", gpu.info.name, rayon::current_num_threads());
    println!("{:<26}{:>32}{:>36}", "", "seconds a frame", "the detector alone, seconds");
    println!(
        "{:<16}{:>10}{:>12}{:>12}{:>8}{:>16}{:>12}{:>8}",
        "model", "triangles", "CPU", "GPU", "ratio", "CPU", "GPU", "ratio"
    );
    for model in models {
        measure(&gpu, &model, side, frames);
    }
}
