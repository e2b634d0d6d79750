//! The edge mesh: what the preprocessor makes and the GPU draws.

use bytemuck::{Pod, Zeroable};
use glam::{DMat4, DVec3, Vec3};

use crate::edge_mesh::edge_flags::EdgeFlags;
use crate::edge_mesh::mesh_frame::MeshFrame;
use crate::edge_mesh::record::EdgeRecord;
use crate::edge_mesh::topology::EdgeCounts;
use crate::index::NONE;
use crate::model::Material;

/// A mesh with every undirected edge as a record.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct EdgeMesh {
    /// Where the mesh lies in its file.
    pub frame: MeshFrame,
    /// Welded positions; vertices that were split follow the others.
    pub positions: Vec<[f32; 3]>,
    /// The vertex that each of those was split from, in order; empty where none
    /// was.
    pub split_from: Vec<u32>,
    /// Normals of the vertices, weighted by angle, of unit length; zero
    /// where the faces cancel out.
    pub vertex_normals: Vec<[f32; 3]>,
    /// Welded triangles, winding repaired.
    pub triangles: Vec<[u32; 3]>,
    /// One a triangle: what decides whether it faces the eye.
    pub face_planes: Vec<FacePlane>,
    /// The edges, sorted by (min, max) welded vertex; behind them the lines that
    /// are no edge of a face.
    pub records: Vec<EdgeRecord>,
    /// The edges that no view changes, as polylines.
    pub chains: Chains,
    /// The same triangles with the corner attributes that shading needs; empty
    /// where none was asked for.
    pub fill: FillMesh,
    /// The box around all vertices that faces and lines use.
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

/// Polylines of edges that no view changes.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Chains {
    /// The polylines, in the order of their first records.
    pub chains: Vec<Chain>,
    /// The edges of all polylines, polyline by polyline.
    pub links: Vec<ChainLink>,
}

/// A polyline of edges of one class: 20 bytes.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Chain {
    /// Its first link in [`Chains::links`].
    pub first_link: u32,
    /// How many links it has.
    pub link_count: u32,
    /// Its length, in units of the mesh.
    pub length: f32,
    /// 1 where its end is its start, else 0.
    pub is_loop: u32,
    /// The one class that it is chained by.
    pub class: EdgeFlags,
}

impl Chain {
    /// The range of its links in [`Chains::links`].
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
    /// 1 where the polyline runs from the record's `v1` to its `v0`, else 0.
    pub is_reversed: u32,
}

/// Triangles for shading: vertices split where normals or texture coordinates
/// differ, and what the triangles look like.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FillMesh {
    /// The split vertices.
    pub vertices: Vec<FillVertex>,
    /// Three indices a triangle, in the order of [`EdgeMesh::triangles`].
    pub indices: Vec<u32>,
    /// What triangles share, in runs, ascending by first triangle; the first one
    /// starts at triangle 0 wherever there is a triangle.
    pub runs: Vec<FillRun>,
    /// The materials of the model, used or not.
    pub materials: Vec<Material>,
    /// Names of the model's groups, objects or nodes.
    pub groups: Vec<String>,
}

/// What triangles in a row share: 16 bytes. The next run ends this one, and
/// differs in something.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct FillRun {
    /// The first triangle, in the order of [`EdgeMesh::triangles`].
    pub first_triangle: u32,
    /// Index into [`FillMesh::materials`], or [`NONE`].
    pub material: u32,
    /// Index into [`FillMesh::groups`], or [`NONE`].
    pub group: u32,
    /// 1 where all corners have texture coordinates of the file, else 0.
    pub has_texcoords: u32,
}

impl FillRun {
    /// The run of triangles that nothing is known of.
    pub const PLAIN: Self =
        Self { first_triangle: 0, material: NONE, group: NONE, has_texcoords: 0 };
}

/// A vertex of the fill: 32 bytes.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct FillVertex {
    /// Position, in the units of the file.
    pub position: [f32; 3],
    /// Unit normal.
    pub normal: [f32; 3],
    /// Texture coordinate, (0, 0) at the lower left corner of a picture; (0, 0)
    /// where the file has none.
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

    /// The box around this one's corners, moved by `transform`.
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

    /// Half the diagonal.
    #[must_use]
    pub fn radius(&self) -> f64 {
        (Vec3::from(self.max).as_dvec3() - Vec3::from(self.min).as_dvec3()).length() / 2.0
    }
}

/// What a mesh consists of, counted before anything is repaired.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
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
#[non_exhaustive]
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

impl EdgeMesh {
    /// The vertex of `face` that is not on `record`'s edge; the edge's start
    /// where there is no face.
    #[must_use]
    pub(crate) fn apex(&self, face: u32, record: &EdgeRecord) -> u32 {
        if face == NONE {
            return record.v0;
        }
        let triangle = self.triangles[face as usize];
        let off_edge = |vertex: &u32| *vertex != record.v0 && *vertex != record.v1;
        triangle.into_iter().find(off_edge).unwrap_or(NONE)
    }

    /// The welded vertex that a vertex is, or was split from.
    #[must_use]
    pub fn welded_vertex(&self, vertex: u32) -> u32 {
        let first_split = self.positions.len() - self.split_from.len();
        match (vertex as usize).checked_sub(first_split) {
            Some(split) => self.split_from[split],
            None => vertex,
        }
    }

    /// The corners of the box around the mesh, in the units of its file; infinite
    /// and turned around where there are no vertices.
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

    /// A mesh that is moved to a frame is the one that is built in it.
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
