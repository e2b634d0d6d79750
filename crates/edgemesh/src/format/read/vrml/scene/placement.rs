//! The transform and the group of a shape.

use std::rc::Rc;

use glam::DAffine3;

use crate::format::read::vrml::parse::NodeRef;

/// The transform and the group of a shape.
#[derive(Debug, Clone, Default)]
pub(super) struct Placement {
    /// From the coordinates of the shape to those of the model.
    pub(super) transform: DAffine3,
    /// The nearest `DEF` name of the shape and the nodes around it.
    pub(super) group: Option<Rc<str>>,
}

impl Placement {
    /// The same transform, with the name of `node` as the group, if it has one.
    pub(super) fn named(&self, node: NodeRef) -> Self {
        Self { transform: self.transform, group: node.name().or(self.group.as_ref()).cloned() }
    }

    /// The placement within a node with this transform.
    pub(super) fn moved(self, transform: DAffine3) -> Self {
        Self { transform: self.transform * transform, ..self }
    }

    /// Whether it mirrors shapes.
    pub(super) fn is_mirrored(&self) -> bool {
        self.transform.matrix3.determinant() < 0.0
    }
}
