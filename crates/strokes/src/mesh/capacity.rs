//! How much room a chunk gets for the lists of a view.
//!
//! Views list, expand and link edges in buffers whose sizes depend on the mesh alone, so
//! that no view allocates. A view that needs more draws the rest straight from its list. The
//! objects of meshes with several objects share the room that small meshes have beyond their
//! part.

use edgemesh::index::to_u32;
use edgemesh::line::LineKind;

/// One edge in this many can be expanded at once; in small meshes every edge can.
const EDGES_PER_EXPANDED: usize = 16;
const MIN_EXPANDED: usize = 1 << 14;

/// One edge in this many can be linked into strokes; in small meshes every edge can.
const EDGES_PER_NODE: usize = 8;
const MIN_NODES: usize = 1 << 16;

/// Bytes of an expanded vertex: position, u, and v and opacity at 16 bits each.
pub(crate) const BYTES_PER_VERTEX: u32 = 20;

/// Bytes of the largest expanded stroke.
const BYTES_PER_STROKE: u32 = LineKind::QuadAndDisks.vertex_count() * BYTES_PER_VERTEX;

/// The most bytes of expanded strokes of one stroke set in one chunk.
const MAX_EXPANDED_BYTES: u64 = 1 << 26;

/// Bytes of the largest binding per linked edge: two points, as many for the even grid, and
/// twice that for layers that draw hidden strokes too; 80 bytes for the ribbon of each.
pub(crate) const BYTES_PER_NODE: u64 = 8 * 80;

/// Strokes of a chunk that can be expanded at once, in each of `objects` objects.
pub(crate) fn stroke_capacity(device: &wgpu::Device, edge_count: usize, objects: u32) -> u32 {
    let bytes = MAX_EXPANDED_BYTES.min(device.limits().max_storage_buffer_binding_size);
    let most = usize::try_from(bytes / u64::from(BYTES_PER_STROKE)).unwrap_or(usize::MAX);
    let least = MIN_EXPANDED / objects.max(1) as usize;
    to_u32(edge_count.min(least.max(edge_count / EDGES_PER_EXPANDED)).min(most))
}

/// Edges of a chunk that can be linked, in each of `objects` objects: limited by the chunk's share of what one binding can
/// hold of the whole mesh of `mesh_edge_count` edges.
pub(crate) fn node_capacity(
    device: &wgpu::Device,
    edge_count: usize,
    mesh_edge_count: usize,
    objects: u32,
) -> u32 {
    let limit = device.limits().max_storage_buffer_binding_size / BYTES_PER_NODE;
    let most = u128::from(limit) * edge_count as u128 / mesh_edge_count.max(1) as u128;
    let most = usize::try_from(most).unwrap_or(usize::MAX);
    let least = MIN_NODES / objects.max(1) as usize;
    to_u32(edge_count.min(least.max(edge_count / EDGES_PER_NODE)).min(most))
}
