//! Index buffers of strokes, which all meshes share.

use edgemesh::line::LineKind;
use wgpu::util::DeviceExt as _;

/// The key of an index buffer, which all meshes share.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum IndexKey {
    /// Expanded vertices.
    Expanded(LineKind),
    /// The first two of four vertices per edge.
    Lines,
    /// Quads of four vertices per edge.
    Quads,
    /// One triangle of an end, from four vertices per edge.
    Ends,
}

impl IndexKey {
    /// The indices of the first edge, and the number of vertices per edge.
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
