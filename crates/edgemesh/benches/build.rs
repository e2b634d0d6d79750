//! Benches of the preprocessor: `cargo bench -p edgemesh`.
//!
//! - `read`: an OBJ file on disk to a model, in bytes per second.
//! - `topology`: triangles to a table of edges.
//! - `build`: a model to its complete edge mesh, without the fill.
//! - `whole`: an OBJ file on disk to its complete edge mesh.
//! - `fill`: as `build`, with the fill that shading needs.
//! - `features`: the feature edges of a view on the CPU.
//! - `write` and `load`: an edge mesh to the bytes of its file and back.
//!
//! The group is the stage, the parameter the number of triangles. The meshes are generated bumpy
//! spheres; `EDGEMESH_BENCH_MODELS` lists further OBJ files, separated by colons, such as those of
//! `cargo xtask mesh`.

#![expect(clippy::unwrap_used, reason = "a bench fails by panicking")]

use std::fmt::Write as _;
use std::fs;
use std::hint::black_box;
use std::path::{Path, PathBuf};

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use edgemesh::build::{BuildOptions, build_edge_mesh};
use edgemesh::edge_mesh::EdgeTable;
use edgemesh::format::edge_mesh_file;
use edgemesh::format::read::read_model;
use edgemesh::report::Report;
use edgemesh::view::{Camera, count_features};

/// Rings of spheres of about 1e3, 1e4, 1e5 and 1e6 triangles.
const SIZES: [u32; 4] = [16, 50, 158, 500];

/// The text of a sphere of `rings` rings and twice as many segments, with bumps.
fn bumpy_sphere(rings: u32) -> String {
    let segments = 2 * rings;
    let mut text = String::new();
    for ring in 0..=rings {
        for segment in 0..segments {
            let [phi, theta] = [(ring, rings), (2 * segment, segments)]
                .map(|(step, steps)| std::f64::consts::PI * f64::from(step) / f64::from(steps));
            let radius = 1.0 + 0.1 * (7.0 * phi).sin() * (5.0 * theta).cos();
            let point = [phi.sin() * theta.cos(), phi.cos(), phi.sin() * theta.sin()];
            let [x, y, z] = point.map(|coordinate| radius * coordinate);
            writeln!(text, "v {x:.8} {y:.8} {z:.8}").unwrap();
        }
    }
    for ring in 0..rings {
        for segment in 0..segments {
            let next = (segment + 1) % segments;
            let [a, b] = [ring * segments + segment + 1, ring * segments + next + 1];
            let [c, d] = [a + segments, b + segments];
            writeln!(text, "f {a} {b} {c}\nf {b} {d} {c}").unwrap();
        }
    }
    text
}

fn paths(folder: &Path) -> Vec<PathBuf> {
    if let Some(models) = std::env::var_os("EDGEMESH_BENCH_MODELS") {
        return std::env::split_paths(&models).collect();
    }
    let sphere = |rings| {
        let path = folder.join(format!("sphere-{rings}.obj"));
        fs::write(&path, bumpy_sphere(rings)).unwrap();
        path
    };
    SIZES.map(sphere).to_vec()
}

fn stages(criterion: &mut Criterion) {
    let folder = tempfile::tempdir().unwrap();
    for path in paths(folder.path()) {
        let (model, _) = read_model(&path).unwrap();
        let count = model.polygon_count();
        let bare = BuildOptions { with_fill: false, ..BuildOptions::default() };
        let build =
            |options: &BuildOptions| build_edge_mesh(&model, options, &mut Report::default());
        let mesh = build(&bare);
        let eye = Camera::default_view(&mesh.bounds).view(&mesh.bounds, 1.0).eye;
        let bytes = edge_mesh_file::to_bytes(&mesh, "bench", &Report::default(), &[]).unwrap();
        let mut stage = |name: &str, throughput: Throughput, body: &mut dyn FnMut()| {
            let mut group = criterion.benchmark_group(name);
            group.sample_size(10).throughput(throughput);
            group.bench_function(BenchmarkId::from_parameter(count), |bencher| {
                bencher.iter(&mut *body);
            });
        };
        let triangles = || Throughput::Elements(count as u64);
        let file_bytes = Throughput::Bytes(fs::metadata(&path).unwrap().len());
        stage("read", file_bytes, &mut || {
            black_box(read_model(&path).unwrap());
        });
        stage("topology", triangles(), &mut || {
            black_box(EdgeTable::from_triangles(mesh.positions.len(), &mesh.triangles));
        });
        stage("build", triangles(), &mut || {
            black_box(build(&bare));
        });
        stage("whole", triangles(), &mut || {
            let (model, mut report) = read_model(&path).unwrap();
            black_box(build_edge_mesh(&model, &bare, &mut report));
        });
        stage("fill", triangles(), &mut || {
            black_box(build(&BuildOptions::default()));
        });
        stage("features", triangles(), &mut || {
            black_box(count_features(&mesh, eye));
        });
        stage("write", triangles(), &mut || {
            black_box(edge_mesh_file::to_bytes(&mesh, "bench", &Report::default(), &[]).unwrap());
        });
        stage("load", triangles(), &mut || {
            black_box(edge_mesh_file::parse(&bytes).unwrap().to_mesh());
        });
    }
}

criterion_group!(benches, stages);
criterion_main!(benches);
