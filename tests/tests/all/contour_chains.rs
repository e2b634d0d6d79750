//! Contours are linked into chains: each in exactly one, none lost, none twice, and
//! open only where the surface is.

use edgemesh::build::{BuildOptions, build_edge_mesh};
use edgemesh::camera::Camera;
use edgemesh::edge_mesh::EdgeMesh;
use edgemesh::edge_word::edge_words;
use edgemesh::face_edges::FaceEdges;
use edgemesh::index::NONE;
use edgemesh::oracle::classify_lines;
use edgemesh::oracle::contour_chain::{
    ContourChain, Successor, contour_chains, contour_ends, successor,
};
use edgemesh::oracle::feature::{ClassTable, Line, LineBits};
use edgemesh::read::read_model;
use edgemesh::record::EdgeFlags;
use edgemesh::report::Report;
use glam::DVec3;
use testkit::locate::{left_out, shared};

use crate::own_models::own_models;

/// Views of each model; of all together more than a thousand.
const VIEWS: u32 = 125;

/// Evenly around the mesh, no two views from one side, some from close by.
fn eye(mesh: &EdgeMesh, view: u32) -> DVec3 {
    let part = (f64::from(view) + 0.5) / f64::from(VIEWS);
    let height = 1.0 - 2.0 * part;
    // The golden angle.
    let around = f64::from(view) * std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let flat = (1.0 - height * height).sqrt();
    let direction = DVec3::new(flat * around.cos(), height, flat * around.sin());
    let radii = 0.4 + 4.0 * (f64::from(view % 7) / 6.0);
    mesh.bounds.center() + direction * mesh.bounds.radius() * radii
}

/// Checks every view of a model, and says how many contours they had.
fn check(name: &str, mesh: &EdgeMesh) -> u32 {
    let faces = FaceEdges::of(mesh);
    let words = edge_words(mesh);
    let table = ClassTable { keeps_hidden: 1, ..ClassTable::all_in_one() };
    let mut linked = 0;
    for view in 0..VIEWS {
        let camera = Camera { eye: eye(mesh, view), ..Camera::default_view(&mesh.bounds) };
        let eye = camera.view(&mesh.bounds, 1.0).eye;
        let lines = classify_lines(mesh, &words, eye, &table, true);
        let chains = contour_chains(mesh, &faces, &lines);
        let mut count = vec![0_u32; mesh.records.len()];
        for chain in &chains {
            chain.edges.iter().for_each(|&edge| count[edge as usize] += 1);
            check_chain(mesh, &faces, &lines, chain);
        }
        for (edge, line) in lines.iter().enumerate() {
            let wanted = u32::from(line.bits.contains(LineBits::CONTOUR));
            assert_eq!(count[edge], wanted, "{name}, view {view}, edge {edge}");
            linked += wanted;
        }
    }
    linked
}

fn check_chain(mesh: &EdgeMesh, faces: &FaceEdges, lines: &[Line], chain: &ContourChain) {
    let ends = |edge: u32| contour_ends(mesh, edge, lines[edge as usize].bits);
    for pair in chain.edges.windows(2) {
        assert_eq!(ends(pair[0])[1], ends(pair[1])[0], "each begins where the last one ended");
    }
    let (first, last) = (chain.edges[0], chain.edges[chain.edges.len() - 1]);
    if chain.is_closed {
        assert_eq!(ends(last)[1], ends(first)[0], "a loop closes");
        assert_eq!(chain.edges.iter().min(), Some(&first), "a loop begins at its smallest edge");
        return;
    }
    let open_vertices = [ends(first)[0], ends(last)[1]];
    for vertex in open_vertices {
        let ends_surface = |flags: EdgeFlags, face_b: u32| {
            face_b == NONE || flags.intersects(EdgeFlags::CLASH | EdgeFlags::NON_MANIFOLD)
        };
        let is_open = mesh.records.iter().any(|record| {
            [record.v0, record.v1].contains(&vertex) && ends_surface(record.flags, record.face_b)
        });
        assert!(is_open, "a chain ends at vertex {vertex}, where the surface goes on");
    }
    let following = successor(mesh, faces, lines, last);
    assert!(!matches!(following, Successor::Edge(_)), "{following:?} follows an open end");
}

#[test]
fn contours_of_the_projects_models_are_linked_one_to_one() {
    for (name, mesh) in own_models() {
        let linked = check(&name, &mesh);
        assert!(linked > VIEWS || name.starts_with("plane"), "{name}: {linked} contours");
    }
}

#[test]
fn contours_of_real_models_are_linked_one_to_one() {
    let Some(folder) = shared() else { return left_out("chains of contours", 8) };
    for name in ["cow", "fandisk", "rocker-arm", "spot", "stanford-bunny", "suzanne", "teapot"] {
        let path = folder.join("models").join(format!("{name}.obj"));
        let (model, mut report) = read_model(&path).unwrap();
        let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut report);
        assert!(check(name, &mesh) > 10 * VIEWS, "{name} has contours");
    }
}

/// Broken files make awkward surfaces; those that can be read are linked as well.
#[test]
fn contours_of_awkward_files_are_linked_one_to_one() {
    let Some(folder) = shared() else { return left_out("chains of awkward contours", 1) };
    let mut checked = 0;
    let mut folders = vec![folder.join("corpus")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|end| end == "obj" || end == "ply") {
                let Ok((model, _)) = read_model(&path) else { continue };
                let mesh =
                    build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default());
                if mesh.triangles.len() > 2 && mesh.triangles.len() < 3000 {
                    check(&path.display().to_string(), &mesh);
                    checked += 1;
                }
            }
        }
    }
    assert!(checked > 10, "{checked} files");
}
