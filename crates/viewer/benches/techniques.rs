//! What each technique that ships costs over plain light: `cargo bench -p viewer --bench
//! techniques`.
//!
//! Frames are timed from their submission until the adapter is done, at 1024x1024 pixels
//! of 4 samples; the frames of all techniques take turns, so that a slow moment slows all
//! of them; medians count. `EDGEMESH_BENCH_MODELS=A.obj:B.ply` measures models of your
//! own instead of the project's torus knot.

#![expect(clippy::unwrap_used, reason = "a bench fails by panicking")]
#![expect(clippy::print_stdout, reason = "the table is its result")]

use std::path::{Path, PathBuf};

use edgemesh::build::{BuildOptions, build_edge_mesh};
use edgemesh::format::read::read_model;
use edgemesh::load::LoadedMesh;
use edgemesh::view::Camera;
use strokes::Gpu;
use viewer::picture::renderer::{PictureInput, PictureOptions, PictureRenderer};
use viewer::scene::models::Scene;
use viewer::technique::library::Library;

/// Frames of each technique; the median counts.
const FRAMES: usize = 11;

/// What the others are compared with.
const PLAIN: &str = "phong";

/// A technique on the GPU.
struct Runner {
    name: String,
    renderer: PictureRenderer,
    times_ms: Vec<f64>,
}

impl Runner {
    fn median(&self) -> f64 {
        let mut times = self.times_ms.clone();
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    }
}

fn scene(path: &Path) -> Scene {
    let (model, mut report) = read_model(path).unwrap();
    let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut report);
    Scene::of(vec![LoadedMesh::new(path.display().to_string(), mesh, report)])
}

fn table(gpu: &Gpu, path: &Path, size: [u32; 2], frames: usize) {
    let scene = scene(path);
    let library = Library::shipped();
    let options = PictureOptions { size, ..PictureOptions::default() };
    let names = library.technique_names().filter(|name| *name != PLAIN);
    let runner = |name: &str| {
        let technique = library.technique(name).unwrap().0;
        let renderer = PictureRenderer::new(gpu, PictureInput::new(&scene, &technique), &options)
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        Runner { name: name.to_owned(), renderer, times_ms: Vec::new() }
    };
    let mut runners: Vec<Runner> = std::iter::once(PLAIN).chain(names).map(runner).collect();
    let camera = Camera::default_view(&scene.bounds);
    for frame in 0..=frames {
        for runner in &mut runners {
            let statistics = runner.renderer.render(&camera).unwrap().1;
            // The first frame makes what the others find.
            if frame > 0 {
                runner.times_ms.push(statistics.frame_ms);
            }
        }
    }
    let triangles = scene.models[0].mesh.triangles.len();
    let [width, height] = size;
    println!("\n{}, {triangles} triangles, {width}x{height}, {}", path.display(), gpu.info.name);
    println!("{:<18}{:>9}{:>16}", "", "ms", "times phong");
    let plain = runners[0].median();
    for runner in &runners {
        println!("{:<18}{:>9.1}{:>16.2}", runner.name, runner.median(), runner.median() / plain);
    }
}

fn main() {
    // `cargo test --benches` only asks whether it runs.
    let is_test = !std::env::args().any(|argument| argument == "--bench");
    let gpu = pollster::block_on(Gpu::open(None)).unwrap();
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/torus_knot.obj");
    let models: Vec<PathBuf> = match std::env::var_os("EDGEMESH_BENCH_MODELS") {
        Some(paths) if !is_test => std::env::split_paths(&paths).collect(),
        _ => vec![own],
    };
    for model in models {
        match is_test {
            true => table(&gpu, &model, [64; 2], 1),
            false => table(&gpu, &model, [1024; 2], FRAMES),
        }
    }
}
