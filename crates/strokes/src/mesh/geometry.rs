//! Positions and normals of one instance on the GPU, together, so that a pose can write them.
//!
//! A pose writes everything here except edge records and triangles. Links and sizes are in
//! `mesh/buffers.rs`. Instances of the same mesh share the geometry at rest.
//!
//! ```text
//!   positions   | welded vertices ......... | corners with distinct attributes |
//!                 ^ strokes, detection, fill  ^ surfaces read both
//! ```

/// The geometry of one instance.
#[derive(Debug)]
pub(crate) struct Geometry {
    /// One per chunk.
    pub(crate) chunks: Vec<ChunkGeometry>,
    /// Positions of the triangles that hide strokes, one buffer per part of the fill.
    pub(crate) fill: Vec<wgpu::Buffer>,
    /// With [`MeshOptions::surface`](crate::MeshOptions::surface).
    pub(crate) surface: Option<SurfaceGeometry>,
}

/// The geometry of one chunk.
#[derive(Debug)]
pub(crate) struct ChunkGeometry {
    pub(crate) edges: EdgeGeometry,
    /// Cones around the faces of each run of edges.
    pub(crate) run_cones: wgpu::Buffer,
}

/// The edges of a chunk, by layout.
#[derive(Debug)]
pub(crate) enum EdgeGeometry {
    Indexed {
        /// The same for all poses.
        records: wgpu::Buffer,
        /// The same for all poses.
        triangles: wgpu::Buffer,
        /// 12 bytes per vertex.
        positions: wgpu::Buffer,
        /// 12 bytes per vertex.
        normals: wgpu::Buffer,
        planes: wgpu::Buffer,
        face_cones: wgpu::Buffer,
    },
    Replicated {
        vertices: wgpu::Buffer,
    },
}

/// Positions and normals of a surface that is shaded.
#[derive(Debug)]
#[non_exhaustive]
pub struct SurfaceGeometry {
    /// 12 bytes per vertex.
    pub positions: wgpu::Buffer,
    /// 12 bytes per vertex.
    pub normals: wgpu::Buffer,
}
