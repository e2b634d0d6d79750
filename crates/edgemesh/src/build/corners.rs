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

use super::FaceAttributes;
use super::components::Sets;
use super::faces::FaceSources;
use super::fans::angle;
use super::planes::{corners_of, has_area};
use crate::edge_mesh::{FacePlane, FillMesh, FillVertex};
use crate::index::{NONE, to_u32};
use crate::model::{Model, Smoothing};
use crate::record::{EdgeFlags, EdgeRecord};

/// What the fill is made from; all lists are by triangle.
#[derive(Debug)]
pub(crate) struct CornerInput<'a> {
    pub(crate) model: &'a Model,
    pub(crate) positions: &'a [[f32; 3]],
    pub(crate) triangles: &'a [[u32; 3]],
    pub(crate) sources: &'a FaceSources,
    /// Planes before any were lent.
    pub(crate) planes: &'a [FacePlane],
    pub(crate) records: &'a [EdgeRecord],
    pub(crate) attributes: &'a FaceAttributes,
    pub(crate) smoothing_angle_rad: f64,
    /// Whether anybody wants the fill at all.
    pub(crate) is_wanted: bool,
}

/// Builds the fill's vertices and indices; none where none are wanted.
pub(crate) fn build_fill(input: &CornerInput) -> FillMesh {
    if !input.is_wanted {
        return FillMesh::default();
    }
    let normals = smooth_normals(input);
    let mut fill = FillMesh::default();
    fill.indices.reserve(input.triangles.len() * 3);
    let mut index_of = FxHashMap::default();
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
    let sets = Sets::new(input.triangles.len() * 3);
    for record in input.records {
        if record.face_b == NONE || !is_smooth(input, record) {
            continue;
        }
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
    let corner_count = to_u32(input.triangles.len() * 3);
    let mut sums = vec![DVec3::ZERO; corner_count as usize];
    for corner in 0..corner_count {
        let plane = &input.planes[corner as usize / 3];
        if has_area(plane) {
            let [x, y, z, _] = plane.normal;
            let weight = f64::from(corner_angle(input, corner as usize));
            sums[sets.root(corner) as usize] += Vec3::new(x, y, z).as_dvec3() * weight;
        }
    }
    (0..corner_count)
        .map(|corner| sums[sets.root(corner) as usize].normalize_or_zero().as_vec3().to_array())
        .collect()
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
    if record.flags.contains(EdgeFlags::DIAGONAL) {
        return true;
    }
    if record.flags.intersects(EdgeFlags::NON_MANIFOLD | EdgeFlags::CLASH) {
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
    let [a, b] = [record.face_a, record.face_b].map(|face| &input.planes[face as usize]);
    let cosine: f32 = a.normal.iter().zip(b.normal).map(|(x, y)| x * y).sum();
    !has_area(a) || !has_area(b) || f64::from(cosine) >= limit.cos()
}

#[cfg(test)]
mod tests {
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
