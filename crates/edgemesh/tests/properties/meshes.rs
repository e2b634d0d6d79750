//! Generators of meshes: random triangle soups full of collisions, and spheres, tori, height fields
//! and Möbius strips, bent by noise.

use std::f64::consts::TAU;

use edgemesh::build::{BuildOptions, build_edge_mesh};
use edgemesh::edge_mesh::{EdgeMesh, EdgeRecord};
use edgemesh::model::Model;
use edgemesh::report::Report;
use glam::Vec3;
use proptest::collection::vec;
use proptest::prelude::*;

/// Generated coordinates are multiples of this, so that a scale by a power of
/// two changes no bit of their fractions.
const STEP: f64 = 1.0 / 4096.0;

/// Polygons over shared vertices.
#[derive(Debug, Clone, Default)]
pub(crate) struct Mesh {
    pub(crate) positions: Vec<[f32; 3]>,
    pub(crate) polygons: Vec<Vec<u32>>,
}

impl Mesh {
    pub(crate) fn model(&self) -> Model {
        let polygons: Vec<&[u32]> = self.polygons.iter().map(Vec::as_slice).collect();
        Model::from_polygons(&self.positions, &polygons)
    }

    pub(crate) fn build(&self) -> EdgeMesh {
        self.build_with(&BuildOptions::default()).0
    }

    pub(crate) fn build_with(&self, options: &BuildOptions) -> (EdgeMesh, Report) {
        let mut report = Report::default();
        (build_edge_mesh(&self.model(), options, &mut report), report)
    }

    /// The same mesh, every polygon cut as a fan.
    pub(crate) fn triangulated(&self) -> Self {
        let fan = |corners: &Vec<u32>| -> Vec<Vec<u32>> {
            corners[1..].windows(2).map(|pair| vec![corners[0], pair[0], pair[1]]).collect()
        };
        Self {
            positions: self.positions.clone(),
            polygons: self.polygons.iter().flat_map(fan).collect(),
        }
    }

    /// The same mesh, the polygons that `is_turned` picks wound the other way;
    /// each keeps its first corner.
    pub(crate) fn turned(&self, is_turned: impl Fn(usize) -> bool) -> Self {
        let mut turned = self.clone();
        for (_, polygon) in turned.polygons.iter_mut().enumerate().filter(|(k, _)| is_turned(*k)) {
            polygon[1..].reverse();
        }
        turned
    }

    /// The same closed mesh of triangles, wound so that it encloses a positive
    /// volume.
    pub(crate) fn outward(&self) -> Self {
        let corner = |vertex: u32| Vec3::from(self.positions[vertex as usize]).as_dvec3();
        let volume: f64 = self
            .polygons
            .iter()
            .map(|face| corner(face[0]).dot(corner(face[1]).cross(corner(face[2]))))
            .sum();
        self.turned(|_| volume < 0.0)
    }

    pub(crate) fn without_face(mut self, face: usize) -> Self {
        self.polygons.remove(face);
        self
    }

    /// The same mesh further along x.
    pub(crate) fn moved(&self, distance: f32) -> Self {
        let positions = self.positions.iter().map(|&[x, y, z]| [x + distance, y, z]).collect();
        Self { positions, polygons: self.polygons.clone() }
    }

    /// All faces of `parts`, in order.
    pub(crate) fn joined(parts: &[Self]) -> Self {
        let mut joined = Self::default();
        for part in parts {
            let first = u32::try_from(joined.positions.len()).unwrap();
            joined.positions.extend_from_slice(&part.positions);
            let renumbered = part.polygons.iter();
            let renumbered =
                renumbered.map(|face| face.iter().map(|vertex| vertex + first).collect());
            joined.polygons.extend(renumbered);
        }
        joined
    }

    pub(crate) fn scaled(&self, scale: f32) -> Self {
        let positions = self.positions.iter().map(|p| p.map(|x| x * scale)).collect();
        Self { positions, polygons: self.polygons.clone() }
    }

    /// Adds noise of up to `amount` to every coordinate.
    fn shaken(mut self, amount: f64, seed: u64) -> Self {
        let mut noise = Noise(seed);
        for coordinate in self.positions.as_flattened_mut() {
            *coordinate = rounded(f64::from(*coordinate) + amount * noise.next());
        }
        self
    }
}

#[expect(clippy::cast_possible_truncation, reason = "few steps, which fit a float exactly")]
fn rounded(coordinate: f64) -> f32 {
    ((coordinate / STEP).round() * STEP) as f32
}

/// A small generator of numbers from -1 to 1 (splitmix64).
pub(crate) struct Noise(pub(crate) u64);

impl Noise {
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let top = u32::try_from((bits ^ (bits >> 31)) >> 32).unwrap();
        f64::from(top) / f64::from(u32::MAX) * 2.0 - 1.0
    }

    /// A permutation of 0 to `count - 1`.
    pub(crate) fn permutation(&mut self, count: usize) -> Vec<usize> {
        let mut keyed: Vec<(f64, usize)> = (0..count).map(|item| (self.next(), item)).collect();
        keyed.sort_by(|a, b| a.partial_cmp(b).unwrap());
        keyed.into_iter().map(|(_, item)| item).collect()
    }
}

/// A sphere of quads with triangles at its two poles.
pub(crate) fn sphere(rings: u32, segments: u32) -> Mesh {
    let mut mesh = Mesh::default();
    mesh.positions.push([0.0, 0.0, 1.0]);
    for ring in 1..=rings {
        let (sin, cos) = (TAU / 2.0 * f64::from(ring) / f64::from(rings + 1)).sin_cos();
        for segment in 0..segments {
            let (y, x) = (TAU * f64::from(segment) / f64::from(segments)).sin_cos();
            mesh.positions.push([sin * x, sin * y, cos].map(rounded));
        }
    }
    mesh.positions.push([0.0, 0.0, -1.0]);
    let at = |ring: u32, segment: u32| 1 + ring * segments + segment % segments;
    let last = 1 + rings * segments;
    for segment in 0..segments {
        mesh.polygons.push(vec![0, at(0, segment), at(0, segment + 1)]);
        for ring in 1..rings {
            mesh.polygons.push(quad(at, ring - 1, segment));
        }
        mesh.polygons.push(vec![last, at(rings - 1, segment + 1), at(rings - 1, segment)]);
    }
    mesh
}

/// A torus of quads.
pub(crate) fn torus(rings: u32, segments: u32) -> Mesh {
    let mut mesh = Mesh::default();
    for ring in 0..rings {
        let (sin, cos) = (TAU * f64::from(ring) / f64::from(rings)).sin_cos();
        for segment in 0..segments {
            let (y, x) = (TAU * f64::from(segment) / f64::from(segments)).sin_cos();
            let radius = 1.5 - 0.6 * cos;
            mesh.positions.push([radius * x, radius * y, 0.6 * sin].map(rounded));
        }
    }
    let at = |ring: u32, segment: u32| ring % rings * segments + segment % segments;
    for (ring, segment) in pairs(rings, segments) {
        mesh.polygons.push(quad(at, ring, segment));
    }
    mesh
}

/// A flat sheet of quads with a boundary.
pub(crate) fn sheet(rows: u32, columns: u32) -> Mesh {
    let mut mesh = Mesh::default();
    for (row, column) in pairs(rows + 1, columns + 1) {
        let position = [row, column].map(|index| f64::from(index) * 0.25 - 1.0);
        mesh.positions.push([position[0], position[1], 0.0].map(rounded));
    }
    let at = |row: u32, column: u32| row * (columns + 1) + column;
    for (row, column) in pairs(rows, columns) {
        mesh.polygons.push(quad(at, row, column));
    }
    mesh
}

/// A strip of triangles, joined with half a turn.
pub(crate) fn moebius_strip(steps: u32) -> Mesh {
    let mut mesh = Mesh::default();
    for step in 0..steps {
        let around = TAU * f64::from(step) / f64::from(steps);
        let ((y, x), (lift, spread)) = (around.sin_cos(), (around / 2.0).sin_cos());
        for side in [-0.5, 0.5] {
            let radius = 1.5 + side * spread;
            mesh.positions.push([radius * x, radius * y, side * lift].map(rounded));
        }
    }
    for step in 0..steps {
        let (a, b) = (2 * step, 2 * step + 1);
        let (c, d) = if step + 1 == steps { (1, 0) } else { (a + 2, b + 2) };
        mesh.polygons.extend([vec![a, c, b], vec![b, c, d]]);
    }
    mesh
}

fn pairs(rows: u32, columns: u32) -> impl Iterator<Item = (u32, u32)> {
    (0..rows).flat_map(move |row| (0..columns).map(move |column| (row, column)))
}

fn quad(at: impl Fn(u32, u32) -> u32, row: u32, column: u32) -> Vec<u32> {
    vec![at(row, column), at(row + 1, column), at(row + 1, column + 1), at(row, column + 1)]
}

fn shaken(mesh: impl Strategy<Value = Mesh>) -> impl Strategy<Value = Mesh> {
    let amount = prop_oneof![Just(0.02), Just(0.3)];
    (mesh, amount, any::<u64>()).prop_map(|(mesh, amount, seed)| mesh.shaken(amount, seed))
}

/// Closed surfaces with a consistent winding, bent by noise; they may pass
/// through themselves, but no two of their vertices are in one place.
pub(crate) fn closed_mesh() -> impl Strategy<Value = Mesh> {
    let mesh = prop_oneof![
        (1..7_u32, 3..12_u32).prop_map(|(rings, segments)| sphere(rings, segments)),
        (3..8_u32, 3..12_u32).prop_map(|(rings, segments)| torus(rings, segments)),
    ];
    shaken(mesh).prop_filter("two vertices in one place", has_distinct_positions)
}

/// As [`closed_mesh`], and sheets with a boundary.
pub(crate) fn oriented_mesh() -> impl Strategy<Value = Mesh> {
    let sheet = (1..7_u32, 1..9_u32).prop_map(|(rows, columns)| sheet(rows, columns));
    let sheet = shaken(sheet).prop_filter("two vertices in one place", has_distinct_positions);
    prop_oneof![2 => closed_mesh(), 1 => sheet]
}

/// Strips with one side.
pub(crate) fn one_sided_mesh() -> impl Strategy<Value = Mesh> {
    shaken((7..20_u32).prop_map(moebius_strip))
}

fn has_distinct_positions(mesh: &Mesh) -> bool {
    let mut positions: Vec<_> = mesh.positions.iter().map(|p| p.map(key)).collect();
    positions.sort_unstable();
    positions.windows(2).all(|pair| pair[0] != pair[1])
}

/// A coordinate as a number that can be sorted and compared; -0 is 0.
pub(crate) fn key(coordinate: f32) -> u32 {
    (coordinate + 0.0).to_bits()
}

/// Faces over vertices that lie on so few places that corners meet, faces
/// repeat, and edges have many faces.
pub(crate) fn soup(corners: std::ops::RangeInclusive<usize>) -> impl Strategy<Value = Mesh> {
    let coordinate = prop_oneof![Just(0.0_f32), Just(-0.0), Just(1.0), Just(2.0)];
    let positions = vec([coordinate.clone(), coordinate.clone(), coordinate], 3..12);
    faces_over(positions, corners)
}

/// As [`soup`], over coordinates of any size.
pub(crate) fn wild_soup() -> impl Strategy<Value = Mesh> {
    use proptest::num::f32::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
    let finite = POSITIVE | NEGATIVE | NORMAL | SUBNORMAL | ZERO;
    let coordinate = prop_oneof![Just(0.0_f32), Just(1.0), Just(f32::MAX), Just(f32::MIN), finite];
    faces_over(vec([coordinate.clone(), coordinate.clone(), coordinate], 3..8), 3..=7)
}

fn faces_over(
    positions: impl Strategy<Value = Vec<[f32; 3]>>,
    corners: std::ops::RangeInclusive<usize>,
) -> impl Strategy<Value = Mesh> {
    let faces = vec(vec(any::<prop::sample::Index>(), corners), 0..24);
    (positions, faces).prop_map(|(positions, faces)| {
        let vertex =
            |index: &prop::sample::Index| u32::try_from(index.index(positions.len())).unwrap();
        let polygons = faces.iter().map(|face| face.iter().map(vertex).collect()).collect();
        Mesh { positions, polygons }
    })
}

/// Asserts that records are equal, but for the rounding of crease angles, which depends on the
/// decimals of the positions.
pub(crate) fn assert_near(found: &[EdgeRecord], expected: &[EdgeRecord]) {
    assert_eq!(found.len(), expected.len(), "as many records");
    for (found, expected) in found.iter().zip(expected) {
        let steps = found.word.crease_steps().abs_diff(expected.word.crease_steps());
        assert!(steps <= 20, "more than rounding: {found:?}, {expected:?}");
        let same = EdgeRecord { word: expected.word, ..*found };
        assert_eq!(same, *expected, "but for the word");
        if found.word.crease_steps().abs_diff(30 * 720) > 20 {
            assert_eq!(found.flags(), expected.flags(), "not at the threshold: {found:?}");
        }
    }
}
