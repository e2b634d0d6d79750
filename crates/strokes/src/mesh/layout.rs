//! How edges lie in memory on the GPU.

use bytemuck::{Pod, Zeroable};
use edgemesh::edge_mesh::EdgeWord;
use edgemesh_shaders::{ShaderError, ShaderSource};

use crate::gpu::shader::shader_module;

/// Edges per invocation. WGSL twin: the constant of this name in
/// `shaders/common/view_runs.wgsl`.
pub const EDGES_PER_RUN: u32 = 64;

/// Faces per word of facing bits.
pub(crate) const FACES_PER_WORD: usize = 32;

/// How edges lie in memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Layout {
    /// Records of indices: 20 bytes per edge.
    #[default]
    Indexed,
    /// The paper's replicated vertices in 32-bit floats: 320 bytes per edge.
    Replicated,
    /// The paper's replicated vertices at 16 bits: 160 bytes per edge.
    Replicated16,
    /// Card and Mitchell's fins, to compare with: 192 bytes per edge. Contours and boundaries
    /// are drawn as fins, whatever kinds and classes the style has, and vertex shaders detect.
    FaceNormals,
}

impl Layout {
    /// The file of this layout that replaces a placeholder: `common/edge_source.wgsl` (the
    /// geometry of an edge) or `common/edge_faces.wgsl` (the facing of its faces). The files for
    /// one placeholder define functions of the same names.
    fn shader_file(self, placeholder: &str) -> Option<&'static str> {
        match (placeholder, self) {
            ("common/edge_source.wgsl", Self::Indexed) => Some("common/edges_indexed.wgsl"),
            ("common/edge_source.wgsl", Self::Replicated | Self::FaceNormals) => {
                Some("common/edges_replicated.wgsl")
            }
            ("common/edge_source.wgsl", Self::Replicated16) => {
                Some("common/edges_replicated_16.wgsl")
            }
            ("common/edge_faces.wgsl", Self::Indexed) => Some("common/faces_indexed.wgsl"),
            ("common/edge_faces.wgsl", _) => Some("common/faces_replicated.wgsl"),
            _ => None,
        }
    }

    /// The module of an embedded shader for edges in this layout.
    pub(crate) fn shader_module(
        self,
        device: &wgpu::Device,
        root: &str,
    ) -> Result<wgpu::ShaderModule, ShaderError> {
        let source = ShaderSource::embedded_with(root, &|path| self.shader_file(path))?;
        Ok(shader_module(device, &source, root))
    }
}

/// The sizes of a chunk. WGSL twin: `ChunkUniform` in `shaders/common/mesh.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct ChunkUniform {
    /// Triangles.
    pub face_count: u32,
    /// Edge records.
    pub edge_count: u32,
    /// Runs of [`EDGES_PER_RUN`] edges.
    pub run_count: u32,
    /// The most strokes that are expanded.
    pub capacity: u32,
    /// Number of the chunk's first run in the mesh.
    pub first_run: u32,
    /// Number of the chunk in the mesh.
    pub chunk_index: u32,
    /// The most edges that are linked into strokes.
    pub node_capacity: u32,
    /// Unused.
    pub padding: u32,
}

/// An edge record as shaders read it: 20 bytes. WGSL twin: `shaders/common/mesh.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct PackedRecord {
    /// Start vertex, numbered in the chunk.
    pub v0: u32,
    /// End vertex.
    pub v1: u32,
    /// The face that traverses the edge from `v0` to `v1`, or `NONE`.
    pub face_a: u32,
    /// The face across, or `NONE`.
    pub face_b: u32,
    /// Static flags and crease angle.
    pub word: EdgeWord,
}
