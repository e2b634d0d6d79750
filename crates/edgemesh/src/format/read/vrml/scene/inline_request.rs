//! A node that inlines another file.

use super::placement::Placement;
use crate::format::read::vrml::parse::NodeRef;

/// A node that inlines another file.
#[derive(Debug)]
pub(super) struct InlineRequest<'d> {
    /// The node.
    pub(super) node: NodeRef<'d>,
    /// The field that lists the URLs of the file.
    pub(super) field: &'static str,
    /// The placement of the file.
    pub(super) placement: Placement,
}
