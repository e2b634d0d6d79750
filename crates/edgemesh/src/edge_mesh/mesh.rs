//! The edge mesh, which the builder makes and the GPU draws.

use bytemuck::{Pod, Zeroable};
use glam::{DMat4, DVec3, Vec3};

use crate::edge_mesh::edge_flags::EdgeFlags;
use crate::edge_mesh::mesh_frame::MeshFrame;
use crate::edge_mesh::record::EdgeRecord;
use crate::edge_mesh::topology::EdgeCounts;
use crate::index::NONE;
use crate::model::Material;

/// A mesh with a record for every undirected edge.
///
/// Lists refer to each other by index. Functions of this crate panic on a mesh with an index out of
/// range; meshes that are built or read have none.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct EdgeMesh {
    /// The origin and scale of the mesh in its file.
    pub frame: MeshFrame,
    /// Welded positions, followed by those of split vertices.
    pub positions: Vec<[f32; 3]>,
    /// For each split vertex, the vertex that it was split from.
    pub split_from: Vec<u32>,
    /// Unit normals of the vertices, weighted by angle; zero if the faces cancel out.
    pub vertex_normals: Vec<[f32; 3]>,
    /// Welded triangles with repaired winding.
    pub triangles: Vec<[u32; 3]>,
    /// A plane for each triangle, which decides whether it faces the eye.
    pub face_planes: Vec<FacePlane>,
    /// The edges, sorted by (min, max) welded vertex, followed by lines without faces.
    pub records: Vec<EdgeRecord>,
    /// The edges that every view draws, as polylines.
    pub chains: Chains,
    /// The triangles with the corner attributes that shading needs; empty unless it was built.
    pub fill: FillMesh,
    /// The bounds of all vertices that faces and lines use.
    pub bounds: Bounds,
    /// Counts before repairs.
    pub counts: MeshCounts,
}

/// The unit normal of a face and a point on it: 32 bytes. WGSL twin: `FacePlane` in
/// `shaders/common/mesh.wgsl`.
///
/// Not the four coefficients of a plane, because `n . (eye - p)` keeps its sign where
/// `n . eye + d` cancels out.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct FacePlane {
    /// Unit normal; w is 0.
    pub normal: [f32; 4],
    /// The first vertex of the face; w is 1.
    pub point: [f32; 4],
}

/// Polylines of edges that every view draws.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Chains {
    /// The polylines, in the order of their first records.
    pub chains: Vec<Chain>,
    /// The edges of all polylines, one polyline after the other.
    pub links: Vec<ChainLink>,
}

/// A polyline of edges of one class: 20 bytes.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Chain {
    /// The first link in [`Chains::links`].
    pub first_link: u32,
    /// The number of links.
    pub link_count: u32,
    /// The length, in units of the mesh.
    pub length: f32,
    /// 1 if the polyline is closed, otherwise 0.
    pub is_loop: u32,
    /// The class of all its edges: one of [`CHAIN_CLASSES`](crate::edge_mesh::CHAIN_CLASSES).
    pub class: EdgeFlags,
}

impl Chain {
    /// The range of the links in [`Chains::links`].
    #[must_use]
    pub const fn link_range(&self) -> std::ops::Range<usize> {
        self.first_link as usize..(self.first_link + self.link_count) as usize
    }
}

/// An edge of a polyline: 16 bytes.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct ChainLink {
    /// Index into [`EdgeMesh::records`].
    pub record: u32,
    /// Index into [`Chains::chains`].
    pub chain: u32,
    /// The length of the polyline before this edge, in units of the mesh.
    pub arc_start: f32,
    /// 1 if the polyline runs from `v1` of the record to `v0`, otherwise 0.
    pub is_reversed: u32,
}

/// Triangles for shading, with vertices split where normals, texture coordinates or colors differ,
/// and their materials.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FillMesh {
    /// The split vertices.
    pub vertices: Vec<FillVertex>,
    /// Red, green, blue and opacity of each of `vertices`: display values, coded as sRGB, which
    /// are multiplied by those of the material. Empty if the model has no colors.
    pub colors: Vec<[u8; 4]>,
    /// Three indices for each triangle, in the order of [`EdgeMesh::triangles`].
    pub indices: Vec<u32>,
    /// Material ranges, ascending by first triangle; the first range begins at triangle 0.
    pub runs: Vec<FillRun>,
    /// The materials of the model, used or not.
    pub materials: Vec<Material>,
    /// Names of the groups, objects or nodes of the model.
    pub groups: Vec<String>,
}

/// A material range: successive triangles of one material and group, 16 bytes. It ends where the
/// next range begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct FillRun {
    /// The first triangle, in the order of [`EdgeMesh::triangles`].
    pub first_triangle: u32,
    /// Index into [`FillMesh::materials`], or [`NONE`].
    pub material: u32,
    /// Index into [`FillMesh::groups`], or [`NONE`].
    pub group: u32,
    /// 1 if all corners have texture coordinates in the file, otherwise 0.
    pub has_texcoords: u32,
}

impl FillRun {
    /// The range of triangles without attributes.
    pub const PLAIN: Self =
        Self { first_triangle: 0, material: NONE, group: NONE, has_texcoords: 0 };
}

/// A vertex of the fill: 32 bytes.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct FillVertex {
    /// Position, in units of the mesh.
    pub position: [f32; 3],
    /// Unit normal.
    pub normal: [f32; 3],
    /// Texture coordinate; (0, 0) is the lower left corner of a picture, and the value of corners
    /// without one.
    pub texcoord: [f32; 2],
}

/// A box along the axes, in units of the mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Lower corner.
    pub min: [f32; 3],
    /// Upper corner.
    pub max: [f32; 3],
}

impl Default for Bounds {
    /// A point at the origin.
    fn default() -> Self {
        Self { min: [0.0; 3], max: [0.0; 3] }
    }
}

impl Bounds {
    /// The box around `positions`; without any, a point at the origin.
    #[must_use]
    pub fn of(positions: &[[f32; 3]]) -> Self {
        let Some(&first) = positions.first() else { return Self::default() };
        positions.iter().fold(Self { min: first, max: first }, |bounds, &position| {
            bounds.union(&Self { min: position, max: position })
        })
    }

    /// The box around both boxes.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self {
            min: Vec3::from(self.min).min(other.min.into()).into(),
            max: Vec3::from(self.max).max(other.max.into()).into(),
        }
    }

    /// The box around the corners of this box, moved by `transform`.
    #[must_use]
    pub fn transformed(&self, transform: &DMat4) -> Self {
        if *transform == DMat4::IDENTITY {
            return *self;
        }
        let [low, high] = [self.min, self.max].map(|corner| Vec3::from(corner).as_dvec3());
        let corners: Vec<[f32; 3]> = (0..8)
            .map(|corner| {
                let pick =
                    |axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
                let corner = DVec3::new(pick(0), pick(1), pick(2));
                transform.transform_point3(corner).as_vec3().to_array()
            })
            .collect();
        Self::of(&corners)
    }

    /// The middle of the box.
    #[must_use]
    pub fn center(&self) -> DVec3 {
        (Vec3::from(self.min).as_dvec3() + Vec3::from(self.max).as_dvec3()) / 2.0
    }

    /// Half the length of the diagonal: the radius of the bounding sphere.
    #[must_use]
    pub fn radius(&self) -> f64 {
        (Vec3::from(self.max).as_dvec3() - Vec3::from(self.min).as_dvec3()).length() / 2.0
    }
}

/// Counts of a mesh before repairs.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct MeshCounts {
    /// Vertices in the file.
    pub vertices: usize,
    /// Different positions that faces use.
    pub welded_vertices: usize,
    /// Triangles with three different welded vertices.
    pub triangles: usize,
    /// Dropped triangles without three different welded vertices, and faces of fewer corners.
    pub degenerate_triangles: usize,
    /// Triangles that repeat another triangle.
    pub duplicate_triangles: usize,
    /// Edges of `triangles`, with the diagonals of polygons.
    pub edges: EdgeCounts,
    /// Edges that are only diagonals of polygons.
    pub diagonal_edges: usize,
    /// Components: sets of faces connected by edges.
    pub components: usize,
    /// Counts of the polygons of the file, before welding.
    pub source: SourceCounts,
}

/// Counts of the polygons of a file, before welding.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct SourceCounts {
    /// Vertices in the file.
    pub vertices: usize,
    /// Polygons of three corners or more.
    pub polygons: usize,
    /// Triangles in fans of these polygons.
    pub triangles: usize,
    /// Edges of the polygons, without diagonals.
    pub edges: EdgeCounts,
}

impl MeshCounts {
    /// Adds the counts of a mesh that is drawn several times.
    pub(crate) fn add(&mut self, other: &Self, times: usize) {
        let add = |sum: &mut usize, count: usize| {
            *sum = sum.saturating_add(count.saturating_mul(times));
        };
        add(&mut self.vertices, other.vertices);
        add(&mut self.welded_vertices, other.welded_vertices);
        add(&mut self.triangles, other.triangles);
        add(&mut self.degenerate_triangles, other.degenerate_triangles);
        add(&mut self.duplicate_triangles, other.duplicate_triangles);
        add(&mut self.diagonal_edges, other.diagonal_edges);
        add(&mut self.components, other.components);
        add(&mut self.source.vertices, other.source.vertices);
        add(&mut self.source.polygons, other.source.polygons);
        add(&mut self.source.triangles, other.source.triangles);
        let edges = [(&mut self.edges, other.edges), (&mut self.source.edges, other.source.edges)];
        for (sum, own) in edges {
            add(&mut sum.edges, own.edges);
            add(&mut sum.boundary, own.boundary);
            add(&mut sum.non_manifold, own.non_manifold);
            add(&mut sum.inconsistent, own.inconsistent);
        }
    }
}

impl EdgeMesh {
    /// The vertex of `face` off the edge of `record`; without a face, the start of the edge.
    #[must_use]
    pub(crate) fn apex(&self, face: u32, record: &EdgeRecord) -> u32 {
        if face == NONE {
            return record.v0;
        }
        let triangle = self.triangles[face as usize];
        let off_edge = |vertex: &u32| *vertex != record.v0 && *vertex != record.v1;
        triangle.into_iter().find(off_edge).unwrap_or(NONE)
    }

    /// The welded vertex of a vertex: the one that it was split from, or itself.
    #[must_use]
    pub fn welded_vertex(&self, vertex: u32) -> u32 {
        let first_split = self.positions.len() - self.split_from.len();
        match (vertex as usize).checked_sub(first_split) {
            Some(split) => self.split_from[split],
            None => vertex,
        }
    }

    /// The corners of the bounds in units of the file; without vertices, infinite with the lower
    /// corner above the upper one.
    #[must_use]
    pub(crate) fn box_in_file(&self) -> (DVec3, DVec3) {
        if self.positions.is_empty() {
            return (DVec3::INFINITY, DVec3::NEG_INFINITY);
        }
        let corner = |corner: [f32; 3]| self.frame.to_file(Vec3::from(corner).as_dvec3());
        (corner(self.bounds.min), corner(self.bounds.max))
    }

    /// Moves the mesh to another frame, at the same place in the file.
    pub(crate) fn set_frame(&mut self, frame: MeshFrame) {
        if frame == self.frame {
            return;
        }
        let old = std::mem::replace(&mut self.frame, frame);
        let moved = |[x, y, z]: [f32; 3]| {
            let in_file = old.to_file(DVec3::new(x.into(), y.into(), z.into()));
            frame.to_mesh(in_file).as_vec3().to_array()
        };
        for position in &mut self.positions {
            *position = moved(*position);
        }
        for plane in &mut self.face_planes {
            let [x, y, z, w] = plane.point;
            let [x, y, z] = moved([x, y, z]);
            plane.point = [x, y, z, w];
        }
        for vertex in &mut self.fill.vertices {
            vertex.position = moved(vertex.position);
        }
        self.bounds = Bounds::of(&self.positions);
        #[expect(clippy::cast_possible_truncation, reason = "lengths are in 32 bits")]
        let scaled = |length: f32| (f64::from(length) * (frame.scale / old.scale)) as f32;
        for chain in &mut self.chains.chains {
            chain.length = scaled(chain.length);
        }
        for link in &mut self.chains.links {
            link.arc_start = scaled(link.arc_start);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::{BuildOptions, build_edge_mesh};
    use crate::model::Model;
    use crate::report::Report;

    /// A mesh moved to a frame equals the mesh built in it.
    #[test]
    fn a_mesh_in_another_frame_is_at_the_same_place() {
        let near = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.5]];
        let mut model = Model::from_polygons(&near, &[&[0, 1, 2], &[1, 3, 2]]);
        for position in &mut model.positions {
            position[0] += 4_500_000.0;
        }
        let build = |frame| {
            let options = BuildOptions { frame, ..BuildOptions::default() };
            build_edge_mesh(&model, &options, &mut Report::default())
        };
        let frame = MeshFrame { origin: DVec3::new(4_499_998.0, 1.0, 0.0), scale: 0.5 };
        let (mut moved, built) = (build(None), build(Some(frame)));
        assert!(!moved.frame.is_identity() && moved.positions != built.positions);
        moved.set_frame(frame);
        assert_eq!(moved, built);
        assert_eq!(moved.box_in_file().0, DVec3::new(4_500_000.0, 0.0, 0.0));
    }
}
