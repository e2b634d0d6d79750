//! The edge mesh: what the preprocessor makes and the GPU draws.

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};

use crate::index::NONE;
use crate::record::{EdgeRecord, EdgeVertex};
use crate::topology::EdgeCounts;

/// A mesh with every undirected edge as a record.
#[derive(Debug, Clone, Default)]
pub struct EdgeMesh {
    /// Welded positions.
    pub positions: Vec<[f32; 3]>,
    /// Normals of the welded vertices, weighted by angle, of unit length; zero
    /// where the faces cancel out.
    pub vertex_normals: Vec<[f32; 3]>,
    /// Welded triangles, winding repaired.
    pub triangles: Vec<[u32; 3]>,
    /// One a triangle: what decides whether it faces the eye.
    pub face_planes: Vec<FacePlane>,
    /// The edges, sorted by (min, max) vertex.
    pub records: Vec<EdgeRecord>,
    /// The same triangles with the corner attributes that shading needs.
    pub fill: FillMesh,
    /// The box around all vertices that faces use.
    pub bounds: Bounds,
    /// Counts from before any repair.
    pub counts: MeshCounts,
}

/// A face's unit normal and a point on it. WGSL twin: `FacePlane` in
/// `shaders/common/mesh.wgsl`.
///
/// Normal and point rather than a plane's four coefficients: `n . (eye - p)`
/// keeps its sign where `n . eye + d` cancels out.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct FacePlane {
    /// Unit normal; w is 0.
    pub normal: [f32; 4],
    /// The first vertex of the face; w is 1.
    pub point: [f32; 4],
}

/// Triangles for shading: vertices split where normals or texture coordinates
/// differ.
#[derive(Debug, Clone, Default)]
pub struct FillMesh {
    /// The split vertices.
    pub vertices: Vec<FillVertex>,
    /// Three indices a triangle, in the order of [`EdgeMesh::triangles`].
    pub indices: Vec<u32>,
}

/// A vertex of the fill: 32 bytes.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct FillVertex {
    /// Position, in the units of the file.
    pub position: [f32; 3],
    /// Unit normal.
    pub normal: [f32; 3],
    /// Texture coordinate; (0, 0) where the file has none.
    pub texcoord: [f32; 2],
}

/// A box along the axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Lower corner.
    pub min: [f32; 3],
    /// Upper corner.
    pub max: [f32; 3],
}

impl Default for Bounds {
    /// The box of nothing at all, a point at the origin.
    fn default() -> Self {
        Self { min: [0.0; 3], max: [0.0; 3] }
    }
}

impl Bounds {
    /// The box around `positions`; a point at the origin if there are none.
    #[must_use]
    pub fn of(positions: &[[f32; 3]]) -> Self {
        let Some(&first) = positions.first() else { return Self::default() };
        positions.iter().fold(Self { min: first, max: first }, |bounds, &position| {
            bounds.union(&Self { min: position, max: position })
        })
    }

    /// The box around both.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self {
            min: Vec3::from(self.min).min(other.min.into()).into(),
            max: Vec3::from(self.max).max(other.max.into()).into(),
        }
    }

    /// The middle of the box.
    #[must_use]
    pub fn center(&self) -> DVec3 {
        (Vec3::from(self.min).as_dvec3() + Vec3::from(self.max).as_dvec3()) / 2.0
    }

    /// Half the diagonal.
    #[must_use]
    pub fn radius(&self) -> f64 {
        (Vec3::from(self.max).as_dvec3() - Vec3::from(self.min).as_dvec3()).length() / 2.0
    }
}

/// What a mesh consists of, counted before anything is repaired.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct MeshCounts {
    /// Vertices listed in the file.
    pub vertices: usize,
    /// Different positions that faces use.
    pub welded_vertices: usize,
    /// Triangles with three different welded vertices.
    pub triangles: usize,
    /// Triangles (and faces of fewer than three corners) that were dropped.
    pub degenerate_triangles: usize,
    /// Triangles that repeat another.
    pub duplicate_triangles: usize,
    /// Edges of `triangles`, polygon diagonals included.
    pub edges: EdgeCounts,
    /// Edges that are nothing but a polygon's diagonal.
    pub diagonal_edges: usize,
    /// Sets of faces connected by edges.
    pub components: usize,
    /// The file's own polygons, before any welding.
    pub source: SourceCounts,
}

/// Counts over the polygons as the file lists them.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct SourceCounts {
    /// Vertices listed.
    pub vertices: usize,
    /// Polygons kept.
    pub polygons: usize,
    /// Triangles that a fan makes of them.
    pub triangles: usize,
    /// Edges of the polygons; there are no diagonals among them.
    pub edges: EdgeCounts,
}

/// Bytes that the edge mesh takes in each layout.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LayoutBytes {
    /// Positions, normals, triangles and 20 bytes an edge record.
    pub indexed: usize,
    /// Four edge vertices of 80 bytes an edge.
    pub replicated_f32: usize,
    /// Four edge vertices of 37 bytes, padded to 40, an edge.
    pub replicated_i16: usize,
}

impl EdgeMesh {
    /// The vertex of `face` that is not on `record`'s edge.
    #[must_use]
    pub fn apex(&self, face: u32, record: &EdgeRecord) -> u32 {
        let triangle = self.triangles[face as usize];
        let off_edge = |vertex: &u32| *vertex != record.v0 && *vertex != record.v1;
        triangle.into_iter().find(off_edge).unwrap_or(NONE)
    }

    /// Sizes of the layouts.
    #[must_use]
    pub fn layout_bytes(&self) -> LayoutBytes {
        let edges = self.records.len();
        LayoutBytes {
            indexed: size_of_val(&*self.positions)
                + size_of_val(&*self.vertex_normals)
                + size_of_val(&*self.triangles)
                + size_of_val(&*self.records),
            replicated_f32: edges * 4 * size_of::<EdgeVertex>(),
            replicated_i16: edges * 4 * 40,
        }
    }
}
