//! The corner attributes that a fill needs: normals with sharp edges, texture
//! coordinates with their seams.
//!
//! A corner keeps the file's own normal. Where it has none, corners at a vertex
//! share a normal as far as they are joined by smooth edges: edges inside one
//! smoothing group where the file states groups, edges below the crease angle
//! where it does not, and always the diagonals of a polygon.
//!
//! Idea: a union-find over all corners; each smooth edge joins the corners at
//! both of its ends. Rejected: comparing all pairs of faces around a vertex,
//! which takes quadratic time at a hub and smooths across gaps.

use glam::{DVec3, Vec3};
use rustc_hash::FxHashMap;

use super::normals::{corner_angles, corners_of};
use super::triangulate::PolygonTriangle;
use crate::edge_mesh::{FillMesh, FillVertex};
use crate::index::{NONE, to_u32};
use crate::model::Model;
use crate::record::{EdgeFlags, EdgeRecord};

/// What the fill is made from; all lists are by triangle.
#[derive(Debug)]
pub(crate) struct CornerInput<'a> {
    pub(crate) model: &'a Model,
    pub(crate) positions: &'a [[f32; 3]],
    pub(crate) triangles: &'a [[u32; 3]],
    pub(crate) sources: &'a [PolygonTriangle],
    pub(crate) normals: &'a [Option<DVec3>],
    pub(crate) records: &'a [EdgeRecord],
    pub(crate) smoothing_angle_rad: f64,
}

/// Builds the fill's vertices and indices.
pub(crate) fn build_fill(input: &CornerInput) -> FillMesh {
    let normals = smooth_normals(input);
    let mut fill = FillMesh::default();
    fill.indices.reserve(input.triangles.len() * 3);
    let mut index_of = FxHashMap::default();
    for (face, triangle) in input.triangles.iter().enumerate() {
        for (corner, &vertex) in triangle.iter().enumerate() {
            let source = input.model.corners[input.sources[face].corners[corner] as usize];
            let own_normal = (source.normal != NONE)
                .then(|| Vec3::from(input.model.normals[source.normal as usize]).try_normalize())
                .flatten();
            let normal = own_normal.map_or(normals[3 * face + corner], Into::into);
            let texcoord = match source.texcoord {
                NONE => [0.0; 2],
                index => input.model.texcoords[index as usize],
            };
            let key = (vertex, normal.map(f32::to_bits), texcoord.map(f32::to_bits));
            let index = *index_of.entry(key).or_insert_with(|| {
                let position = input.positions[vertex as usize];
                fill.vertices.push(FillVertex { position, normal, texcoord });
                to_u32(fill.vertices.len() - 1)
            });
            fill.indices.push(index);
        }
    }
    fill
}

/// One unit normal for each corner (3 f + k), shared over smooth edges.
fn smooth_normals(input: &CornerInput) -> Vec<[f32; 3]> {
    let mut sets = UnionFind::new(input.triangles.len() * 3);
    for record in input.records {
        if record.face_b == NONE || !is_smooth(input, record) {
            continue;
        }
        for vertex in [record.v0, record.v1] {
            let corner = |face: u32| {
                let triangle = input.triangles[face as usize];
                let place = triangle.iter().position(|&other| other == vertex);
                place.map(|place| 3 * face as usize + place)
            };
            if let (Some(a), Some(b)) = (corner(record.face_a), corner(record.face_b)) {
                sets.join(a, b);
            }
        }
    }
    let mut sums = vec![DVec3::ZERO; input.triangles.len() * 3];
    for (face, &triangle) in input.triangles.iter().enumerate() {
        let Some(normal) = input.normals[face] else { continue };
        let angles = corner_angles(corners_of(input.positions, triangle));
        for (corner, angle) in angles.into_iter().enumerate() {
            sums[sets.root(3 * face + corner)] += normal * angle;
        }
    }
    (0..sums.len())
        .map(|corner| sums[sets.root(corner)].normalize_or_zero().as_vec3().to_array())
        .collect()
}

fn is_smooth(input: &CornerInput, record: &EdgeRecord) -> bool {
    if record.flags.contains(EdgeFlags::DIAGONAL) {
        return true;
    }
    if record.flags.intersects(EdgeFlags::NON_MANIFOLD | EdgeFlags::CLASH) {
        return false;
    }
    let (a, b) = (record.face_a as usize, record.face_b as usize);
    if input.model.has_smoothing_groups {
        let group = |face: usize| {
            input.model.polygons[input.sources[face].polygon as usize].smoothing_group
        };
        return group(a) != 0 && group(a) == group(b);
    }
    match (input.normals[a], input.normals[b]) {
        (Some(a), Some(b)) => a.dot(b) >= input.smoothing_angle_rad.cos(),
        _ => true,
    }
}

/// Disjoint sets with path halving; the smaller index becomes the root, so the
/// result does not depend on the order of joins.
#[derive(Debug)]
pub(crate) struct UnionFind {
    parent: Vec<u32>,
}

impl UnionFind {
    pub(crate) fn new(count: usize) -> Self {
        Self { parent: (0..to_u32(count)).collect() }
    }

    pub(crate) fn root(&mut self, mut item: usize) -> usize {
        while self.parent[item] as usize != item {
            let grandparent = self.parent[self.parent[item] as usize];
            self.parent[item] = grandparent;
            item = grandparent as usize;
        }
        item
    }

    pub(crate) fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b)] = to_u32(a.min(b));
    }
}

#[cfg(test)]
mod tests {
    use crate::build::{BuildOptions, build_edge_mesh};
    use crate::edge_mesh::FillMesh;
    use crate::model::Model;
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
        model.has_smoothing_groups = true;
        for polygon in &mut model.polygons {
            polygon.smoothing_group = 1;
        }
        assert_eq!(fill_of(&model).vertices.len(), 8);
    }

    #[test]
    fn the_files_normals_win_and_texture_seams_stay() {
        let mut model = Model::from_polygons(&CUBE, &SIDES);
        model.normals = vec![[0., 0., 2.]];
        model.texcoords = vec![[0., 0.], [1., 0.]];
        for (index, corner) in model.corners.iter_mut().enumerate() {
            corner.normal = 0;
            corner.texcoord = u32::from(index >= 12);
        }
        let fill = fill_of(&model);
        assert!(fill.vertices.iter().all(|vertex| vertex.normal == [0., 0., 1.]));
        assert!(fill.vertices.len() > 8, "a seam runs where the texture coordinates differ");
    }
}
