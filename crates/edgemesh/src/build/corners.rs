//! Corner attributes of the fill: normals with sharp edges, texture coordinates and colors with
//! seams.
//!
//! A corner keeps its normal of the file. Other corners at a vertex share a normal if smooth edges
//! join them: edges within a smoothing group, edges below the crease angle in files without groups,
//! and always the diagonals of polygons.
//!
//! Idea: a union-find over all corners; each smooth edge joins the corners at both of its ends.
//! Rejected: comparing all pairs of faces around a vertex, which takes quadratic time at a hub and
//! smooths across gaps.

use glam::{DVec3, Vec3};
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::FaceAttributes;
use super::components::Sets;
use super::faces::FaceSources;
use super::fans::angle;
use super::planes::has_normal;
use super::runs::fill_runs;
use crate::edge_mesh::{
    EdgeFlags, EdgeRecord, FacePlane, FillMesh, FillVertex, corners_of, threshold_steps,
};
use crate::index::{NONE, to_u32};
use crate::model::{Model, Smoothing};

/// The input of the fill.
#[derive(Debug)]
pub(crate) struct CornerInput<'a> {
    pub(crate) model: &'a Model,
    pub(crate) positions: &'a [[f32; 3]],
    pub(crate) triangles: &'a [[u32; 3]],
    pub(crate) sources: &'a FaceSources,
    pub(crate) planes: &'a [FacePlane],
    pub(crate) records: &'a [EdgeRecord],
    pub(crate) attributes: &'a FaceAttributes,
    pub(crate) smoothing_angle_rad: f64,
    /// Whether the fill is built.
    pub(crate) is_wanted: bool,
}

/// Corners in a block whose weighted normals are computed in parallel.
const CORNERS_PER_BLOCK: usize = 1 << 18;

/// Builds the fill, or returns an empty one if it is not wanted.
pub(crate) fn build_fill(input: &CornerInput) -> FillMesh {
    if !input.is_wanted {
        return FillMesh::default();
    }
    let normals = smooth_normals(input);
    let has_colors = !input.model.colors.is_empty();
    let mut variants = Variants::new(input.positions.len());
    let mut indices = Vec::with_capacity(input.triangles.len() * 3);
    for (face, triangle) in input.triangles.iter().enumerate() {
        let sources = input.sources.corners(face);
        for (corner, &vertex) in triangle.iter().enumerate() {
            let source = input.model.corner(sources[corner] as usize);
            let own_normal = (source.normal != NONE)
                .then(|| Vec3::from(input.model.normals[source.normal as usize]).try_normalize())
                .flatten();
            let normal = own_normal.map_or(normals[3 * face + corner], Into::into);
            let texcoord = match source.texcoord {
                NONE => [0.0; 2],
                index => input.model.texcoords[index as usize],
            };
            let position = input.positions[vertex as usize];
            let color = if has_colors { coded(input.model, sources[corner]) } else { NO_COLOR };
            let wanted = FillVertex { position, normal, texcoord };
            indices.push(variants.index(vertex, wanted, color));
        }
    }
    FillMesh {
        vertices: variants.vertices,
        colors: if has_colors { variants.colors } else { Vec::new() },
        indices,
        runs: fill_runs(input.model, input.sources),
        materials: input.model.materials.clone(),
        groups: input.model.groups.clone(),
    }
}

/// The color of all vertices of a model without colors.
const NO_COLOR: [u8; 4] = [0; 4];

/// The color of a corner in bytes.
#[expect(clippy::cast_possible_truncation, reason = "clamped")]
#[expect(clippy::cast_sign_loss, reason = "clamped")]
fn coded(model: &Model, corner: u32) -> [u8; 4] {
    model.corner_color(corner as usize).map(|part| (part.clamp(0.0, 1.0) * 255.0).round() as u8)
}

/// The vertices of the fill, by the vertex of the mesh at their position.
///
/// Most vertices have one or two, in a list from the latest to the first; a vertex with more than
/// a few finds the others in a table.
struct Variants {
    vertices: Vec<FillVertex>,
    /// One for each of `vertices`.
    colors: Vec<[u8; 4]>,
    /// The latest fill vertex at each vertex, or [`NONE`].
    latest: Vec<u32>,
    /// The previous fill vertex at the same vertex, or [`NONE`].
    before: Vec<u32>,
    table: FxHashMap<(u32, [u32; 9]), u32>,
}

impl Variants {
    /// The length up to which a list is followed.
    const FEW: usize = 8;

    fn new(vertex_count: usize) -> Self {
        let latest = vec![NONE; vertex_count];
        Self {
            vertices: Vec::new(),
            colors: Vec::new(),
            latest,
            before: Vec::new(),
            table: FxHashMap::default(),
        }
    }

    /// The index of a fill vertex at `vertex`, which is added if it is new.
    fn index(&mut self, vertex: u32, wanted: FillVertex, color: [u8; 4]) -> u32 {
        let wanted_bits = bits_of(&wanted, color);
        let (mut at, mut last) = (self.latest[vertex as usize], NONE);
        for step in 0..Self::FEW {
            if at == NONE {
                break;
            }
            if self.bits(at) == wanted_bits {
                return at;
            }
            if step + 1 == Self::FEW {
                last = at;
            }
            at = self.before[at as usize];
        }
        if at != NONE
            && let Some(&known) = self.table.get(&(vertex, wanted_bits))
        {
            return known;
        }
        // The vertex that the new one pushes out of reach goes to the table.
        if last != NONE {
            self.table.insert((vertex, self.bits(last)), last);
        }
        let index = to_u32(self.vertices.len());
        self.vertices.push(wanted);
        self.colors.push(color);
        self.before.push(std::mem::replace(&mut self.latest[vertex as usize], index));
        index
    }

    fn bits(&self, index: u32) -> [u32; 9] {
        bits_of(&self.vertices[index as usize], self.colors[index as usize])
    }
}

/// The bits of all attributes of a fill vertex.
fn bits_of(vertex: &FillVertex, color: [u8; 4]) -> [u32; 9] {
    let [px, py, pz, nx, ny, nz, u, v]: [u32; 8] = bytemuck::cast(*vertex);
    [px, py, pz, nx, ny, nz, u, v, u32::from_le_bytes(color)]
}

/// A unit normal for each corner (3 f + k), shared across smooth edges.
fn smooth_normals(input: &CornerInput) -> Vec<[f32; 3]> {
    let sets = Sets::new(input.triangles.len() * 3);
    input.records.par_iter().with_min_len(1 << 12).for_each(|record| {
        if record.face_b != NONE && is_smooth(input, record) {
            join_corners(input, record, &sets);
        }
    });
    let corner_count = input.triangles.len() * 3;
    let roots: Vec<u32> =
        (0..to_u32(corner_count)).into_par_iter().map(|corner| sets.root(corner)).collect();
    let mut sums = vec![DVec3::ZERO; corner_count];
    // Blocks are computed in parallel and added in order.
    for first in (0..corner_count).step_by(CORNERS_PER_BLOCK) {
        let block = first..corner_count.min(first + CORNERS_PER_BLOCK);
        let weighted: Vec<DVec3> =
            block.clone().into_par_iter().map(|corner| weighted_normal(input, corner)).collect();
        for (corner, normal) in block.zip(weighted) {
            sums[roots[corner] as usize] += normal;
        }
    }
    let normal = |&root: &u32| sums[root as usize].normalize_or_zero().as_vec3().to_array();
    roots.par_iter().with_min_len(1 << 12).map(normal).collect()
}

/// Joins the corners of a record's two faces at both of its ends.
fn join_corners(input: &CornerInput, record: &EdgeRecord, sets: &Sets) {
    for vertex in [record.v0, record.v1] {
        let corner = |face: u32| {
            let triangle = input.triangles[face as usize];
            let place = triangle.iter().position(|&other| other == vertex);
            place.map(|place| 3 * face + to_u32(place))
        };
        if let (Some(a), Some(b)) = (corner(record.face_a), corner(record.face_b)) {
            sets.join(a, b);
        }
    }
}

/// The normal of the face of a corner, times the angle of the corner; zero without a normal.
fn weighted_normal(input: &CornerInput, corner: usize) -> DVec3 {
    let plane = &input.planes[corner / 3];
    if !has_normal(plane) {
        return DVec3::ZERO;
    }
    let [x, y, z, _] = plane.normal;
    Vec3::new(x, y, z).as_dvec3() * f64::from(corner_angle(input, corner))
}

/// The angle of a face at a corner, in radians.
fn corner_angle(input: &CornerInput, corner: usize) -> f32 {
    let points = corners_of(input.positions, input.triangles[corner / 3]);
    let at = points[corner % 3];
    let [to_next, to_previous] =
        [1, 2].map(|step| (points[(corner + step) % 3] - at).normalize_or_zero().as_vec3());
    angle(to_next.dot(to_previous))
}

fn is_smooth(input: &CornerInput, record: &EdgeRecord) -> bool {
    if record.flags().contains(EdgeFlags::DIAGONAL) {
        return true;
    }
    if record.flags().intersects(EdgeFlags::NON_MANIFOLD | EdgeFlags::CLASH) {
        return false;
    }
    let limit = match (
        input.attributes.smoothing(record.face_a),
        input.attributes.smoothing(record.face_b),
    ) {
        (Smoothing::Group(a), Smoothing::Group(b)) => return a != 0 && a == b,
        (Smoothing::Angle(a), Smoothing::Angle(b)) => f64::from(a.min(b)),
        _ => input.smoothing_angle_rad,
    };
    record.word.crease_steps() < threshold_steps(limit)
}

#[cfg(test)]
mod tests {
    use super::{FillVertex, Variants};
    use crate::build::{BuildOptions, build_edge_mesh};
    use crate::edge_mesh::FillMesh;
    use crate::model::{Attributes, Model, PolygonRun, Smoothing};
    use crate::report::Report;

    const CUBE: [[f32; 3]; 8] = [
        [0., 0., 0.],
        [1., 0., 0.],
        [1., 1., 0.],
        [0., 1., 0.],
        [0., 0., 1.],
        [1., 0., 1.],
        [1., 1., 1.],
        [0., 1., 1.],
    ];
    const SIDES: [&[u32]; 6] =
        [&[0, 3, 2, 1], &[4, 5, 6, 7], &[0, 1, 5, 4], &[2, 3, 7, 6], &[1, 2, 6, 5], &[0, 4, 7, 3]];

    fn fill_of(model: &Model) -> FillMesh {
        build_edge_mesh(model, &BuildOptions::default(), &mut Report::default()).fill
    }

    #[test]
    fn a_cube_shades_with_sharp_faces() {
        let fill = fill_of(&Model::from_polygons(&CUBE, &SIDES));
        assert_eq!(fill.vertices.len(), 24, "four vertices a side");
        assert_eq!(fill.indices.len(), 36);
        for vertex in &fill.vertices {
            let axes = vertex.normal.iter().filter(|part| part.abs() > 1e-6).count();
            assert_eq!(axes, 1, "{vertex:?}");
        }
    }

    #[test]
    fn one_smoothing_group_rounds_the_cube() {
        let mut model = Model::from_polygons(&CUBE, &SIDES);
        let attributes = Attributes { smoothing: Smoothing::Group(1), ..Attributes::default() };
        model.runs = vec![PolygonRun { first_polygon: 0, attributes }];
        assert_eq!(fill_of(&model).vertices.len(), 8);
        let attributes = Attributes { smoothing: Smoothing::Angle(1.6), ..attributes };
        model.runs = vec![PolygonRun { first_polygon: 0, attributes }];
        assert_eq!(fill_of(&model).vertices.len(), 8, "a right angle is 1.57");
    }

    #[test]
    fn one_place_keeps_the_colors_of_its_vertices() {
        // Two squares that meet at a right angle, with vertices of their own at the shared edge.
        let mut positions = CUBE[..4].to_vec();
        positions.extend([CUBE[0], CUBE[1], CUBE[5], CUBE[4]]);
        let polygons: [&[u32]; 2] = [&[0, 3, 2, 1], &[4, 5, 6, 7]];
        let plain = Model::from_polygons(&positions, &polygons);
        let mut model = plain.clone();
        let [red, blue] = [[1.0, 0.0, -1.0, 0.5], [0.0, 0.2, 7.0, 1.0]];
        model.colors = [[red; 4], [blue; 4]].concat();
        let build =
            |model| build_edge_mesh(model, &BuildOptions::default(), &mut Report::default());
        let (mesh, without) = (build(&model), build(&plain));
        assert_eq!((mesh.counts, &mesh.records), (without.counts, &without.records));
        assert_eq!((mesh.positions.len(), without.fill.colors.len()), (6, 0));
        let colors_at = |index: &u32| mesh.fill.colors[*index as usize];
        let (of_first, of_second) = mesh.fill.indices.split_at(6);
        assert!(of_first.iter().all(|index| colors_at(index) == [255, 0, 0, 128]));
        assert!(of_second.iter().all(|index| colors_at(index) == [0, 51, 255, 255]));
        // Rounded, so that only colors part the vertices.
        let attributes = Attributes { smoothing: Smoothing::Group(1), ..Attributes::default() };
        for model in [&mut model.clone(), &mut plain.clone()] {
            model.runs = vec![PolygonRun { first_polygon: 0, attributes }];
            let expected = if model.colors.is_empty() { 6 } else { 8 };
            assert_eq!(fill_of(model).vertices.len(), expected);
        }
    }

    #[test]
    fn a_vertex_may_have_many_variants() {
        let mut variants = Variants::new(2);
        let wanted = |k: u16| FillVertex {
            position: [0.0; 3],
            normal: [0.0, 0.0, 1.0],
            texcoord: [f32::from(k), 0.0],
        };
        for round in 0..3 {
            for k in 0..100_u16 {
                let place = u32::from(k % 2);
                let color = [u8::try_from(k * 7 % 100).unwrap(), 0, 0, 255];
                let index = variants.index(place, wanted(k * 7 % 50), color);
                assert_eq!(index, u32::from(k), "round {round}");
            }
        }
        assert_eq!((variants.vertices.len(), variants.colors.len()), (100, 100));
    }

    #[test]
    fn the_files_normals_win_and_texture_seams_stay() {
        let mut model = Model::from_polygons(&CUBE, &SIDES);
        model.normals = vec![[0., 0., 2.]];
        model.texcoords = vec![[0., 0.], [1., 0.]];
        model.corner_normals = vec![0; 24];
        model.corner_texcoords = (0..24).map(|index| u32::from(index >= 12)).collect();
        let fill = fill_of(&model);
        assert!(fill.vertices.iter().all(|vertex| vertex.normal == [0., 0., 1.]));
        assert!(fill.vertices.len() > 8, "a seam runs where the texture coordinates differ");
    }
}
