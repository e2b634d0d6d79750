//! What a view makes of one object and of each of its chunks, written by the GPU
//! alone. The run states and tallies of all chunks are one buffer each.
//!
//! | buffer | bytes |
//! |---|---|
//! | facing | 1 bit a face |
//! | run states | 40 for 64 edges |
//! | counts | 4 for 64 edges and layer |
//! | live edges | 4 an edge |
//! | tally | 64 |
//! | arguments of the draws | 1024 |
//! | vertices | 200 a stroke that there is room for (of 16 edges one), each draw |

use bytemuck::{Pod, Zeroable};
use edgemesh::line::kind::LineKind;
use edgemesh::view::feature_counts::FeatureCounts;
use wgpu::BufferUsages;

use crate::draw::expand::BYTES_PER_VERTEX;
use crate::mesh::layout::{ChunkUniform, FACES_PER_WORD};
use crate::style::drawing_style::{MAX_DRAWS, MAX_LAYERS};

/// Expanded strokes take at most this much for a draw of a chunk.
pub(crate) const MAX_EXPANDED_BYTES: u64 = 1 << 26;

/// The edges of a run, one bit each. WGSL twin: `shaders/common/view_runs.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct RunState {
    /// Drawn without being contours.
    pub marked: [u32; 2],
    /// Those of them that their own solid can hide.
    pub solid: [u32; 2],
    /// Drawn in this view.
    pub live: [u32; 2],
    /// Contours of this view.
    pub contour: [u32; 2],
    /// 1 where the winding of two faces clashes.
    pub has_clash: u32,
    /// Unused.
    pub padding: u32,
}

/// The arguments of one draw of strokes. WGSL twin:
/// `shaders/common/draw_arguments.wgsl`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct DrawArguments {
    /// Indices of the strokes that were expanded.
    pub index_count: u32,
    /// Always 1.
    pub instance_count: u32,
    /// Always 0.
    pub first_index: u32,
    /// Always 0.
    pub base_vertex: u32,
    /// Always 0.
    pub first_instance: u32,
    /// Workgroups that expand them.
    pub groups_x: u32,
    /// Always 1.
    pub groups_y: u32,
    /// Always 1.
    pub groups_z: u32,
    /// Vertices of the rest, drawn straight from the list.
    pub vertex_count: u32,
    /// Always 1.
    pub rest_instance_count: u32,
    /// The first of them.
    pub first_vertex: u32,
    /// Always 0.
    pub rest_first_instance: u32,
    /// Where the draw's edges begin in the live list.
    pub first: u32,
    /// How many of them are expanded.
    pub expanded: u32,
    /// Unused.
    pub padding: [u32; 2],
}

/// Bytes from the start of [`DrawArguments`] to the workgroups.
pub(crate) const GROUPS_OFFSET: u64 = std::mem::offset_of!(DrawArguments, groups_x) as u64;

/// Bytes from the start of [`DrawArguments`] to the rest.
pub(crate) const REST_OFFSET: u64 = std::mem::offset_of!(DrawArguments, vertex_count) as u64;

/// The counts of a view. WGSL twin: `shaders/common/view_runs.wgsl`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Tally {
    /// See [`FeatureCounts`], as all the others.
    pub contour: u32,
    /// Edges in the live list.
    pub stroke_count: u32,
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
    /// Where the edges of each layer begin in the live list; the last is their
    /// number.
    pub layer_first: [u32; MAX_LAYERS + 1],
}

impl Tally {
    /// Bytes that every view counts anew; the others stay while the classes do.
    pub(crate) const VIEW_BYTES: u64 = 8;

    /// The counts of classes.
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

    /// The counts of classes and of strokes of both together.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            contour: self.contour + other.contour,
            stroke_count: self.stroke_count + other.stroke_count,
            ridge: self.ridge + other.ridge,
            valley: self.valley + other.valley,
            boundary: self.boundary + other.boundary,
            marked: self.marked + other.marked,
            material: self.material + other.material,
            smoothing: self.smoothing + other.smoothing,
            layer_first: std::array::from_fn(|at| self.layer_first[at] + other.layer_first[at]),
        }
    }
}

/// What one view makes of a whole object.
#[derive(Debug)]
pub(crate) struct ObjectBuffers {
    pub(crate) runs: wgpu::Buffer,
    /// One a chunk.
    pub(crate) tallies: wgpu::Buffer,
}

impl ObjectBuffers {
    pub(crate) fn new(device: &wgpu::Device, chunks: &[ChunkUniform]) -> Self {
        let buffer = |label: &str, size: usize, usage: BufferUsages| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: size as u64,
                usage: BufferUsages::STORAGE | usage,
                mapped_at_creation: false,
            })
        };
        let runs: u32 = chunks.iter().map(|chunk| chunk.run_count).sum();
        let read_back = BufferUsages::COPY_DST | BufferUsages::COPY_SRC;
        // A binding must not be empty.
        let runs = size_of::<RunState>() * runs.max(1) as usize;
        Self {
            runs: buffer("run states", runs, BufferUsages::empty()),
            tallies: buffer("tallies", size_of::<Tally>() * chunks.len(), read_back),
        }
    }
}

/// The buffers of one view of one chunk.
#[derive(Debug)]
pub(crate) struct ViewBuffers {
    pub(crate) facing: wgpu::Buffer,
    pub(crate) counts: wgpu::Buffer,
    pub(crate) live: wgpu::Buffer,
    /// The arguments of the draws, in order.
    pub(crate) draws: wgpu::Buffer,
    /// Expanded vertices, one buffer a draw; none where no stroke is expanded.
    pub(crate) vertices: Vec<Option<wgpu::Buffer>>,
}

impl ViewBuffers {
    pub(crate) fn new(
        device: &wgpu::Device,
        chunk: &ChunkUniform,
        layer_count: u32,
        expanded: &[Option<LineKind>],
    ) -> Self {
        let buffer = |label: &str, size: u64, usage: BufferUsages| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                // A binding must not be empty, nor smaller than one element.
                size: size.max(size_of::<RunState>() as u64),
                usage: BufferUsages::STORAGE | usage,
                mapped_at_creation: false,
            })
        };
        let runs = u64::from(chunk.run_count);
        let faces = (chunk.face_count as usize).div_ceil(FACES_PER_WORD) as u64;
        let draws = (size_of::<DrawArguments>() * MAX_DRAWS) as u64;
        let vertices = |kind: &LineKind| {
            let bytes =
                u64::from(chunk.capacity) * u64::from(kind.vertex_count() * BYTES_PER_VERTEX);
            buffer("expanded strokes", bytes, BufferUsages::VERTEX)
        };
        Self {
            facing: buffer("facing", 4 * faces, BufferUsages::COPY_SRC),
            counts: buffer("counts", 4 * runs * u64::from(layer_count), BufferUsages::empty()),
            live: buffer("live edges", 4 * u64::from(chunk.edge_count), BufferUsages::COPY_SRC),
            draws: buffer("draws", draws, BufferUsages::INDIRECT | BufferUsages::COPY_SRC),
            vertices: expanded.iter().map(|kind| kind.as_ref().map(vertices)).collect(),
        }
    }
}
