//! The edges and chains of a mesh, from its records.

use crate::edge_mesh::{Chain, ChainLink, EdgeFlags, EdgeMesh, EdgeRecord};

/// The records of each edge: one, or several for an edge of more than two faces. Lines
/// without a face come last.
pub(super) fn edges(mesh: &EdgeMesh) -> impl Iterator<Item = &[EdgeRecord]> {
    mesh.records.chunk_by(|a, b| welded_ends(mesh, a) == welded_ends(mesh, b))
}

/// The welded ends of an edge, the smaller index first.
pub(super) fn welded_ends(mesh: &EdgeMesh, record: &EdgeRecord) -> [u32; 2] {
    let [a, b] = [record.v0, record.v1].map(|vertex| mesh.welded_vertex(vertex));
    [a.min(b), a.max(b)]
}

/// The classes of an edge that are drawn in every view.
pub(super) fn hard_classes(records: &[EdgeRecord]) -> EdgeFlags {
    let all = records.iter().fold(EdgeFlags::empty(), |flags, record| flags | record.flags());
    all & EdgeFlags::ALWAYS_DRAWN
}

/// The vertices along a chain; a loop ends with its first vertex.
pub(super) fn chain_vertices<'a>(
    mesh: &'a EdgeMesh,
    chain: &Chain,
) -> impl Iterator<Item = u32> + 'a {
    let links = &mesh.chains.links[chain.link_range()];
    let first = links.first().map(|link| link_ends(mesh, link)[0]);
    first.into_iter().chain(links.iter().map(|link| link_ends(mesh, link)[1]))
}

/// The vertices of an edge in the order of its chain.
pub(super) fn link_ends(mesh: &EdgeMesh, link: &ChainLink) -> [u32; 2] {
    let EdgeRecord { v0, v1, .. } = mesh.records[link.record as usize];
    if link.is_reversed == 1 { [v1, v0] } else { [v0, v1] }
}

/// The classes of the edge of each record: those that are drawn in every view.
pub(super) fn classes_of_records(mesh: &EdgeMesh) -> Vec<EdgeFlags> {
    let of_edge =
        |records: &[EdgeRecord]| std::iter::repeat_n(hard_classes(records), records.len());
    edges(mesh).flat_map(of_edge).collect()
}
