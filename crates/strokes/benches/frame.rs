//! What a frame costs on the GPU: `cargo bench -p strokes`.
//!
//! Passes are measured by timestamp queries; the fill alone is the yardstick.
//! `EDGEMESH_BENCH_MODEL=FILE.obj` measures a model of your own, else the
//! project's torus knot. `WGPU_BACKEND` chooses the backend.

#![expect(clippy::unwrap_used, reason = "a bench fails by panicking")]
#![expect(clippy::print_stderr, reason = "the adapter and the medians of the passes")]

use std::path::PathBuf;

use criterion::{Criterion, criterion_group, criterion_main};
use edgemesh::build::{BuildOptions, build_edge_mesh};
use edgemesh::camera::Camera;
use edgemesh::edge_mesh::EdgeMesh;
use edgemesh::read::read_model;
use glam::Vec2;
use strokes::brush::Brush;
use strokes::frame::FrameUniform;
use strokes::gpu::{self, Gpu};
use strokes::gpu_time::GpuTimer;
use strokes::mesh_buffers::MeshBuffers;
use strokes::renderer::{Look, MeshDraw, PASS_NAMES, Renderer};
use strokes::stroke::StrokeStyle;
use strokes::targets::Targets;

const SIZE_PX: u32 = 1024;

/// Frames whose passes are measured; the median is printed.
const MEASURED_FRAMES: usize = 20;

struct Bench {
    gpu: Gpu,
    mesh: EdgeMesh,
    view: FrameUniform,
}

impl Bench {
    fn new() -> Self {
        let model = std::env::var_os("EDGEMESH_BENCH_MODEL").map_or_else(
            || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../models/torus_knot.obj")),
            PathBuf::from,
        );
        let (source, mut report) = read_model(&model).unwrap();
        let mesh = build_edge_mesh(&source, &BuildOptions::default(), &mut report);
        let view = Camera::default_view(&mesh.bounds).view(&mesh.bounds, 1.0);
        let gpu = pollster::block_on(gpu::open(None)).unwrap();
        eprintln!(
            "{}: {} triangles, {} edges, on {}",
            model.display(),
            mesh.triangles.len(),
            mesh.records.len(),
            gpu.info.name
        );
        Self { gpu, mesh, view: FrameUniform::new(&view, Vec2::splat(1024.0)) }
    }

    /// Measures frames of one look, and prints the median of each pass.
    fn measure(
        &self,
        criterion: &mut Criterion,
        name: &str,
        samples: u32,
        strokes: Option<StrokeStyle>,
    ) {
        let look = Look { background: [1.0; 4], fill_color: [1.0; 4], strokes };
        let device = &self.gpu.device;
        let renderer = Renderer::new(&self.gpu, &look, samples).unwrap();
        let buffers = MeshBuffers::new(device, &self.mesh).unwrap();
        let meshes: [MeshDraw; 1] = [renderer.mesh_draw(device, buffers)];
        let targets = Targets::new(device, [SIZE_PX; 2], samples);
        let timer = GpuTimer::new(&self.gpu, 3);
        let frame = || {
            renderer.render(&self.gpu, &targets, &self.view, &meshes, timer.as_ref());
            device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
        };
        let mut group = criterion.benchmark_group("frame");
        group.sample_size(20).bench_function(name, |bencher| bencher.iter(frame));
        group.finish();
        let Some(timer) = &timer else { return };
        let mut passes = vec![Vec::new(); PASS_NAMES.len()];
        for _ in 0..MEASURED_FRAMES {
            frame();
            for (times, ms) in passes.iter_mut().zip(timer.read_ms(&self.gpu).unwrap()) {
                times.push(ms);
            }
        }
        for (pass, times) in PASS_NAMES.iter().zip(&mut passes) {
            times.sort_by(f64::total_cmp);
            eprintln!("    {pass:<8} {:8.2} ms on the GPU", times[times.len() / 2]);
        }
    }
}

fn frames(criterion: &mut Criterion) {
    let bench = Bench::new();
    let style = |brush| StrokeStyle { color: [0.0, 0.0, 0.0, 1.0], width_px: 2.0, brush };
    for samples in [1, 4] {
        let name = |what: &str| format!("{what}, {samples} samples");
        bench.measure(criterion, &name("fill alone"), samples, None);
        bench.measure(criterion, &name("fill and ink"), samples, Some(style(None)));
        bench.measure(
            criterion,
            &name("fill and pen"),
            samples,
            Some(style(Some(Brush::pen().unwrap()))),
        );
    }
}

criterion_group!(benches, frames);
criterion_main!(benches);
