//! The project's own models, built.

use edgemesh::build::{BuildOptions, build_edge_mesh};
use edgemesh::edge_mesh::EdgeMesh;
use edgemesh::format::read::read_model;
use testkit::locate::workspace_root;

/// All of them, sorted by name.
pub(crate) fn own_models() -> Vec<(String, EdgeMesh)> {
    let mut paths: Vec<_> = std::fs::read_dir(workspace_root().join("models"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|end| end == "obj"))
        .collect();
    paths.sort();
    assert!(paths.len() >= 4, "models are missing");
    paths
        .into_iter()
        .map(|path| {
            let (model, mut report) = read_model(&path).unwrap();
            let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut report);
            (path.file_stem().unwrap().to_string_lossy().into_owned(), mesh)
        })
        .collect()
}
