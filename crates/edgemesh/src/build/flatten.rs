//! Copies instanced meshes into one mesh.
//!
//! ```text
//! vertices   welded of all parts | split of all parts
//! records    edges of all parts  | lines without a face of all parts
//! ```
//!
//! A mirrored copy has its triangles reversed, so that they look outward, and its records
//! exchange their ends, so that face A stays on their left.

use glam::{DMat3, DMat4, DVec3};

use super::chains::{DEFAULT_CHAIN_TURN_RAD, chain};
use crate::edge_mesh::{
    Bounds, EdgeMesh, EdgeRecord, FacePlane, FillMesh, FillRun, FillVertex, InstancedMesh,
    counts_with,
};
use crate::index::{MAX_INDEX, NONE, to_u32};
use crate::model::Material;

/// The most vertices and corners that copies may add: those of 3 GiB of positions, more than any
/// mesh that is drawn at once.
const MAX_COPIED_ELEMENTS: usize = 1 << 27;

/// The vertices and corners of a mesh with its instances are too many for one mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct TooManyCopies {
    /// Vertices and corners of all copies.
    pub(crate) elements: usize,
    pub(crate) limit: usize,
}

/// A mesh with copies of all instances, and for each of its vertices the vertex of `vertices`,
/// whose first list is that of `mesh`, the others those of `instanced`.
///
/// # Errors
/// Fails, before anything is copied, if the copies are too many.
pub(crate) fn flattened(
    mesh: &EdgeMesh,
    instanced: &[InstancedMesh],
    vertices: &[Vec<u32>],
) -> Result<(EdgeMesh, Vec<u32>), TooManyCopies> {
    check_size(mesh, instanced)?;
    let parts = parts(mesh, instanced);
    let mut flat = EdgeMesh { frame: mesh.frame, ..EdgeMesh::default() };
    let mut flat_vertices = Vec::new();
    for is_split in [false, true] {
        for part in &parts {
            let range = part.vertices(is_split);
            let own = vertices.get(part.list).and_then(|list| list.get(range.clone()));
            flat_vertices.extend(own.into_iter().flatten());
            part.copy_vertices(range, &mut flat);
        }
    }
    let mut lines = Vec::new();
    let mut materials = Materials::default();
    for part in &parts {
        part.copy_faces(&mut flat);
        part.copy_records(&mut flat.records, &mut lines);
        part.copy_fill(&mut flat.fill, &mut materials);
    }
    flat.records.append(&mut lines);
    flat.fill.materials = materials.all;
    flat.bounds = Bounds::of(&flat.positions);
    flat.counts = counts_with(mesh, instanced);
    flat.chains = chain(&flat.positions, &flat.records, DEFAULT_CHAIN_TURN_RAD);
    Ok((flat, flat_vertices))
}

fn check_size(mesh: &EdgeMesh, instanced: &[InstancedMesh]) -> Result<(), TooManyCopies> {
    let size = |mesh: &EdgeMesh| mesh.positions.len() + 3 * mesh.triangles.len();
    let copies = instanced.iter().fold(0_usize, |sum, instanced| {
        sum.saturating_add(size(&instanced.mesh).saturating_mul(instanced.placements.len()))
    });
    let (own, elements) = (size(mesh), size(mesh).saturating_add(copies));
    let limit = own.saturating_add(MAX_COPIED_ELEMENTS).min(MAX_INDEX);
    if elements > limit { Err(TooManyCopies { elements, limit }) } else { Ok(()) }
}

/// A mesh in one place of the flat mesh.
struct Part<'a> {
    mesh: &'a EdgeMesh,
    place: DMat4,
    /// The transform of normals.
    normals: DMat3,
    is_mirrored: bool,
    /// The number of its mesh.
    list: usize,
    first_welded: usize,
    first_split: usize,
    first_face: usize,
}

/// All parts, with their places in the lists of the flat mesh.
fn parts<'a>(mesh: &'a EdgeMesh, instanced: &'a [InstancedMesh]) -> Vec<Part<'a>> {
    let own = std::iter::once((0, mesh, DMat4::IDENTITY));
    let places = (1..).zip(instanced).flat_map(|(list, InstancedMesh { mesh, placements })| {
        placements.iter().map(move |&place| (list, mesh, place))
    });
    let (mut welded, mut split, mut faces) = (0, 0, 0);
    let mut parts = Vec::new();
    for (list, mesh, place) in own.chain(places) {
        let linear = DMat3::from_mat4(place);
        parts.push(Part {
            mesh,
            place,
            normals: linear.inverse().transpose(),
            is_mirrored: linear.determinant() < 0.0,
            list,
            first_welded: welded,
            first_split: split,
            first_face: faces,
        });
        welded += mesh.positions.len() - mesh.split_from.len();
        split += mesh.split_from.len();
        faces += mesh.triangles.len();
    }
    for part in &mut parts {
        part.first_split += welded;
    }
    parts
}

impl Part<'_> {
    const fn welded_count(&self) -> usize {
        self.mesh.positions.len() - self.mesh.split_from.len()
    }

    /// The welded or the split vertices.
    const fn vertices(&self, is_split: bool) -> std::ops::Range<usize> {
        let welded = self.welded_count();
        if is_split { welded..self.mesh.positions.len() } else { 0..welded }
    }

    /// A vertex of the mesh in the flat mesh.
    fn vertex(&self, vertex: u32) -> u32 {
        let vertex = vertex as usize;
        to_u32(match vertex.checked_sub(self.welded_count()) {
            Some(split) => self.first_split + split,
            None => self.first_welded + vertex,
        })
    }

    fn face(&self, face: u32) -> u32 {
        if face == NONE { NONE } else { to_u32(self.first_face) + face }
    }

    fn position(&self, position: [f32; 3]) -> [f32; 3] {
        if self.place == DMat4::IDENTITY {
            return position;
        }
        self.place.transform_point3(DVec3::from(position.map(f64::from))).as_vec3().to_array()
    }

    fn normal(&self, normal: [f32; 3]) -> [f32; 3] {
        if self.place == DMat4::IDENTITY {
            return normal;
        }
        let moved = self.normals * DVec3::from(normal.map(f64::from));
        moved.normalize_or_zero().as_vec3().to_array()
    }

    /// A triangle in its winding in this place.
    const fn wound<T: Copy>(&self, [a, b, c]: [T; 3]) -> [T; 3] {
        if self.is_mirrored { [a, c, b] } else { [a, b, c] }
    }

    /// Copies a range of vertices.
    fn copy_vertices(&self, range: std::ops::Range<usize>, flat: &mut EdgeMesh) {
        let mesh = self.mesh;
        let positions = mesh.positions[range.clone()].iter();
        flat.positions.extend(positions.map(|&position| self.position(position)));
        let normals = mesh.vertex_normals[range.clone()].iter();
        flat.vertex_normals.extend(normals.map(|&normal| self.normal(normal)));
        if range.start == self.welded_count() {
            flat.split_from.extend(mesh.split_from.iter().map(|&vertex| self.vertex(vertex)));
        }
    }

    fn copy_faces(&self, flat: &mut EdgeMesh) {
        let triangles = self.mesh.triangles.iter();
        let vertices = |&triangle: &[u32; 3]| self.wound(triangle).map(|at| self.vertex(at));
        flat.triangles.extend(triangles.map(vertices));
        let plane = |&FacePlane { normal: [nx, ny, nz, nw], point: [x, y, z, w] }: &FacePlane| {
            let ([nx, ny, nz], [x, y, z]) = (self.normal([nx, ny, nz]), self.position([x, y, z]));
            FacePlane { normal: [nx, ny, nz, nw], point: [x, y, z, w] }
        };
        flat.face_planes.extend(self.mesh.face_planes.iter().map(plane));
    }

    /// Copies the records of edges, and those of lines without a face.
    fn copy_records(&self, edges: &mut Vec<EdgeRecord>, lines: &mut Vec<EdgeRecord>) {
        for record in &self.mesh.records {
            let is_line = record.face_a == NONE;
            let [v0, v1] = [record.v0, record.v1].map(|vertex| self.vertex(vertex));
            let [v0, v1] = if self.is_mirrored && !is_line { [v1, v0] } else { [v0, v1] };
            let [face_a, face_b] = [record.face_a, record.face_b].map(|face| self.face(face));
            let copy = EdgeRecord { v0, v1, face_a, face_b, word: record.word };
            if is_line { lines.push(copy) } else { edges.push(copy) }
        }
    }

    fn copy_fill(&self, flat: &mut FillMesh, materials: &mut Materials) {
        let fill = &self.mesh.fill;
        let (first_vertex, first_group) = (to_u32(flat.vertices.len()), to_u32(flat.groups.len()));
        let vertex = |vertex: &FillVertex| FillVertex {
            position: self.position(vertex.position),
            normal: self.normal(vertex.normal),
            texcoord: vertex.texcoord,
        };
        flat.vertices.extend(fill.vertices.iter().map(vertex));
        if !fill.colors.is_empty() {
            flat.colors.resize(first_vertex as usize, [u8::MAX; 4]);
            flat.colors.extend(&fill.colors);
        }
        if !flat.colors.is_empty() {
            flat.colors.resize(flat.vertices.len(), [u8::MAX; 4]);
        }
        let triangles = fill.indices.as_chunks().0.iter();
        let corners = triangles.flat_map(|&triangle| self.wound(triangle));
        flat.indices.extend(corners.map(|corner| first_vertex + corner));
        let numbers = materials.numbers(self.list, &fill.materials);
        flat.runs.extend(fill.runs.iter().map(|run| FillRun {
            first_triangle: to_u32(self.first_face) + run.first_triangle,
            material: numbers.get(run.material as usize).copied().unwrap_or(NONE),
            group: if run.group == NONE { NONE } else { first_group + run.group },
            has_texcoords: run.has_texcoords,
        }));
        flat.groups.extend(fill.groups.iter().cloned());
    }
}

/// The materials of all parts, equal ones once.
#[derive(Default)]
struct Materials {
    all: Vec<Material>,
    /// The numbers of the materials of the last mesh, with the number of the mesh.
    last: Option<(usize, Vec<u32>)>,
}

impl Materials {
    fn numbers(&mut self, list: usize, materials: &[Material]) -> &[u32] {
        if self.last.as_ref().is_none_or(|(last, _)| *last != list) {
            let numbers = materials.iter().map(|material| self.number(material)).collect();
            self.last = Some((list, numbers));
        }
        self.last.as_ref().map_or(&[], |(_, numbers)| numbers)
    }

    fn number(&mut self, material: &Material) -> u32 {
        let known = self.all.iter().position(|known| known == material);
        to_u32(known.unwrap_or_else(|| {
            self.all.push(material.clone());
            self.all.len() - 1
        }))
    }
}
