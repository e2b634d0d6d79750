//! Index buffers of strokes, which all meshes share.

use edgemesh::line::LineKind;
use wgpu::util::DeviceExt as _;

/// Index buffers that all meshes share.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum IndexKey {
    /// Vertices that were expanded.
    Expanded(LineKind),
    /// Of four vertices an edge the first two.
    Lines,
    /// The quads of four vertices an edge.
    Quads,
    /// One triangle of an end from four vertices an edge.
    Ends,
}

impl IndexKey {
    /// The indices of the first edge, and how many vertices an edge has.
    pub(crate) fn pattern(self) -> (Vec<u32>, u32) {
        match self {
            Self::Expanded(kind) => (kind.indices(), kind.vertex_count()),
            Self::Lines => (vec![0, 1], 4),
            Self::Quads => (vec![0, 1, 2, 0, 2, 3], 4),
            Self::Ends => (vec![0, 1, 2], 4),
        }
    }
}

#[derive(Debug)]
pub(crate) struct IndexBuffer {
    pub(crate) count: u32,
    pub(crate) buffer: wgpu::Buffer,
}

impl IndexBuffer {
    pub(crate) fn new(device: &wgpu::Device, key: IndexKey, count: u32) -> Self {
        let (pattern, stride) = key.pattern();
        let of_edge = |edge: u32| pattern.iter().map(move |&vertex| vertex + stride * edge);
        let indices: Vec<u32> = (0..count.max(1)).flat_map(of_edge).collect();
        let buffer = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("stroke indices"),
            contents: bytemuck::cast_slice(&indices),
            usage: wgpu::BufferUsages::INDEX,
        });
        Self { count, buffer }
    }
}
