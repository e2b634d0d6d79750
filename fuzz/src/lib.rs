//! Shared parts of the fuzz targets: `cargo +nightly fuzz run obj FOUND SEEDS`.
//!
//! `FOUND` is a folder for inputs that reach new code, `SEEDS` one with files of
//! the format. An input that ends a run becomes a test of its reader.

use edgemesh::build::{BuildOptions, build_edge_mesh};
use edgemesh::edge_mesh::{EdgeMesh, replicate, replicate_16};
use edgemesh::format::read::{Format, ReadErrorKind, read_model_bytes};
use edgemesh::line::LineClass;
use edgemesh::view::{Camera, count_features};

/// Reads a model and, where that succeeds, builds and uses its edge mesh.
///
/// # Panics
/// Panics if the reader panicked, which `read_model_bytes` reports as an error.
pub fn read_and_build(bytes: &[u8], format: Format) {
    match read_model_bytes("fuzz", bytes, format) {
        Ok((model, mut report)) => {
            use_mesh(&build_edge_mesh(&model, &BuildOptions::default(), &mut report));
        }
        Err(error) => assert!(error.kind != ReadErrorKind::Internal, "{error}"),
    }
}

/// Counts the features of an edge mesh and writes its replicated layouts.
pub fn use_mesh(mesh: &EdgeMesh) {
    let eye = Camera::default_view(&mesh.bounds).view(&mesh.bounds, 1.0).eye;
    let counts = count_features(mesh, eye);
    assert!(counts[LineClass::Contour] as usize <= mesh.records.len());
    assert_eq!(replicate(mesh).len(), replicate_16(mesh).len());
}
