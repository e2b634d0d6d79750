//! What the preprocessor costs: `cargo bench -p edgemesh`.
//!
//! The mesh is a bumpy sphere made here, as text for the reader and as a model
//! for the builder, from a thousand to a million triangles. The group is the
//! stage, the parameter the number of triangles.

#![expect(clippy::unwrap_used, reason = "a bench fails by panicking")]

use std::fmt::Write as _;
use std::fs;
use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use edgemesh::build::{BuildOptions, build_edge_mesh};
use edgemesh::camera::Camera;
use edgemesh::model::Model;
use edgemesh::oracle::count_features;
use edgemesh::read::read_model;
use edgemesh::report::Report;
use edgemesh::topology::EdgeTable;

/// Rings and segments for about 1e3, 1e4, 1e5 and 1e6 triangles.
const SIZES: [u32; 4] = [16, 50, 158, 500];

/// A sphere of `rings` rings and twice as many segments, with bumps.
fn bumpy_sphere(rings: u32) -> Model {
    let segments = 2 * rings;
    let mut positions = Vec::new();
    for ring in 0..=rings {
        for segment in 0..segments {
            let [phi, theta] = [(ring, rings), (2 * segment, segments)]
                .map(|(step, steps)| std::f64::consts::PI * f64::from(step) / f64::from(steps));
            let radius = 1.0 + 0.1 * (7.0 * phi).sin() * (5.0 * theta).cos();
            let point = [phi.sin() * theta.cos(), phi.cos(), phi.sin() * theta.sin()];
            #[expect(clippy::cast_possible_truncation, reason = "a model is in 32 bits")]
            positions.push(point.map(|coordinate| (radius * coordinate) as f32));
        }
    }
    let mut model = Model::from_polygons(&positions, &[]);
    for ring in 0..rings {
        for segment in 0..segments {
            let next = (segment + 1) % segments;
            let [a, b] = [ring * segments + segment, ring * segments + next];
            let [c, d] = [a + segments, b + segments];
            model.push_polygon(&[a, b, c]);
            model.push_polygon(&[b, d, c]);
        }
    }
    model
}

fn obj_text(model: &Model) -> String {
    let mut text = String::new();
    for [x, y, z] in &model.positions {
        writeln!(text, "v {x} {y} {z}").unwrap();
    }
    for corners in model.corners.as_chunks::<3>().0 {
        let [a, b, c] = corners.map(|corner| corner.position + 1);
        writeln!(text, "f {a} {b} {c}").unwrap();
    }
    text
}

fn stages(criterion: &mut Criterion) {
    let folder = tempfile::tempdir().unwrap();
    for rings in SIZES {
        let model = bumpy_sphere(rings);
        let triangle_count = model.polygons.len();
        let options = BuildOptions::default();
        let mesh = build_edge_mesh(&model, &options, &mut Report::default());
        let eye = Camera::default_view(&mesh.bounds).view(&mesh.bounds, 1.0).eye;
        let text = obj_text(&model);
        let path = folder.path().join("sphere.obj");
        fs::write(&path, &text).unwrap();
        let mut stage = |name: &str, throughput: Throughput, body: &mut dyn FnMut()| {
            let mut group = criterion.benchmark_group(name);
            group.sample_size(10).throughput(throughput);
            group.bench_function(BenchmarkId::from_parameter(triangle_count), |bencher| {
                bencher.iter(&mut *body);
            });
        };
        let triangles = Throughput::Elements(triangle_count as u64);
        stage("read", Throughput::Bytes(text.len() as u64), &mut || {
            black_box(read_model(&path).unwrap());
        });
        stage("topology", triangles.clone(), &mut || {
            black_box(EdgeTable::from_triangles(mesh.positions.len(), &mesh.triangles));
        });
        stage("build", triangles.clone(), &mut || {
            black_box(build_edge_mesh(&model, &options, &mut Report::default()));
        });
        stage("features", triangles, &mut || {
            black_box(count_features(&mesh, eye));
        });
    }
}

criterion_group!(benches, stages);
criterion_main!(benches);
