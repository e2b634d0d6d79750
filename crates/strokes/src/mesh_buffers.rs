//! One edge mesh on the GPU.
//!
//! | buffer | bytes | read by |
//! |---|---|---|
//! | positions | 12 a vertex | fill, strokes |
//! | vertex normals | 12 a vertex | strokes |
//! | triangles | 12 a face | fill, strokes |
//! | face planes | 32 a face | facing, strokes |
//! | facing | 1 bit a face | detection |
//! | edge records | 20 an edge | detection, strokes |
//! | live edges | 4 an edge | strokes |
//! | runs | 4 for 64 edges | detection |
//! | tally | 44 | the indirect draw, the counts |

use bytemuck::{Pod, Zeroable};
use edgemesh::edge_mesh::EdgeMesh;
use edgemesh::index::to_u32;
use edgemesh::oracle::FeatureCounts;
use thiserror::Error;
use wgpu::BufferUsages;
use wgpu::util::DeviceExt as _;

use crate::frame::uniform_buffer;

/// Edges that one invocation looks at. WGSL twin: the constant of this name in
/// `shaders/detect_edges.wgsl`.
pub const EDGES_PER_RUN: u32 = 64;

/// How large the mesh is. WGSL twin: `MeshUniform` in `shaders/common/mesh.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct MeshUniform {
    /// Triangles.
    pub face_count: u32,
    /// Edge records.
    pub edge_count: u32,
    /// Runs of [`EDGES_PER_RUN`] edges.
    pub run_count: u32,
    /// Unused.
    pub padding: u32,
    /// Lower corner of the box around the mesh; w is unused.
    pub box_min: [f32; 4],
    /// Upper corner.
    pub box_max: [f32; 4],
}

/// The arguments of the indirect draw and the view's counts, as the GPU writes
/// them. WGSL twin: `Tally` in `shaders/detect_edges.wgsl`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Tally {
    /// Vertices an edge.
    pub vertex_count: u32,
    /// Live edges.
    pub instance_count: u32,
    /// Always 0.
    pub first_vertex: u32,
    /// Always 0.
    pub first_instance: u32,
    /// See [`FeatureCounts`], as all the others.
    pub contour: u32,
    /// Convex creases.
    pub ridge: u32,
    /// Concave creases.
    pub valley: u32,
    /// Edges of one face.
    pub boundary: u32,
    /// Edges that the artist chose.
    pub marked: u32,
    /// Edges between two materials.
    pub material: u32,
    /// Edges between two smoothing groups.
    pub smoothing: u32,
}

impl Tally {
    /// The counts without the draw.
    #[must_use]
    pub const fn features(&self) -> FeatureCounts {
        FeatureCounts {
            contour: self.contour,
            ridge: self.ridge,
            valley: self.valley,
            boundary: self.boundary,
            marked: self.marked,
            material: self.material,
            smoothing: self.smoothing,
        }
    }
}

/// The mesh does not fit the device.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "the mesh is too large for this adapter: its {what} need {need} bytes in one buffer, the \
     adapter takes {limit}"
)]
pub struct MeshTooLarge {
    /// Which buffer.
    pub what: &'static str,
    /// Bytes needed.
    pub need: u64,
    /// Bytes that the device binds at most.
    pub limit: u64,
}

/// The buffers of one mesh.
#[derive(Debug)]
pub struct MeshBuffers {
    pub(crate) size: MeshUniform,
    pub(crate) uniform: wgpu::Buffer,
    pub(crate) positions: wgpu::Buffer,
    pub(crate) normals: wgpu::Buffer,
    pub(crate) triangles: wgpu::Buffer,
    pub(crate) planes: wgpu::Buffer,
    pub(crate) records: wgpu::Buffer,
    pub(crate) facing: wgpu::Buffer,
    pub(crate) runs: wgpu::Buffer,
    pub(crate) live: wgpu::Buffer,
    pub(crate) tally: wgpu::Buffer,
}

impl MeshBuffers {
    /// Uploads `mesh`.
    ///
    /// # Errors
    /// [`MeshTooLarge`], before anything is uploaded.
    pub fn new(device: &wgpu::Device, mesh: &EdgeMesh) -> Result<Self, MeshTooLarge> {
        let edge_count = to_u32(mesh.records.len());
        let corner = |[x, y, z]: [f32; 3]| [x, y, z, 0.0];
        let size = MeshUniform {
            face_count: to_u32(mesh.triangles.len()),
            edge_count,
            run_count: edge_count.div_ceil(EDGES_PER_RUN),
            padding: 0,
            box_min: corner(mesh.bounds.min),
            box_max: corner(mesh.bounds.max),
        };
        check_sizes(device, mesh)?;
        let storage = BufferUsages::STORAGE;
        let words = |label: &str, count: u32, usage: BufferUsages| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                // A binding must not be empty.
                size: 4 * u64::from(count.max(1)),
                usage: storage | usage,
                mapped_at_creation: false,
            })
        };
        let tally_words = to_u32(size_of::<Tally>() / 4);
        let tally_usage = BufferUsages::INDIRECT | BufferUsages::COPY_DST | BufferUsages::COPY_SRC;
        Ok(Self {
            size,
            uniform: uniform_buffer(device, "mesh size", &size),
            positions: upload(device, "positions", &mesh.positions, storage | BufferUsages::VERTEX),
            normals: upload(device, "vertex normals", &mesh.vertex_normals, storage),
            triangles: upload(device, "triangles", &mesh.triangles, storage | BufferUsages::INDEX),
            planes: upload(device, "face planes", &mesh.face_planes, storage),
            records: upload(device, "edge records", &mesh.records, storage),
            facing: words("facing", size.face_count.div_ceil(32), BufferUsages::COPY_SRC),
            runs: words("runs", size.run_count, BufferUsages::empty()),
            live: words("live edges", edge_count, BufferUsages::COPY_SRC),
            tally: words("tally", tally_words, tally_usage),
        })
    }

    /// Triangles and edge records.
    #[must_use]
    pub const fn size(&self) -> MeshUniform {
        self.size
    }

    /// The buffer of the [`Tally`], for reading back.
    #[must_use]
    pub const fn tally(&self) -> &wgpu::Buffer {
        &self.tally
    }

    /// The buffer of live edges: record index, and the contour and facing bits
    /// of `LineBits` above it; in the order of the records.
    #[must_use]
    pub const fn live(&self) -> &wgpu::Buffer {
        &self.live
    }

    /// The buffer of facing bits, 32 to a word.
    #[must_use]
    pub const fn facing(&self) -> &wgpu::Buffer {
        &self.facing
    }
}

fn check_sizes(device: &wgpu::Device, mesh: &EdgeMesh) -> Result<(), MeshTooLarge> {
    let limits = device.limits();
    let limit = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
    let needs = [
        ("positions", size_of_val(&*mesh.positions)),
        ("face planes", size_of_val(&*mesh.face_planes)),
        ("edge records", size_of_val(&*mesh.records)),
    ];
    for (what, need) in needs {
        let need = need as u64;
        if need > limit {
            return Err(MeshTooLarge { what, need, limit });
        }
    }
    Ok(())
}

fn upload<T: Pod>(
    device: &wgpu::Device,
    label: &str,
    items: &[T],
    usage: BufferUsages,
) -> wgpu::Buffer {
    // A binding must not be empty, nor smaller than one element.
    let blank = [T::zeroed()];
    let items = if items.is_empty() { &blank } else { items };
    device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: Some(label),
        contents: bytemuck::cast_slice(items),
        usage,
    })
}
