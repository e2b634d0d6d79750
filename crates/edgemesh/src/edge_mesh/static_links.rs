//! The chains that no view changes, as a link per record.

use crate::edge_mesh::mesh::EdgeMesh;
use crate::index::NONE;

/// For each record what the preprocessor's chains say of it.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct StaticLinks {
    /// The record that follows, or [`NONE`].
    pub next: Vec<u32>,
    /// Whether the chain runs from the record's `v1` to its `v0`.
    pub is_reversed: Vec<bool>,
}

impl StaticLinks {
    /// Those of `mesh`.
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
