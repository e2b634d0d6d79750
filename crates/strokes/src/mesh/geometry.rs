//! Positions and normals of one instance on the GPU, in one place that a pose can write.
//!
//! A pose writes all of it but edge records and triangles; links and sizes are in
//! [`crate::mesh::buffers`]. Instances of the same mesh share the geometry at rest.
//!
//! ```text
//!   positions   | welded vertices ......... | corners with attributes of their own |
//!                 ^ strokes, detection, fill  ^ surfaces read both
//! ```

/// The geometry of one instance.
#[derive(Debug)]
pub struct Geometry {
    /// One per chunk.
    pub(crate) chunks: Vec<ChunkGeometry>,
    /// Positions of the triangles that hide strokes, one buffer per part of the fill.
    pub(crate) fill: Vec<wgpu::Buffer>,
    /// If the mesh was uploaded with its surface.
    pub(crate) surface: Option<SurfaceGeometry>,
}

/// The geometry of one chunk.
#[derive(Debug)]
pub(crate) struct ChunkGeometry {
    pub(crate) edges: EdgeGeometry,
    /// Cones around the faces of each run of edges.
    pub(crate) run_cones: wgpu::Buffer,
}

/// Where the edges of a chunk lie.
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

/// The vertices of surfaces that are shaded.
#[derive(Debug)]
pub struct SurfaceGeometry {
    /// 12 bytes per vertex.
    pub positions: wgpu::Buffer,
    /// 12 bytes per vertex.
    pub normals: wgpu::Buffer,
}

impl Geometry {
    /// The vertices of the surface; `None` if the mesh was uploaded without it.
    #[must_use]
    pub const fn surface(&self) -> Option<&SurfaceGeometry> {
        self.surface.as_ref()
    }
}
