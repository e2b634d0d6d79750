//! Lists of numbers that become positions, normals, texture coordinates and colors.

use glam::DAffine3;

use crate::format::read::vrml::parse::{NodeKey, NodeRef, Numbers};

/// Numbers of a node.
#[derive(Debug, Clone, Copy)]
pub(super) struct NumberList<'a> {
    /// The node that lists them, or the shape that they are generated for.
    pub(super) node: NodeRef<'a>,
    /// The numbers.
    pub(super) numbers: Numbers<'a>,
    /// Whether other shapes may use the same list.
    pub(super) is_shared: bool,
}

impl<'a> NumberList<'a> {
    /// The list in a field of a node such as `Coordinate`.
    pub(super) fn of(node: NodeRef<'a>, field: &str) -> Self {
        Self { node, numbers: node.numbers(field), is_shared: true }
    }

    /// As [`Self::of`]; `None` without a node, and for an empty list.
    pub(super) fn if_any(node: Option<NodeRef<'a>>, field: &str) -> Option<Self> {
        node.map(|node| Self::of(node, field)).filter(|list| !list.numbers.values.is_empty())
    }

    /// Numbers that are generated for `node`.
    pub(super) const fn generated(node: NodeRef<'a>, numbers: Numbers<'a>) -> Self {
        Self { node, numbers, is_shared: false }
    }

    /// The number of groups of `N` numbers.
    pub(super) const fn count<const N: usize>(&self) -> usize {
        self.numbers.chunks::<N>().len()
    }
}

/// Identifies a list in the model: its kind, its node, and the bits of its transform.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) struct ListKey {
    kind: ListKind,
    node: NodeKey,
    transform: [u64; 12],
}

/// The lists of a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum ListKind {
    Positions,
    Normals,
    Texcoords,
    Colors,
}

impl ListKey {
    pub(super) fn new(kind: ListKind, node: NodeRef, transform: &DAffine3) -> Self {
        Self { kind, node: node.key(), transform: transform.to_cols_array().map(f64::to_bits) }
    }
}

/// Rounds a number to 32 bits.
#[expect(clippy::cast_possible_truncation, reason = "rounding is intended")]
pub(super) const fn to_f32(number: f64) -> f32 {
    number as f32
}
