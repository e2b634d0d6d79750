//! The lists of an object in a view, and of each of its chunks, written by the GPU alone. The
//! run states and tallies of all chunks are one buffer each.
//!
//! | buffer | bytes |
//! |---|---|
//! | facing | 1 bit per face |
//! | run states | 40 per 64 edges |
//! | counts | 4 per 64 edges and layer |
//! | live edges | 4 per edge |
//! | tally | 64 |
//! | arguments of the draws | 1024 |
//! | expanded vertices | up to 480 per stroke, for one edge in 16, per stroke set |

use bytemuck::{Pod, Zeroable};
use edgemesh::line::{LineClass, LineKind};
use edgemesh::view::FeatureCounts;
use wgpu::BufferUsages;

use crate::mesh::buffers::RUN_STATE_BYTES;
use crate::mesh::capacity::BYTES_PER_VERTEX;
use crate::mesh::layout::{ChunkUniform, FACES_PER_WORD};
use crate::style::drawing_style::{MAX_LAYERS, MAX_STROKE_SETS};

/// The edges of a run, one bit each. WGSL twin: `shaders/common/view_runs.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct RunState {
    /// Drawn in every view.
    pub static_edges: [u32; 2],
    /// Static edges that their own solid can hide.
    pub solid: [u32; 2],
    /// Drawn in this view.
    pub live: [u32; 2],
    /// Contours of this view.
    pub contour: [u32; 2],
    /// 1 if the winding of two faces clashes.
    pub has_clash: u32,
    /// Unused.
    pub padding: u32,
}

const _: () = assert!(size_of::<RunState>() == RUN_STATE_BYTES, "as the mesh reckons");

/// The arguments of the draws of one stroke set: one of expanded strokes, one of the rest. WGSL
/// twin: `shaders/common/draw_arguments.wgsl`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct DrawArguments {
    /// Indices of the expanded strokes.
    pub index_count: u32,
    /// Always 1.
    pub instance_count: u32,
    /// Always 0.
    pub first_index: u32,
    /// Always 0.
    pub base_vertex: u32,
    /// Always 0.
    pub first_instance: u32,
    /// Workgroups of the expansion.
    pub groups_x: u32,
    /// Always 1.
    pub groups_y: u32,
    /// Always 1.
    pub groups_z: u32,
    /// Vertices of the rest, which is drawn straight from the list.
    pub vertex_count: u32,
    /// Always 1.
    pub rest_instance_count: u32,
    /// First vertex of the rest.
    pub first_vertex: u32,
    /// Always 0.
    pub rest_first_instance: u32,
    /// Where the stroke set's edges begin in the live list.
    pub first: u32,
    /// How many of those edges are expanded.
    pub expanded: u32,
    /// Unused.
    pub padding: [u32; 2],
}

/// Bytes from the start of [`DrawArguments`] to the workgroups.
pub(crate) const GROUPS_OFFSET: u64 = std::mem::offset_of!(DrawArguments, groups_x) as u64;

/// Bytes from the start of [`DrawArguments`] to the rest.
pub(crate) const REST_OFFSET: u64 = std::mem::offset_of!(DrawArguments, vertex_count) as u64;

/// The edge counts of a chunk, or of several, in a view. WGSL twin:
/// `shaders/common/view_runs.wgsl`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Pod, Zeroable)]
#[non_exhaustive]
#[repr(C)]
pub struct Tally {
    /// Edges in the live list.
    pub stroke_count: u32,
    /// Edges of each line class.
    pub features: [u32; LineClass::COUNT],
    /// Where the edges of each layer begin in the live list; the last is the number of all.
    pub layer_first: [u32; MAX_LAYERS + 1],
}

impl Tally {
    /// Bytes of the counts that every view clears: strokes and contours. The other counts hold
    /// until the classes change.
    pub(crate) const VIEW_BYTES: u64 = 8;

    /// The edges of each line class, by name.
    #[must_use]
    pub const fn features(&self) -> FeatureCounts {
        FeatureCounts(self.features)
    }

    /// The sums of the counts of both, at most the largest number.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            stroke_count: self.stroke_count.saturating_add(other.stroke_count),
            features: std::array::from_fn(|at| {
                self.features[at].saturating_add(other.features[at])
            }),
            layer_first: std::array::from_fn(|at| {
                self.layer_first[at].saturating_add(other.layer_first[at])
            }),
        }
    }
}

const _: () = assert!(LineClass::Contour as usize == 0, "contours are counted in every view");

/// The run states and tallies of one object in one view.
#[derive(Debug, Clone)]
pub(crate) struct ObjectRuns {
    pub(crate) runs: wgpu::Buffer,
    /// One per chunk.
    pub(crate) tallies: wgpu::Buffer,
}

impl ObjectRuns {
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

/// The lists of one chunk in one view.
#[derive(Debug)]
pub(crate) struct ChunkLists {
    pub(crate) facing: wgpu::Buffer,
    pub(crate) counts: wgpu::Buffer,
    pub(crate) live: wgpu::Buffer,
    /// One [`DrawArguments`] per stroke set, in the order of drawing.
    pub(crate) arguments: wgpu::Buffer,
    /// Expanded vertices, one buffer per stroke set; `None` if none of its strokes is expanded.
    pub(crate) vertices: Vec<Option<wgpu::Buffer>>,
}

impl ChunkLists {
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
        let arguments = (size_of::<DrawArguments>() * MAX_STROKE_SETS) as u64;
        let vertices = |kind: &LineKind| {
            let bytes =
                u64::from(chunk.capacity) * u64::from(kind.vertex_count() * BYTES_PER_VERTEX);
            buffer("expanded strokes", bytes, BufferUsages::VERTEX)
        };
        Self {
            facing: buffer("facing", 4 * faces, BufferUsages::COPY_SRC),
            counts: buffer("counts", 4 * runs * u64::from(layer_count), BufferUsages::empty()),
            live: buffer("live edges", 4 * u64::from(chunk.edge_count), BufferUsages::COPY_SRC),
            arguments: buffer(
                "draw arguments",
                arguments,
                BufferUsages::INDIRECT | BufferUsages::COPY_SRC,
            ),
            vertices: expanded.iter().map(|kind| kind.as_ref().map(vertices)).collect(),
        }
    }
}
