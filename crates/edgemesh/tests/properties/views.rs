//! Contours and creases under flips, scales and other eyes; Equation 1 of the paper against the
//! facing bits.

use std::collections::BTreeMap;

use edgemesh::build::BuildOptions;
use edgemesh::edge_mesh::{Bounds, EdgeFlags, EdgeMesh, EdgeRecord, replicate};
use edgemesh::index::NONE;
use edgemesh::oracle::equation_1::equation_1;
use edgemesh::report::RepairKind;
use edgemesh::view::{Camera, LineBits, classify_edges};
use glam::{DVec3, Vec3, Vec4};
use proptest::prelude::*;

use crate::config;
use crate::meshes::{Mesh, assert_near, closed_mesh, key, one_sided_mesh, oriented_mesh, soup};

const CREASES: EdgeFlags = EdgeFlags::RIDGE.union(EdgeFlags::VALLEY);

/// An eye-point in or around the meshes, or a direction to a distant viewer.
fn eye() -> impl Strategy<Value = Vec4> {
    // Multiples of a power of two, as the positions are.
    let coordinate = (-16_384..16_384_i16).prop_map(|steps| f32::from(steps) / 4096.0);
    ([coordinate.clone(), coordinate.clone(), coordinate], any::<bool>())
        .prop_filter("no direction", |(eye, _)| Vec3::from(*eye).length() > 0.1)
        .prop_map(|(eye, is_point)| Vec3::from(eye).extend(f32::from(is_point)))
}

/// The ends of an edge, in an order that does not depend on its record.
type Ends = [[u32; 3]; 2];

fn ends(mesh: &EdgeMesh, record: &EdgeRecord) -> Ends {
    let mut ends = [record.v0, record.v1].map(|v| mesh.positions[v as usize].map(key));
    ends.sort_unstable();
    ends
}

/// Whether the edge is a contour, by its ends.
fn contours(mesh: &EdgeMesh, eye: Vec4) -> BTreeMap<Ends, bool> {
    let bits = classify_edges(mesh, eye);
    let edges = mesh.records.iter().map(|record| ends(mesh, record));
    edges.zip(bits.into_iter().map(|bits| bits.contains(LineBits::CONTOUR))).collect()
}

/// A face's plane in 64 bits.
struct Plane {
    normal: DVec3,
    point: DVec3,
    /// The largest angle by which 32 bits turn the normal, in radians.
    rounding: f64,
}

impl Plane {
    fn of(mesh: &EdgeMesh, face: u32) -> Self {
        let [a, b, c] = mesh.triangles[face as usize]
            .map(|v| Vec3::from(mesh.positions[v as usize]).as_dvec3());
        let area = (b - a).cross(c - a);
        let longest =
            [b - a, c - b, a - c].map(DVec3::length_squared).into_iter().fold(0.0, f64::max);
        // A thin triangle's normal loses as much as its height to its length.
        let rounding = f64::from(f32::EPSILON) * 8.0 * longest / area.length();
        Self { normal: area.normalize_or_zero(), point: a, rounding }
    }

    /// Whether 32 bits may see the eye on the wrong side.
    fn is_edge_on(&self, eye: Vec4) -> bool {
        let eye_point = eye.truncate().as_dvec3();
        let distance = self.normal.dot(eye_point - f64::from(eye.w) * self.point);
        distance.abs() <= self.rounding * (eye_point.length() + self.point.length())
    }
}

fn is_in_doubt(mesh: &EdgeMesh, record: &EdgeRecord, eye: Vec4) -> bool {
    let faces = [record.face_a, record.face_b].into_iter().filter(|&face| face != NONE);
    faces.map(|face| Plane::of(mesh, face)).any(|plane| plane.is_edge_on(eye))
}

fn options(ridge_deg: f64, valley_deg: f64) -> BuildOptions {
    BuildOptions {
        ridge_angle_rad: ridge_deg.to_radians(),
        valley_angle_rad: valley_deg.to_radians(),
        ..BuildOptions::default()
    }
}

fn swap_creases(flags: EdgeFlags) -> EdgeFlags {
    let mut swapped = flags - CREASES;
    swapped.set(EdgeFlags::RIDGE, flags.contains(EdgeFlags::VALLEY));
    swapped.set(EdgeFlags::VALLEY, flags.contains(EdgeFlags::RIDGE));
    swapped
}

proptest! {
    #![proptest_config(config(2048))]

    #[test]
    fn flipping_all_faces_swaps_ridges_with_valleys_and_keeps_contours(
        mesh in oriented_mesh().prop_map(|mesh| mesh.triangulated()),
        (ridge, valley) in (5.0..120.0, 5.0..120.0),
        eye in eye(),
    ) {
        let (front, report) = mesh.build_with(&options(ridge, valley));
        prop_assume!(report.repair_count(RepairKind::InsideOutFaces) == 0);
        let (back, report) = mesh.turned(|_| true).build_with(&options(valley, ridge));
        if report.repair_count(RepairKind::InsideOutFaces) > 0 {
            let (turned, _) = mesh.turned(|_| true).build_with(&options(ridge, valley));
            prop_assert_eq!(contours(&turned, eye).len(), contours(&front, eye).len());
            let creases = |mesh: &EdgeMesh| -> BTreeMap<Ends, EdgeFlags> {
                mesh.records.iter().map(|record| (ends(mesh, record), record.flags())).collect()
            };
            prop_assert_eq!(creases(&turned), creases(&front), "closed, so it is turned outward");
            return Ok(());
        }
        let flags = |mesh: &EdgeMesh| -> BTreeMap<Ends, EdgeFlags> {
            let visible = |flags| flags - EdgeFlags::SOLID;
            mesh.records.iter().map(|record| (ends(mesh, record), visible(record.flags()))).collect()
        };
        let swapped: BTreeMap<Ends, EdgeFlags> =
            flags(&front).into_iter().map(|(ends, flags)| (ends, swap_creases(flags))).collect();
        prop_assert_eq!(flags(&back), swapped);

        // Zero counts as back on both sides, so an edge-on face may differ.
        let (before, after) = (contours(&front, eye), contours(&back, eye));
        let mut doubtful = 0;
        for record in &front.records {
            if is_in_doubt(&front, record, eye) {
                doubtful += 1;
            } else {
                let ends = ends(&front, record);
                prop_assert_eq!(before[&ends], after[&ends], "{:?}", record);
            }
        }
        prop_assert!(doubtful <= 8 + front.records.len() / 50, "{} in doubt", doubtful);
    }

    #[test]
    fn solid_edges_are_those_of_closed_components_that_look_outward(
        (solid, hollow) in (closed_mesh(), closed_mesh()),
        sheet in oriented_mesh().prop_map(|mesh| mesh.triangulated().without_face(0)),
    ) {
        let (solid, hollow) = (solid.triangulated().outward(), hollow.triangulated().outward());
        let inside_out = hollow.turned(|_| true);
        let solid_faces = solid.polygons.len() + inside_out.polygons.len();
        let parts = [solid, inside_out.moved(8.0), sheet.moved(16.0)];
        for record in &Mesh::joined(&parts).build().records {
            let is_expected = (record.face_a as usize) < solid_faces;
            prop_assert_eq!(record.flags().contains(EdgeFlags::SOLID), is_expected, "{:?}", record);
        }
    }

    #[test]
    fn scaling_by_a_power_of_two_changes_no_class(
        mesh in prop_oneof![oriented_mesh(), one_sided_mesh(), soup(3..=5)],
        eye in eye(),
        exponent in -100..=100_i32,
    ) {
        let scale = 2.0_f32.powi(exponent);
        let (small, large) = (mesh.build(), mesh.scaled(scale).build());
        assert_near(&small.records, &large.records);
        prop_assert_eq!(&small.triangles, &large.triangles);
        prop_assert_eq!(&small.vertex_normals, &large.vertex_normals);
        prop_assert_eq!(small.counts, large.counts);
        let eye_in_file = eye.truncate().as_dvec3() * f64::from(scale);
        let scaled_eye = large.frame.to_mesh(eye_in_file).as_vec3().extend(eye.w);
        prop_assert_eq!(classify_edges(&small, eye), classify_edges(&large, scaled_eye));
    }

    #[test]
    fn the_default_view_grows_with_the_model(
        mesh in oriented_mesh(),
        exponent in -100..=100_i32,
        is_orthographic in any::<bool>(),
    ) {
        let scale = 2.0_f32.powi(exponent);
        let look = |positions: &[[f32; 3]]| {
            let bounds = Bounds::of(positions);
            let camera = Camera { is_orthographic, ..Camera::default_view(&bounds) };
            camera.view(&bounds, 1.0)
        };
        let scaled = mesh.scaled(scale).positions;
        let (near, far) = (look(&mesh.positions), look(&scaled));
        let expected = (near.eye.truncate() * scale).extend(near.eye.w);
        prop_assert_eq!(if is_orthographic { near.eye } else { expected }, far.eye);
        for (&small, &large) in mesh.positions.iter().zip(&scaled) {
            let before = near.clip_from_world.project_point3(small.into());
            let after = far.clip_from_world.project_point3(large.into());
            prop_assert!((before - after).abs().max_element() < 1e-4, "{} and {}", before, after);
        }
    }

    #[test]
    fn contours_of_a_closed_mesh_are_closed_loops(
        mesh in closed_mesh(),
        eye in eye(),
        at_vertex in prop::option::weighted(0.2, any::<prop::sample::Index>()),
    ) {
        let built = mesh.build();
        let eye = match at_vertex {
            Some(index) => Vec3::from(*index.get(&built.positions)).extend(eye.w),
            None => eye,
        };
        let mut ends_at = vec![0_u32; built.positions.len()];
        for (record, bits) in built.records.iter().zip(classify_edges(&built, eye)) {
            if bits.contains(LineBits::CONTOUR) {
                ends_at[record.v0 as usize] += 1;
                ends_at[record.v1 as usize] += 1;
            }
        }
        prop_assert!(ends_at.iter().all(|count| count % 2 == 0), "{:?}", ends_at);
        // A closed surface has a near side and a far side from outside.
        let is_outside = eye.w == 0.0 || eye.truncate().length() > 3.5;
        let contour_ends: u32 = ends_at.iter().sum();
        prop_assert!(contour_ends >= 6 || !is_outside || at_vertex.is_some(), "no contour");
    }

    #[test]
    fn a_flat_polygon_is_covered_once_whatever_its_shape(
        radii in prop::collection::vec(1..6_i8, 4..14),
        start in any::<prop::sample::Index>(),
        is_backward in any::<bool>(),
    ) {
        let mesh = star(&radii, start.index(radii.len()), is_backward);
        let built = mesh.build();
        let front = if is_backward { -9.0 } else { 9.0 };
        for height in [front, -front] {
            let is_contour = contours(&built, Vec4::new(0.1, 0.2, height, 1.0));
            prop_assert!(is_contour.values().all(|found| !found), "no triangle turns over");
        }
        let corner = |index: u32| Vec3::from(mesh.positions[index as usize]).as_dvec3();
        let ring = &mesh.polygons[0];
        let outline: f64 = (0..ring.len())
            .map(|k| corner(ring[k]).cross(corner(ring[(k + 1) % ring.len()])).z)
            .sum();
        let covered: f64 = built
            .triangles
            .iter()
            .map(|triangle| {
                let [a, b, c] = triangle.map(|v| Vec3::from(built.positions[v as usize]).as_dvec3());
                (b - a).cross(c - a).length()
            })
            .sum();
        prop_assert!((outline.abs() - covered).abs() < 1e-4, "{} of {}", covered, outline);
    }

    #[test]
    fn equation_1_agrees_with_facing_bits_and_flags(
        mesh in prop_oneof![
            2 => oriented_mesh(),
            2 => oriented_mesh().prop_map(|mesh| mesh.triangulated()),
            1 => one_sided_mesh(),
        ],
        (ridge, valley) in (5.0..120.0_f64, 5.0..120.0_f64),
        eye in eye(),
    ) {
        let (built, _) = mesh.build_with(&options(ridge, valley));
        let cosines = [ridge, valley].map(|degrees| degrees.to_radians().cos());
        #[expect(clippy::cast_possible_truncation, reason = "the shader has 32 bits too")]
        let [ridge_cosine, valley_cosine] = cosines.map(|cosine| cosine as f32);
        let vertices = replicate(&built);
        let (mut contours_in_doubt, mut creases_in_doubt) = (0, 0);
        let lines = classify_edges(&built, eye);
        for ((record, four), bits) in built.records.iter().zip(vertices.as_chunks::<4>().0).zip(lines) {
            if record.flags().contains(EdgeFlags::DIAGONAL) {
                let classes = EdgeFlags::ALWAYS_DRAWN;
                prop_assert!(!record.flags().intersects(classes), "only a contour: {:?}", record);
            }
            for vertex in four {
                prop_assert_eq!(vertex.flags(), record.flags());
                let (is_contour, crease) = equation_1(vertex, eye, ridge_cosine, valley_cosine);
                if is_in_doubt(&built, record, eye) {
                    contours_in_doubt += 1;
                } else {
                    prop_assert_eq!(is_contour, bits.contains(LineBits::CONTOUR), "{:?}", record);
                }
                if record.face_b == NONE {
                    prop_assert_eq!((is_contour, crease), (false, EdgeFlags::empty()));
                } else if built.counts.diagonal_edges > 0 {
                    // Creases of polygons are judged by their own normals.
                } else if crease_in_doubt(&built, record, cosines) {
                    creases_in_doubt += 1;
                } else {
                    prop_assert_eq!(crease, record.flags() & CREASES, "{:?}", record);
                }
            }
        }
        let bound = 32 + vertices.len() / 50;
        prop_assert!(contours_in_doubt <= bound, "{} in doubt", contours_in_doubt);
        prop_assert!(creases_in_doubt <= bound, "{} in doubt", creases_in_doubt);
    }
}

/// One polygon around the origin, mostly concave, its corners at `radii`.
fn star(radii: &[i8], start: usize, is_backward: bool) -> Mesh {
    let count = u32::try_from(radii.len()).unwrap();
    let step = std::f32::consts::TAU / f32::from(u8::try_from(count).unwrap());
    let corners = radii.iter().zip(0_u8..).map(|(&radius, k)| {
        let (sin, cos) = (step * f32::from(k)).sin_cos();
        [f32::from(radius) * cos, f32::from(radius) * sin, 0.0]
    });
    let mut ring: Vec<u32> = (0..count).collect();
    ring.rotate_left(start);
    if is_backward {
        ring.reverse();
    }
    Mesh { positions: corners.collect(), polygons: vec![ring] }
}

/// Whether a threshold lies between what is certain of an angle and the angle, or so near to it
/// that 32 bits may decide otherwise, as they may near 180 degrees.
fn crease_in_doubt(mesh: &EdgeMesh, record: &EdgeRecord, cosines: [f64; 2]) -> bool {
    let [a, b] = [record.face_a, record.face_b].map(|face| Plane::of(mesh, face));
    let turned = if record.flags().contains(EdgeFlags::CLASH) { -1.0 } else { 1.0 };
    let cosine = a.normal.dot(b.normal) * turned;
    // Near 180 degrees the apex of B lies in the plane of A.
    let lift = a.normal.cross(b.normal).length();
    let rounding = a.rounding + b.rounding;
    let certain = ((f64::from(record.word.crease_steps()) - 1.0) / 720.0).to_radians().cos();
    let is_between = |threshold: f64| (cosine - rounding..=certain + rounding).contains(&threshold);
    cosines.into_iter().any(is_between) || (cosine < 0.0 && lift <= rounding)
}

#[test]
fn a_cube_has_ridges_whichever_way_it_is_wound() {
    let mesh = Mesh {
        positions: vec![
            [0., 0., 0.],
            [1., 0., 0.],
            [1., 1., 0.],
            [0., 1., 0.],
            [0., 0., 1.],
            [1., 0., 1.],
            [1., 1., 1.],
            [0., 1., 1.],
        ],
        polygons: [
            [0, 3, 2, 1],
            [4, 5, 6, 7],
            [0, 1, 5, 4],
            [2, 3, 7, 6],
            [1, 2, 6, 5],
            [0, 4, 7, 3],
        ]
        .map(Vec::from)
        .to_vec(),
    };
    let count = |mesh: &EdgeMesh, class| {
        mesh.records.iter().filter(|record| record.flags().contains(class)).count()
    };
    let (front, back) = (mesh.build(), mesh.turned(|_| true).build());
    assert_eq!((count(&front, EdgeFlags::RIDGE), count(&front, EdgeFlags::VALLEY)), (12, 0));
    assert_eq!((count(&back, EdgeFlags::RIDGE), count(&back, EdgeFlags::VALLEY)), (12, 0));
    let is_contour = |mesh: &EdgeMesh| -> usize {
        contours(mesh, Vec4::new(3.0, 2.0, 4.0, 1.0)).values().filter(|found| **found).count()
    };
    assert_eq!((is_contour(&front), is_contour(&back)), (6, 6));
}
