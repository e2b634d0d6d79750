//! The edges of a view are linked into chains: each edge is in exactly one, and chains of
//! contours are open only where the surface is.

use edgemesh::build::{BuildOptions, build_edge_mesh};
use edgemesh::edge_mesh::{EdgeFlags, EdgeMesh, FaceEdges, StaticLinks};
use edgemesh::format::read::read_model;
use edgemesh::index::NONE;
use edgemesh::line::{ClassTable, LineClass};
use edgemesh::oracle::contour_chain::{Successor, successor};
use edgemesh::oracle::layer_chain::{Element, LayerChain, LayerLinks};
use edgemesh::report::Report;
use edgemesh::view::{Camera, LineBits, classify_lines};
use glam::DVec3;
use testkit::locate::{left_out, shared};

use crate::own_models::own_models;

/// Views of each model; more than a thousand in all.
pub(crate) const VIEWS: u32 = 125;

/// Directions spread evenly around the mesh, all different, some from close by.
pub(crate) fn eye(mesh: &EdgeMesh, view: u32) -> DVec3 {
    let part = (f64::from(view) + 0.5) / f64::from(VIEWS);
    let height = 1.0 - 2.0 * part;
    // The golden angle.
    let around = f64::from(view) * std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let flat = (1.0 - height * height).sqrt();
    let direction = DVec3::new(flat * around.cos(), height, flat * around.sin());
    let radii = 0.4 + 4.0 * (f64::from(view % 7) / 6.0);
    mesh.bounds.center() + direction * mesh.bounds.radius() * radii
}

/// Checks every view of a model; returns the number of contours.
fn check(name: &str, mesh: &EdgeMesh) -> u32 {
    let (faces, links) = (FaceEdges::of(mesh), StaticLinks::of(mesh));
    // First with contours in their own layer, then with all classes in one.
    let apart = ClassTable::new(|class| Some(u32::from(class != LineClass::Contour)));
    let mut linked = 0;
    for view in 0..VIEWS {
        let camera = Camera { eye: eye(mesh, view), ..Camera::default_view(&mesh.bounds) };
        let eye = camera.view(&mesh.bounds, 1.0).eye;
        for (table, layers) in [(apart, 2), (ClassTable::all_in_one(), 1)] {
            let table = ClassTable { keeps_hidden: 1, ..table };
            let lines = classify_lines(mesh, eye, &table, true);
            let (faces, links, lines) = (&faces, &links, &lines);
            let linking = LayerLinks { mesh, faces, links, lines, draws_contours: true };
            let mut count = vec![0_u32; mesh.records.len()];
            for layer in 0..layers {
                for chain in linking.chains(layer) {
                    chain.elements.iter().for_each(|element| count[element.edge as usize] += 1);
                    check_chain(&linking, &chain);
                }
            }
            for (edge, line) in lines.iter().enumerate() {
                let wanted = u32::from(line.bits.contains(LineBits::DRAWN));
                assert_eq!(count[edge], wanted, "{name}, view {view}, edge {edge}");
                linked += u32::from(line.bits.contains(LineBits::CONTOUR));
            }
        }
    }
    linked
}

pub(crate) fn check_chain(linking: &LayerLinks, chain: &LayerChain) {
    let LayerLinks { mesh, faces, lines, .. } = *linking;
    let is_contour =
        |element: &Element| lines[element.edge as usize].bits.contains(LineBits::CONTOUR);
    let (first, last) = (chain.elements[0], chain.elements[chain.elements.len() - 1]);
    for pair in chain.elements.windows(2) {
        let [end, start] = [pair[0].ends(mesh)[1], pair[1].ends(mesh)[0]];
        assert_eq!(end, start, "an edge does not begin where the one before ends");
        assert_eq!(
            is_contour(&pair[0]),
            is_contour(&pair[1]),
            "a contour is linked to another class"
        );
    }
    if chain.is_closed {
        assert_eq!(last.ends(mesh)[1], first.ends(mesh)[0], "a loop does not close");
        let least = chain.elements.iter().map(|element| element.edge).min();
        assert_eq!(least, Some(first.edge), "a loop does not begin at its smallest edge");
        return;
    }
    if !is_contour(&first) {
        return;
    }
    for vertex in [first.ends(mesh)[0], last.ends(mesh)[1]] {
        let is_open = mesh.records.iter().any(|record| {
            let cuts = EdgeFlags::CLASH | EdgeFlags::NON_MANIFOLD;
            let ends_surface = record.face_b == NONE || record.flags().intersects(cuts);
            ends_surface && [record.v0, record.v1].contains(&vertex)
        });
        assert!(is_open, "a chain ends at vertex {vertex}, where the surface continues");
    }
    let following = successor(mesh, faces, lines, last.edge);
    assert!(!matches!(following, Successor::Edge(_)), "{following:?} follows an open end");
}

#[test]
fn edges_of_the_projects_models_are_linked_one_to_one() {
    for (name, mesh) in own_models() {
        let linked = check(&name, &mesh);
        assert!(linked > VIEWS || name.starts_with("plane"), "{name}: {linked} contours");
    }
}

#[test]
fn edges_of_real_models_are_linked_one_to_one() {
    let Some(folder) = shared() else { return left_out("chains of real models", 7) };
    for name in ["cow", "fandisk", "rocker-arm", "spot", "stanford-bunny", "suzanne", "teapot"] {
        let path = folder.join("models").join(format!("{name}.obj"));
        let (model, mut report) = read_model(&path).unwrap();
        let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut report);
        assert!(check(name, &mesh) > 10 * VIEWS, "{name} has too few contours");
    }
}

/// Broken files have awkward surfaces; those that load are linked as well.
#[test]
fn edges_of_awkward_files_are_linked_one_to_one() {
    let Some(folder) = shared() else { return left_out("chains of awkward files", 1) };
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
