//! The triangles of a mesh as a surface to be shaded: normals, texture coordinates and colors
//! per corner, sorted into ranges of one material and group.
//!
//! Surface vertices begin with the welded vertices in their order; corners whose attributes
//! differ from the first ones at their vertex follow. So strokes and surfaces read the same
//! positions, and a pose writes each position once.

use std::ops::Range;

use edgemesh::edge_mesh::EdgeMesh;
use edgemesh::index::{NONE, to_u32};

/// Triangles of one material and group.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct MaterialRange {
    /// Range in the index buffer.
    pub indices: Range<u32>,
    /// Index of the material, or [`NONE`].
    pub material: u32,
    /// Index of the group, or [`NONE`].
    pub group: u32,
    /// Whether the model has texture coordinates for these triangles.
    pub has_texcoords: bool,
}

/// The buffers of a surface that are the same in all poses.
#[derive(Debug)]
#[non_exhaustive]
pub struct SurfaceBuffers {
    /// 8 bytes per vertex.
    pub texcoords: wgpu::Buffer,
    /// 4 bytes per vertex, red first, as storage; `None` if the mesh has no colors.
    pub colors: Option<wgpu::Buffer>,
    /// Three indices of 4 bytes per triangle.
    pub indices: wgpu::Buffer,
    /// All of `indices`, range by range.
    pub ranges: Vec<MaterialRange>,
}

/// The vertices and triangles of a surface in memory.
#[derive(Debug)]
pub(crate) struct SurfaceArrays {
    pub(crate) positions: Vec<[f32; 3]>,
    pub(crate) normals: Vec<[f32; 3]>,
    pub(crate) texcoords: Vec<[f32; 2]>,
    /// Empty if the mesh has no colors.
    pub(crate) colors: Vec<[u8; 4]>,
    pub(crate) indices: Vec<u32>,
    pub(crate) ranges: Vec<MaterialRange>,
}

impl SurfaceArrays {
    /// The surface of `mesh`; a mesh without a fill is shaded by its vertex normals.
    pub(crate) fn of(mesh: &EdgeMesh) -> Self {
        let mut arrays = Self {
            positions: mesh.positions.clone(),
            normals: Vec::new(),
            texcoords: Vec::new(),
            colors: Vec::new(),
            indices: Vec::new(),
            ranges: Vec::new(),
        };
        let indices = if mesh.fill.indices.is_empty() {
            arrays.normals.clone_from(&mesh.vertex_normals);
            arrays.texcoords = vec![[0.0; 2]; mesh.positions.len()];
            mesh.triangles.iter().flatten().copied().collect()
        } else {
            arrays.take_fill(mesh)
        };
        (arrays.ranges, arrays.indices) = sorted_by_material(mesh, indices);
        arrays
    }

    /// Takes the fill's vertices in an order that begins with the welded vertices; returns
    /// the fill's indices in that order.
    fn take_fill(&mut self, mesh: &EdgeMesh) -> Vec<u32> {
        let welded_count = mesh.positions.len();
        self.normals = vec![[0.0; 3]; welded_count];
        self.texcoords = vec![[0.0; 2]; welded_count];
        let mut colors = Vec::new();
        if !mesh.fill.colors.is_empty() {
            colors.resize(welded_count, [u8::MAX; 4]);
        }
        let mut is_taken = vec![false; welded_count];
        let mut places = vec![NONE; mesh.fill.vertices.len()];
        let corners = mesh.triangles.iter().flatten();
        for (&vertex, &welded) in mesh.fill.indices.iter().zip(corners) {
            if places[vertex as usize] != NONE {
                continue;
            }
            let corner = &mesh.fill.vertices[vertex as usize];
            let color = mesh.fill.colors.get(vertex as usize);
            if std::mem::replace(&mut is_taken[welded as usize], true) {
                places[vertex as usize] = to_u32(self.positions.len());
                self.positions.push(corner.position);
                self.normals.push(corner.normal);
                self.texcoords.push(corner.texcoord);
                colors.extend(color);
            } else {
                places[vertex as usize] = welded;
                self.normals[welded as usize] = corner.normal;
                self.texcoords[welded as usize] = corner.texcoord;
                if let Some(&color) = color {
                    colors[welded as usize] = color;
                }
            }
        }
        self.colors = colors;
        mesh.fill.indices.iter().map(|&vertex| places[vertex as usize]).collect()
    }
}

/// The material ranges of a mesh, and its indices in their order.
fn sorted_by_material(mesh: &EdgeMesh, indices: Vec<u32>) -> (Vec<MaterialRange>, Vec<u32>) {
    let runs = &mesh.fill.runs;
    let triangle_count = to_u32(indices.len() / 3);
    let range = |triangles: Range<u32>, material, group, has_texcoords| MaterialRange {
        indices: 3 * triangles.start..3 * triangles.end,
        material,
        group,
        has_texcoords,
    };
    match runs.as_slice() {
        [] => return (vec![range(0..triangle_count, NONE, NONE, false)], indices),
        [run] => {
            let has_texcoords = run.has_texcoords == 1;
            let whole = range(0..triangle_count, run.material, run.group, has_texcoords);
            return (vec![whole], indices);
        }
        _ => {}
    }
    // A stable sort keeps the order of the file within a range.
    let mut order: Vec<usize> = (0..runs.len()).collect();
    let key = |run: usize| (runs[run].material, runs[run].group, runs[run].has_texcoords);
    order.sort_by_key(|&run| key(run));
    let (mut ranges, mut sorted) = (Vec::<MaterialRange>::new(), Vec::with_capacity(indices.len()));
    for run in order {
        let end = runs.get(run + 1).map_or(triangle_count, |next| next.first_triangle);
        let start = to_u32(sorted.len());
        sorted.extend_from_slice(&indices[3 * runs[run].first_triangle as usize..3 * end as usize]);
        let (material, group, has_texcoords) = key(run);
        let is_same = |last: &MaterialRange| {
            (last.material, last.group, u32::from(last.has_texcoords)) == key(run)
        };
        let indices = start..to_u32(sorted.len());
        match ranges.last_mut().filter(|last| is_same(last)) {
            Some(last) => last.indices.end = indices.end,
            None => ranges.push(MaterialRange {
                indices,
                material,
                group,
                has_texcoords: has_texcoords == 1,
            }),
        }
    }
    (ranges, sorted)
}

#[cfg(test)]
mod tests {
    use edgemesh::build::{BuildOptions, build_edge_mesh};
    use edgemesh::model::Model;
    use edgemesh::report::Report;

    use super::*;

    /// A cube: three different normals at each vertex.
    fn cube() -> EdgeMesh {
        let at =
            |index: u8| [0, 1, 2].map(|axis| if index >> axis & 1 == 0 { -1.0_f32 } else { 1.0 });
        let corners: Vec<[f32; 3]> = (0..8).map(at).collect();
        let faces: [&[u32]; 6] = [
            &[0, 2, 3, 1],
            &[4, 5, 7, 6],
            &[0, 1, 5, 4],
            &[2, 6, 7, 3],
            &[0, 4, 6, 2],
            &[1, 3, 7, 5],
        ];
        let mut model = Model::from_polygons(&corners, &faces);
        // A red side, a green one and so on: three colors at each vertex, with as many normals.
        model.colors = (0..6_u8).map(|side| [f32::from(side) / 5.0, 0.2, 1.0, 0.4]).collect();
        model.corner_colors = (0..24).map(|corner| corner / 4).collect();
        build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default())
    }

    #[test]
    fn welded_vertices_come_first_and_every_corner_keeps_its_attributes() {
        let mesh = cube();
        let arrays = SurfaceArrays::of(&mesh);
        assert_eq!(arrays.positions[..8], mesh.positions);
        assert_eq!(arrays.positions.len(), 24, "three normals at each of eight vertices");
        assert_eq!(arrays.indices.len(), mesh.fill.indices.len());
        for (&place, &vertex) in arrays.indices.iter().zip(&mesh.fill.indices) {
            let (place, wanted) = (place as usize, &mesh.fill.vertices[vertex as usize]);
            assert_eq!(arrays.positions[place], wanted.position);
            assert_eq!(arrays.normals[place], wanted.normal);
            assert_eq!(arrays.texcoords[place], wanted.texcoord);
            assert_eq!(arrays.colors[place], mesh.fill.colors[vertex as usize]);
        }
        assert_eq!(arrays.colors.len(), 24);
        let colors = |corner: usize| arrays.colors[arrays.indices[corner] as usize];
        assert_eq!([colors(0), colors(35)], [[0, 51, 255, 102], [255, 51, 255, 102]]);
    }

    #[test]
    fn without_a_fill_the_surface_is_smooth() {
        let mesh = EdgeMesh { fill: Default::default(), ..cube() };
        let arrays = SurfaceArrays::of(&mesh);
        assert_eq!(arrays.normals, mesh.vertex_normals);
        let indices: Vec<u32> = mesh.triangles.iter().flatten().copied().collect();
        assert_eq!(arrays.indices, indices);
        assert_eq!(arrays.ranges.len(), 1);
    }
}
