//! Chains, fans, welding, frames and threads on random meshes.

use std::collections::{BTreeMap, BTreeSet};

use edgemesh::build::{BuildOptions, Welding};
use edgemesh::edge_mesh::{
    CHAIN_CLASSES, EdgeFlags, EdgeMesh, EdgeRecord, Quantization, chain_class_of, replicate_16,
};
use edgemesh::index::NONE;
use edgemesh::report::{RepairKind, Report};
use glam::{DVec3, Vec3};
use proptest::prelude::*;

use crate::config;
use crate::meshes::{Mesh, Noise, assert_near, one_sided_mesh, oriented_mesh, soup};

fn any_mesh() -> impl Strategy<Value = Mesh> {
    prop_oneof![oriented_mesh(), one_sided_mesh(), soup(3..=5)]
}

fn point(mesh: &EdgeMesh, vertex: u32) -> DVec3 {
    Vec3::from(mesh.positions[vertex as usize]).as_dvec3()
}

/// Start and end of a link as its chain runs.
fn link_ends(mesh: &EdgeMesh, link: &edgemesh::edge_mesh::ChainLink) -> (u32, u32) {
    let EdgeRecord { v0, v1, .. } = mesh.records[link.record as usize];
    if link.is_reversed == 0 { (v0, v1) } else { (v1, v0) }
}

/// The faces at each vertex, joined across the records that pair them.
fn fans(mesh: &EdgeMesh) -> BTreeMap<u32, usize> {
    let mut sets: BTreeMap<(u32, u32), (u32, u32)> = BTreeMap::new();
    for (face, triangle) in (0..).zip(&mesh.triangles) {
        for &vertex in triangle {
            sets.insert((vertex, face), (vertex, face));
        }
    }
    let root = |sets: &BTreeMap<(u32, u32), (u32, u32)>, mut key: (u32, u32)| {
        while sets[&key] != key {
            key = sets[&key];
        }
        key
    };
    for record in mesh.records.iter().filter(|record| record.face_b != NONE) {
        if record.flags().contains(EdgeFlags::CLASH) {
            continue;
        }
        for vertex in [record.v0, record.v1] {
            let a = root(&sets, (vertex, record.face_a));
            let b = root(&sets, (vertex, record.face_b));
            sets.insert(a.max(b), a.min(b));
        }
    }
    let mut counts = BTreeMap::new();
    for (key, parent) in &sets {
        *counts.entry(key.0).or_default() += usize::from(key == parent);
    }
    counts
}

proptest! {
    #![proptest_config(config(2048))]

    #[test]
    fn every_feature_is_in_one_chain_and_chains_are_polylines(
        mesh in any_mesh(),
        turn_deg in prop_oneof![Just(60.0), Just(0.0), Just(180.0), 1.0..179.0_f64],
    ) {
        let turn_rad = f64::to_radians(turn_deg);
        let options = BuildOptions { chain_turn_rad: turn_rad, ..BuildOptions::default() };
        let (built, _) = mesh.build_with(&options);
        let mut seen = BTreeSet::new();
        for (number, chain) in (0..).zip(&built.chains.chains) {
            let links = &built.chains.links[chain.link_range()];
            prop_assert!(!links.is_empty());
            let mut arc = 0.0;
            for link in links {
                prop_assert!(seen.insert(link.record), "twice: {:?}", link);
                prop_assert_eq!(link.chain, number);
                let flags = built.records[link.record as usize].flags();
                let class = chain_class_of(flags).map(|class| CHAIN_CLASSES[class]);
                prop_assert_eq!(class, Some(chain.class));
                prop_assert!((f64::from(link.arc_start) - arc).abs() <= 1e-5 * (1.0 + arc));
                let (start, end) = link_ends(&built, link);
                arc += (point(&built, end) - point(&built, start)).length();
            }
            prop_assert!((f64::from(chain.length) - arc).abs() <= 1e-5 * (1.0 + arc));
            let mut pairs: Vec<_> = links.windows(2).map(|pair| [pair[0], pair[1]]).collect();
            if chain.is_loop == 1 {
                pairs.push([links[links.len() - 1], links[0]]);
            }
            for [before, behind] in pairs {
                let ((a, b), (c, d)) = (link_ends(&built, &before), link_ends(&built, &behind));
                prop_assert_eq!(b, c, "a polyline");
                let [into, out] = [(a, b), (c, d)].map(|(from, to)| {
                    (point(&built, to) - point(&built, from)).normalize_or_zero()
                });
                prop_assert!(into.dot(out) >= turn_rad.cos() - 1e-9, "turns too far");
            }
        }
        let features = (0..).zip(&built.records).filter(|(_, record)| {
            record.flags().intersects(EdgeFlags::ALWAYS_DRAWN)
        });
        prop_assert_eq!(seen, features.map(|(record, _)| record).collect::<BTreeSet<u32>>());
    }

    #[test]
    fn every_vertex_has_one_fan_when_all_are_split(mesh in any_mesh()) {
        let (built, report) = mesh.build_with(&BuildOptions::default());
        let clashing: BTreeSet<u32> = built
            .records
            .iter()
            .filter(|record| record.flags().contains(EdgeFlags::CLASH))
            .flat_map(|record| [record.v0, record.v1])
            .map(|vertex| built.welded_vertex(vertex))
            .collect();
        for (vertex, count) in fans(&built) {
            let is_clashing = clashing.contains(&built.welded_vertex(vertex));
            prop_assert!(count == 1 || is_clashing, "vertex {} has {} fans", vertex, count);
        }
        prop_assert_eq!(report.repair_count(RepairKind::SplitVertices), built.split_from.len());
        for (vertex, &from) in (0..).zip(&built.split_from) {
            let first_split = built.positions.len() - built.split_from.len();
            prop_assert_eq!(built.positions[first_split + vertex], built.positions[from as usize]);
        }
    }

    #[test]
    fn a_tolerance_brings_shaken_vertices_together(
        mesh in oriented_mesh().prop_map(|mesh| mesh.triangulated()),
        seed in any::<u64>(),
    ) {
        // Every corner gets a vertex of its own, a little off.
        let mut noise = Noise(seed);
        let mut model = edgemesh::model::Model::default();
        for face in &mesh.polygons {
            let corners: Vec<_> = face
                .iter()
                .map(|&vertex| {
                    let at = mesh.positions[vertex as usize].map(|x| f64::from(x) + 1e-7 * noise.next());
                    model.positions.push(at);
                    edgemesh::model::Corner::at(u32::try_from(model.positions.len() - 1).unwrap())
                })
                .collect();
            model.push_polygon(&corners, 0);
        }
        let build = |welding| {
            let options = BuildOptions { welding, ..BuildOptions::default() };
            edgemesh::build::build_edge_mesh(&model, &options, &mut Report::default())
        };
        // Vertices of the mesh itself are at least 1e-4 apart.
        let (welded, own) = (build(Welding::Within(1e-6)), mesh.build());
        prop_assert_eq!(welded.counts.welded_vertices, own.counts.welded_vertices);
        prop_assert_eq!(welded.counts.edges, own.counts.edges);
        prop_assert_eq!(build(Welding::Off).counts.edges.boundary, 3 * mesh.polygons.len());
    }

    #[test]
    fn a_place_far_away_changes_no_class(
        // In a soup faces lie on each other, and their order around an edge is
        // that of rounding errors.
        mesh in prop_oneof![oriented_mesh(), one_sided_mesh()],
        exponent in 20..40,
    ) {
        // Steps of the mesh are multiples of 2^-12, so that 64 bits move it exactly.
        let near = mesh.build();
        let mut model = mesh.model();
        for position in &mut model.positions {
            position[0] += f64::from(exponent).exp2();
        }
        let mut report = Report::default();
        let far = edgemesh::build::build_edge_mesh(&model, &BuildOptions::default(), &mut report);
        if report.repair_count(RepairKind::EarClippedPolygons) > 0 {
            return Ok(()); // Of equally good diagonals another may be chosen.
        }
        if report.repair_count(RepairKind::Recentered) == 1 {
            assert_near(&far.records, &near.records);
            prop_assert_eq!(far.counts, near.counts);
            prop_assert_eq!(far.triangles, near.triangles);
        } else {
            prop_assert_eq!(far.bounds.radius().to_bits(), 0, "only a point stays");
        }
    }

    #[test]
    fn sixteen_bits_move_vertices_by_half_a_step(mesh in oriented_mesh(), shift in -100.0..100.0_f32) {
        let built = mesh.moved(shift).build();
        let quantization = Quantization::of(&built.bounds);
        for (record, four) in built.records.iter().zip(replicate_16(&built).as_chunks::<4>().0) {
            for (vertex, steps) in [(record.v0, four[0].v0), (record.v1, four[3].v1)] {
                let exact = built.positions[vertex as usize];
                for (exact, back) in exact.into_iter().zip(quantization.dequantize(steps)) {
                    let error = f64::from((exact - back).abs());
                    prop_assert!(error <= quantization.largest_error(), "{} {}", exact, back);
                }
            }
        }
    }

    #[test]
    fn the_number_of_threads_changes_no_byte(mesh in any_mesh()) {
        let with_threads = |count| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap();
            pool.install(|| {
                let (mesh, report) = mesh.build_with(&BuildOptions::default());
                edgemesh::format::edge_mesh_file::to_bytes(&mesh, "mesh", &report, &[]).unwrap()
            })
        };
        let one = with_threads(1);
        prop_assert_eq!(&with_threads(2), &one);
        prop_assert_eq!(&with_threads(5), &one);
    }
}

/// Large enough that the table of edges is cut into a part for each thread.
#[test]
fn the_number_of_threads_changes_no_byte_of_a_large_mesh() {
    let mut mesh = crate::meshes::torus(200, 200).triangulated();
    // A few wrong faces and a bow tie, so that every stage has something to do.
    mesh = mesh.turned(|face| face % 5000 == 7);
    mesh.polygons.push(mesh.polygons[4].clone());
    let with_threads = |count| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap();
        pool.install(|| {
            let (mesh, report) = mesh.build_with(&BuildOptions::default());
            assert_eq!(mesh.records.len(), 120_000);
            edgemesh::format::edge_mesh_file::to_bytes(&mesh, "mesh", &report, &[]).unwrap()
        })
    };
    let one = with_threads(1);
    for count in [2, 3, 8] {
        assert!(with_threads(count) == one, "{count} threads");
    }
}
