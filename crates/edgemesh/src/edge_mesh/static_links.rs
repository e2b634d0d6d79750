//! The chains that no view changes, as a link for each record.

use crate::edge_mesh::mesh::EdgeMesh;
use crate::index::NONE;

/// The place of each record in the chains of its mesh.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct StaticLinks {
    /// For each record, the record that follows, or [`NONE`].
    pub next: Vec<u32>,
    /// For each record, whether the chain runs from its `v1` to its `v0`.
    pub is_reversed: Vec<bool>,
}

impl StaticLinks {
    /// Builds the links of a mesh.
    #[must_use]
    pub fn of(mesh: &EdgeMesh) -> Self {
        let count = mesh.records.len();
        let mut links = Self { next: vec![NONE; count], is_reversed: vec![false; count] };
        for chain in &mesh.chains.chains {
            let run = &mesh.chains.links[chain.link_range()];
            let first = if chain.is_loop == 1 { run.first() } else { None };
            for (link, following) in run.iter().zip(run.iter().skip(1).chain(first)) {
                links.next[link.record as usize] = following.record;
            }
            for link in run {
                links.is_reversed[link.record as usize] = link.is_reversed == 1;
            }
        }
        links
    }
}
