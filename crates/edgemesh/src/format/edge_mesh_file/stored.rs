//! The content of an edge mesh file, as lists that may be views of its bytes.
//!
//! The writer makes one that borrows from an [`EdgeMesh`], the reader one that borrows
//! from bytes. So both can run the same checks.

use std::borrow::Cow;

use super::layout::Layout;
use crate::edge_mesh::{
    Bounds, Chain, ChainLink, Chains, EdgeMesh, EdgeRecord, EdgeVertex, EdgeVertex16, FacePlane,
    FillMesh, FillRun, FillVertex, InstancedMesh, MeshCounts, MeshFrame,
};
use crate::model::Material;
use crate::report::Report;

/// The content of an edge mesh file, with all indices in range.
///
/// On a little-endian machine, aligned lists are views of the file's bytes. Other lists,
/// materials and groups are copies.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct StoredMesh<'a> {
    /// The name of the model in messages: the path it was read from.
    pub name: Cow<'a, str>,
    /// As [`EdgeMesh::frame`].
    pub frame: MeshFrame,
    /// As [`EdgeMesh::positions`].
    pub positions: Cow<'a, [[f32; 3]]>,
    /// As [`EdgeMesh::split_from`].
    pub split_from: Cow<'a, [u32]>,
    /// As [`EdgeMesh::vertex_normals`].
    pub vertex_normals: Cow<'a, [[f32; 3]]>,
    /// As [`EdgeMesh::triangles`].
    pub triangles: Cow<'a, [[u32; 3]]>,
    /// As [`EdgeMesh::face_planes`].
    pub face_planes: Cow<'a, [FacePlane]>,
    /// As [`EdgeMesh::records`].
    pub records: Cow<'a, [EdgeRecord]>,
    /// As [`Chains::chains`].
    pub chains: Cow<'a, [Chain]>,
    /// As [`Chains::links`].
    pub links: Cow<'a, [ChainLink]>,
    /// As [`FillMesh::vertices`].
    pub fill_vertices: Cow<'a, [FillVertex]>,
    /// As [`FillMesh::colors`].
    pub fill_colors: Cow<'a, [[u8; 4]]>,
    /// As [`FillMesh::indices`].
    pub fill_indices: Cow<'a, [u32]>,
    /// As [`FillMesh::runs`].
    pub fill_runs: Cow<'a, [FillRun]>,
    /// As [`FillMesh::materials`], with all pictures in memory.
    pub materials: Cow<'a, [Material]>,
    /// As [`FillMesh::groups`].
    pub groups: Cow<'a, [String]>,
    /// As [`EdgeMesh::bounds`].
    pub bounds: Bounds,
    /// As [`EdgeMesh::counts`].
    pub counts: MeshCounts,
    /// The result of [`replicate`](crate::edge_mesh::replicate), if it is in
    /// the file.
    pub replicated_f32: Option<Cow<'a, [EdgeVertex]>>,
    /// The result of [`replicate_16`](crate::edge_mesh::replicate_16), if it is
    /// in the file.
    pub replicated_i16: Option<Cow<'a, [EdgeVertex16]>>,
    /// Meshes that the model has in several places, as copies.
    pub instanced: Vec<InstancedMesh>,
    pub(super) report: Cow<'a, Report>,
}

impl<'a> StoredMesh<'a> {
    /// A view of a mesh, in the indexed layout only.
    pub(super) const fn of(mesh: &'a EdgeMesh, name: &'a str, report: &'a Report) -> Self {
        Self {
            name: Cow::Borrowed(name),
            frame: mesh.frame,
            positions: borrowed(&mesh.positions),
            split_from: borrowed(&mesh.split_from),
            vertex_normals: borrowed(&mesh.vertex_normals),
            triangles: borrowed(&mesh.triangles),
            face_planes: borrowed(&mesh.face_planes),
            records: borrowed(&mesh.records),
            chains: borrowed(&mesh.chains.chains),
            links: borrowed(&mesh.chains.links),
            fill_vertices: borrowed(&mesh.fill.vertices),
            fill_colors: borrowed(&mesh.fill.colors),
            fill_indices: borrowed(&mesh.fill.indices),
            fill_runs: borrowed(&mesh.fill.runs),
            materials: borrowed(&mesh.fill.materials),
            groups: borrowed(&mesh.fill.groups),
            bounds: mesh.bounds,
            counts: mesh.counts,
            replicated_f32: None,
            replicated_i16: None,
            instanced: Vec::new(),
            report: Cow::Borrowed(report),
        }
    }

    /// A copy as an [`EdgeMesh`], without the replicated layouts and the instances.
    #[must_use]
    pub fn to_mesh(&self) -> EdgeMesh {
        EdgeMesh {
            frame: self.frame,
            positions: self.positions.to_vec(),
            split_from: self.split_from.to_vec(),
            vertex_normals: self.vertex_normals.to_vec(),
            triangles: self.triangles.to_vec(),
            face_planes: self.face_planes.to_vec(),
            records: self.records.to_vec(),
            chains: Chains { chains: self.chains.to_vec(), links: self.links.to_vec() },
            fill: FillMesh {
                vertices: self.fill_vertices.to_vec(),
                colors: self.fill_colors.to_vec(),
                indices: self.fill_indices.to_vec(),
                runs: self.fill_runs.to_vec(),
                materials: self.materials.to_vec(),
                groups: self.groups.to_vec(),
            },
            bounds: self.bounds,
            counts: self.counts,
        }
    }

    /// The repairs and warnings of the build.
    #[must_use]
    pub fn report(&self) -> &Report {
        &self.report
    }

    /// The layouts in the file, in the order of [`Layout::ALL`].
    pub fn layouts(&self) -> impl Iterator<Item = Layout> {
        Layout::ALL.into_iter().filter(|layout| match layout {
            Layout::Indexed => true,
            Layout::ReplicatedF32 => self.replicated_f32.is_some(),
            Layout::ReplicatedI16 => self.replicated_i16.is_some(),
        })
    }
}

const fn borrowed<T: Clone>(items: &Vec<T>) -> Cow<'_, [T]> {
    Cow::Borrowed(items.as_slice())
}
