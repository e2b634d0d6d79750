//! Edges, counted again with plain maps, and independence of order.

use std::collections::{BTreeMap, BTreeSet};

use edgemesh::build::BuildOptions;
use edgemesh::edge_mesh::{EdgeCounts, EdgeFlags, EdgeMesh, EdgeRecord, replicate};
use edgemesh::index::NONE;
use edgemesh::report::{RepairKind, WarningCode};
use edgemesh::view::{LineBits, classify_edges};
use proptest::prelude::*;

use crate::config;
use crate::meshes::{
    Mesh, Noise, closed_mesh, key, one_sided_mesh, oriented_mesh, sheet, soup, sphere, torus,
    wild_soup,
};

/// A place in space; equal places are one vertex.
type Place = [u32; 3];

/// The faces of each undirected edge, and whether they run up, from the smaller
/// place to the larger.
type Users = BTreeMap<(Place, Place), Vec<(usize, bool)>>;

fn place(position: [f32; 3]) -> Place {
    position.map(key)
}

/// A mesh of triangles, computed in the plainest way.
struct Naive {
    /// Triangles with three different places.
    proper: Vec<[Place; 3]>,
    /// `proper` without triangles that repeat another.
    unique: Vec<[Place; 3]>,
    degenerate: usize,
    places: usize,
}

impl Naive {
    fn of(mesh: &Mesh) -> Self {
        let all: Vec<[Place; 3]> = mesh
            .polygons
            .iter()
            .map(|corners| [0, 1, 2].map(|k| place(mesh.positions[corners[k] as usize])))
            .collect();
        let is_proper = |[a, b, c]: &[Place; 3]| a != b && b != c && c != a;
        let proper: Vec<_> = all.iter().copied().filter(is_proper).collect();
        let mut seen = BTreeSet::new();
        let unique = proper.iter().copied().filter(|&face| seen.insert(cyclic(face))).collect();
        Self {
            degenerate: all.len() - proper.len(),
            places: all.as_flattened().iter().collect::<BTreeSet<_>>().len(),
            proper,
            unique,
        }
    }
}

/// The triangle with its smallest corner first.
fn cyclic([a, b, c]: [Place; 3]) -> [Place; 3] {
    [[a, b, c], [b, c, a], [c, a, b]].into_iter().min().unwrap()
}

fn users<'a, P: AsRef<[Place]> + 'a>(faces: impl IntoIterator<Item = &'a P>) -> Users {
    let mut users = Users::new();
    for (index, face) in faces.into_iter().enumerate() {
        let corners = face.as_ref();
        for (k, &from) in corners.iter().enumerate() {
            let to = corners[(k + 1) % corners.len()];
            if from != to {
                users.entry((from.min(to), from.max(to))).or_default().push((index, from < to));
            }
        }
    }
    users
}

fn count(users: &Users) -> EdgeCounts {
    let mut counts = EdgeCounts { edges: users.len(), ..EdgeCounts::default() };
    for faces in users.values() {
        counts.boundary += usize::from(faces.len() == 1);
        counts.non_manifold += usize::from(faces.len() > 2);
        counts.inconsistent += usize::from(faces.len() == 2 && faces[0].1 == faces[1].1);
    }
    counts
}

/// Sets of faces connected by edges that `joins` accepts.
fn components(
    face_count: usize,
    users: &Users,
    joins: impl Fn(&[(usize, bool)]) -> bool,
) -> Vec<BTreeSet<usize>> {
    let mut sets: Vec<BTreeSet<usize>> = (0..face_count).map(|face| [face].into()).collect();
    for faces in users.values().filter(|faces| joins(faces)) {
        let touches = |set: &BTreeSet<usize>| faces.iter().any(|(face, _)| set.contains(face));
        let (joined, rest): (Vec<_>, Vec<_>) = sets.into_iter().partition(touches);
        sets = rest;
        sets.push(joined.into_iter().flatten().collect());
    }
    sets
}

fn ends(mesh: &EdgeMesh, record: &EdgeRecord) -> (Place, Place) {
    let [a, b] = [record.v0, record.v1].map(|vertex| place(mesh.positions[vertex as usize]));
    (a.min(b), a.max(b))
}

fn runs(mesh: &EdgeMesh, face: u32, from: u32, to: u32) -> bool {
    let [a, b, c] = mesh.triangles[face as usize];
    [(a, b), (b, c), (c, a)].contains(&(from, to))
}

proptest! {
    #![proptest_config(config(4096))]

    #[test]
    fn counts_of_a_soup_are_those_of_a_plain_map(mesh in soup(3..=3)) {
        let (built, report) = mesh.build_with(&BuildOptions::default());
        if report.repair_count(RepairKind::ClosedJunctions) > 0 {
            return Ok(()); // Triangles were cut at vertices on their sides.
        }
        let naive = Naive::of(&mesh);
        let edges = users(&naive.proper);
        prop_assert_eq!(built.counts.edges, count(&edges));
        prop_assert_eq!(built.counts.triangles, naive.proper.len());
        prop_assert_eq!(built.counts.degenerate_triangles, naive.degenerate);
        prop_assert_eq!(built.counts.duplicate_triangles, naive.proper.len() - naive.unique.len());
        prop_assert_eq!(built.counts.welded_vertices, naive.places);
        let sets = components(naive.proper.len(), &edges, |_| true);
        prop_assert_eq!(built.counts.components, sets.len());
        prop_assert_eq!(built.counts.diagonal_edges, 0);
    }

    #[test]
    fn source_counts_are_those_of_the_polygons(mesh in soup(3..=6)) {
        // The vertices as the file numbers them stand for places.
        let faces: Vec<Vec<Place>> =
            mesh.polygons.iter().map(|face| face.iter().map(|&v| [v, 0, 0]).collect()).collect();
        let source = mesh.build().counts.source;
        prop_assert_eq!(source.edges, count(&users(&faces)));
        prop_assert_eq!(source.polygons, faces.len());
        prop_assert_eq!(source.triangles, faces.iter().map(|face| face.len() - 2).sum::<usize>());
        prop_assert_eq!(source.vertices, mesh.positions.len());
    }

    #[test]
    fn every_edge_of_a_soup_is_in_the_records_with_each_of_its_faces_once(mesh in soup(3..=3)) {
        let (built, report) = mesh.build_with(&BuildOptions::default());
        if report.repair_count(RepairKind::ClosedJunctions) > 0 {
            return Ok(()); // Triangles were cut at vertices on their sides.
        }
        let naive = Naive::of(&mesh);
        let backs = report.repair_count(RepairKind::TwoSidedFaces);
        prop_assert_eq!(built.triangles.len() + backs, naive.unique.len());
        let place_of = |vertex: u32| place(built.positions[vertex as usize]);
        let faces: Vec<[Place; 3]> =
            built.triangles.iter().map(|triangle| triangle.map(place_of)).collect();
        let edges = users(&faces);
        let mut found: BTreeMap<(Place, Place), Vec<usize>> = BTreeMap::new();
        for record in &built.records {
            let EdgeRecord { v0, v1, face_a, face_b, word } = *record;
            let faces = &edges[&ends(&built, record)];
            let flags = word.flags();
            prop_assert_eq!(flags.contains(EdgeFlags::BOUNDARY), faces.len() == 1);
            let is_drawn = flags.intersects(EdgeFlags::ALWAYS_DRAWN);
            let is_feature = faces.len() > 2 && (is_drawn || face_b == NONE);
            prop_assert_eq!(flags.contains(EdgeFlags::NON_MANIFOLD), is_feature);
            prop_assert!(runs(&built, face_a, v0, v1), "face A left of the edge: {:?}", record);
            let list = found.entry(ends(&built, record)).or_default();
            list.push(face_a as usize);
            if face_b == NONE {
                prop_assert!(faces.len() != 2, "a face is lost: {:?}", record);
            } else {
                let (from, to) = if word.flags().contains(EdgeFlags::CLASH) { (v0, v1) } else { (v1, v0) };
                prop_assert!(runs(&built, face_b, from, to), "face B right of it: {:?}", record);
                prop_assert!(
                    built.welded_vertex(v0) < built.welded_vertex(v1)
                        || word.flags().intersects(EdgeFlags::CLASH | EdgeFlags::NON_MANIFOLD),
                    "A runs from the smaller vertex to the larger: {:?}",
                    record
                );
                list.push(face_b as usize);
            }
        }
        for list in found.values_mut() {
            list.sort_unstable();
        }
        let expected: BTreeMap<_, Vec<usize>> = edges
            .iter()
            .map(|(&ends, faces)| (ends, faces.iter().map(|(face, _)| *face).collect()))
            .collect();
        prop_assert_eq!(found, expected);
        let vertices = |record: &EdgeRecord| {
            let [a, b] = [record.v0, record.v1].map(|vertex| built.welded_vertex(vertex));
            (a.min(b), a.max(b))
        };
        prop_assert!(built.records.is_sorted_by_key(vertices), "sorted by (min, max) vertex");
        let clashes =
            built.records.iter().filter(|r| r.flags().contains(EdgeFlags::CLASH)).count();
        prop_assert_eq!(report.count(WarningCode::Orientation), clashes);
    }

    #[test]
    fn a_repair_flips_the_minority_and_keeps_every_face(mesh in soup(3..=3)) {
        let (built, report) = mesh.build_with(&BuildOptions::default());
        let others =
            [RepairKind::InsideOutFaces, RepairKind::TwoSidedFaces, RepairKind::ClosedJunctions];
        if others.into_iter().any(|kind| report.repair_count(kind) > 0) {
            return Ok(()); // Faces were dropped, or flipped for another reason.
        }
        let naive = Naive::of(&mesh);
        let mut flipped = BTreeSet::new();
        for (face, (&now, &before)) in built.triangles.iter().zip(&naive.unique).enumerate() {
            let now = now.map(|vertex| place(built.positions[vertex as usize]));
            if cyclic(now) != cyclic(before) {
                let [a, b, c] = before;
                prop_assert_eq!(cyclic(now), cyclic([a, c, b]), "face {}", face);
                flipped.insert(face);
            }
        }
        prop_assert_eq!(report.repair_count(RepairKind::FlippedFaces), flipped.len());
        for set in components(naive.unique.len(), &users(&naive.unique), |faces| faces.len() == 2) {
            prop_assert!(2 * flipped.intersection(&set).count() <= set.len(), "the minority");
        }
    }

    #[test]
    fn nothing_panics_and_all_is_finite(mesh in wild_soup(), eye in any::<[f32; 4]>()) {
        let (built, _) = mesh.build_with(&BuildOptions::default());
        let finite = |values: &[f32]| values.iter().all(|value| value.is_finite());
        prop_assert!(finite(built.vertex_normals.as_flattened()), "{:?}", built.vertex_normals);
        for plane in &built.face_planes {
            prop_assert!(finite(&plane.normal) && finite(&plane.point), "{:?}", plane);
        }
        for vertex in &built.fill.vertices {
            prop_assert!(finite(&vertex.normal), "{:?}", vertex);
        }
        prop_assert_eq!(built.fill.indices.len(), 3 * built.triangles.len());
        for vertex in replicate(&built) {
            prop_assert!(finite(bytemuck::cast_slice::<[f32; 3], f32>(&[
                vertex.v0, vertex.v1, vertex.v2, vertex.v3, vertex.n0, vertex.n1,
            ])), "{:?}", vertex);
            prop_assert!((0.0..1.0).contains(&vertex.r), "{:?}", vertex);
        }
        let bits = classify_edges(&built, eye.into());
        prop_assert_eq!(bits.len(), built.records.len());
    }

    #[test]
    fn order_of_faces_and_vertices_changes_no_count_of_a_soup(
        mesh in soup(3..=5),
        seed in any::<u64>(),
    ) {
        let (before, after) = (mesh.build(), reordered(&mesh, seed).build());
        // Of two copies of a polygon, the one that is kept decides which triangles repeat it.
        let counts = |mesh: &EdgeMesh| {
            let mut counts = mesh.counts;
            counts.duplicate_triangles = 0;
            counts
        };
        prop_assert_eq!(counts(&before), counts(&after));
        // Which faces are paired may depend on the order where they coincide, and which of two
        // is kept.
        let edges = |mesh: &EdgeMesh| -> BTreeSet<_> {
            mesh.records.iter().map(|record| ends(mesh, record)).collect()
        };
        let is_whole = |mesh: &EdgeMesh| mesh.triangles.len() == mesh.counts.triangles;
        if is_whole(&before) && is_whole(&after) {
            prop_assert_eq!(edges(&before), edges(&after));
        }
    }
}

/// The same mesh, faces and vertices in another order.
fn reordered(mesh: &Mesh, seed: u64) -> Mesh {
    let mut noise = Noise(seed);
    let vertices = noise.permutation(mesh.positions.len());
    let mut renamed = vec![0; vertices.len()];
    for (new, &old) in vertices.iter().enumerate() {
        renamed[old] = u32::try_from(new).unwrap();
    }
    let rename = |face: &usize| {
        mesh.polygons[*face].iter().map(|&vertex| renamed[vertex as usize]).collect()
    };
    Mesh {
        positions: vertices.iter().map(|&old| mesh.positions[old]).collect(),
        polygons: noise.permutation(mesh.polygons.len()).iter().map(rename).collect(),
    }
}

/// The flags of each edge and whether it is a contour, by its ends.
fn classes(mesh: &EdgeMesh, eye: [f32; 4]) -> BTreeMap<(Place, Place), (EdgeFlags, bool)> {
    let bits = classify_edges(mesh, eye.into());
    let is_contour = |bits: LineBits| bits.contains(LineBits::CONTOUR);
    mesh.records
        .iter()
        .zip(bits)
        .map(|(record, bits)| (ends(mesh, record), (record.flags(), is_contour(bits))))
        .collect()
}

proptest! {
    #![proptest_config(config(2048))]

    #[test]
    fn order_of_faces_and_vertices_changes_no_class(
        mesh in oriented_mesh(),
        seed in any::<u64>(),
        eye in prop::array::uniform3(-4.0_f32..4.0),
        is_orthographic in any::<bool>(),
    ) {
        let eye = [eye[0], eye[1], eye[2], f32::from(!is_orthographic)];
        let (before, after) = (mesh.build(), reordered(&mesh, seed).build());
        prop_assert_eq!(before.counts, after.counts);
        prop_assert_eq!(before.records.len(), before.counts.edges.edges);
        prop_assert_eq!(classes(&before, eye), classes(&after, eye));
    }

    #[test]
    fn a_minority_of_wrong_faces_is_mended(mesh in oriented_mesh(), seed in any::<u64>()) {
        // Ears may be cut elsewhere when a polygon runs the other way.
        let is_fan = mesh.build_with(&BuildOptions::default()).1.repair_count(RepairKind::EarClippedPolygons) == 0;
        let mesh = if is_fan { mesh } else { mesh.triangulated() };
        let sound = mesh.build();
        let picks = Noise(seed).permutation(mesh.polygons.len());
        let mut minority = 0;
        let mut is_turned = vec![false; mesh.polygons.len()];
        for face in picks {
            let triangles = mesh.polygons[face].len() - 2;
            if 2 * (minority + triangles) < sound.triangles.len() {
                minority += triangles;
                is_turned[face] = true;
            }
        }
        let broken = mesh.turned(|face| is_turned[face]);
        let (mended, report) = broken.build_with(&BuildOptions::default());
        prop_assert_eq!(report.repair_count(RepairKind::FlippedFaces), minority);
        prop_assert!(minority == 0 || mended.counts.edges.inconsistent > 0, "it was broken");
        // Corners 1 and 2 of a face may be met in another order.
        let flags = |mesh: &EdgeMesh| -> BTreeMap<_, _> {
            mesh.records.iter().map(|record| (ends(mesh, record), record.flags())).collect()
        };
        prop_assert_eq!(flags(&mended), flags(&sound));
        prop_assert!(flags(&sound).values().all(|flags| !flags.contains(EdgeFlags::CLASH)), "two sides");
    }

    #[test]
    fn a_strip_without_a_second_side_is_cut(mesh in one_sided_mesh(), seed in any::<u64>()) {
        let picks = Noise(seed).permutation(mesh.polygons.len());
        let turned = mesh.turned(|face| picks[face].is_multiple_of(2));
        let (built, report) = turned.build_with(&BuildOptions::default());
        prop_assert!(report.count(WarningCode::Orientation) % 2 == 1, "{:?}", report);
        prop_assert_eq!(built.records.len(), 2 * mesh.polygons.len());
    }

    #[test]
    fn closed_meshes_have_neither_boundary_nor_clash(mesh in closed_mesh()) {
        let (built, report) = mesh.build_with(&BuildOptions::default());
        let edges = built.counts.edges;
        prop_assert_eq!((edges.boundary, edges.non_manifold, edges.inconsistent), (0, 0, 0));
        prop_assert_eq!(2 * edges.edges, 3 * built.triangles.len());
        prop_assert_eq!(built.counts.components, 1);
        prop_assert_eq!(report.repair_count(RepairKind::FlippedFaces), 0);
        // A polygon that is far from flat can cross itself in every plane.
        let crossing = report.warnings().iter().all(|w| w.code == WarningCode::Crossing);
        prop_assert!(crossing, "{:?}", report);
    }
}

/// V - E + F, over the file's polygons and over the welded triangles.
fn euler(mesh: &Mesh) -> [isize; 2] {
    let counts = mesh.build().counts;
    [
        (counts.source.vertices, counts.source.edges.edges, counts.source.polygons),
        (counts.welded_vertices, counts.edges.edges, counts.triangles),
    ]
    .map(|(vertices, edges, faces)| (vertices + faces).cast_signed() - edges.cast_signed())
}

#[test]
fn eulers_formula_holds() {
    for (rings, segments) in [(1, 3), (2, 3), (5, 8), (12, 31), (40, 17)] {
        assert_eq!(euler(&sphere(rings, segments)), [2, 2], "sphere {rings} x {segments}");
    }
    for (rings, segments) in [(3, 3), (4, 7), (16, 5), (33, 20)] {
        assert_eq!(euler(&torus(rings, segments)), [0, 0], "torus {rings} x {segments}");
    }
    for (rows, columns) in [(1, 1), (2, 5), (30, 7)] {
        assert_eq!(euler(&sheet(rows, columns)), [1, 1], "sheet {rows} x {columns}");
    }
}

#[test]
fn every_quad_has_one_diagonal() {
    for (mesh, quads) in [(sphere(5, 8), 4 * 8), (torus(4, 7), 4 * 7), (sheet(2, 5), 2 * 5)] {
        let built = mesh.build();
        assert_eq!(built.counts.diagonal_edges, quads);
        let diagonals = built.records.iter().filter(|r| r.flags().contains(EdgeFlags::DIAGONAL));
        assert_eq!(diagonals.count(), quads);
        assert_eq!(built.counts.edges.edges - quads, built.counts.source.edges.edges);
    }
}
