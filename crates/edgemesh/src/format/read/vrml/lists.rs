//! Positions, normals and texture coordinates on their way into the model.
//!
//! Several shapes may use one list, by `USE` or because VRML 1.0 keeps the last
//! one in force. Where they also stand in one place they share its elements in
//! the model too: faces that met in the file meet in the model, and a hundred
//! face sets over one large list cost one list.

use glam::{DAffine3, DMat3, DVec3};

use super::document::{NodeId, NodeRef, Numbers};
use super::scene::Scene;
use crate::format::read::error::ReadError;
use crate::index::to_u32;
use crate::report::WarningCode;

/// Numbers that belong to a node.
#[derive(Debug, Clone, Copy)]
pub(super) struct List<'a> {
    /// The node: the one that lists them, or the shape that they are made for.
    pub(super) node: NodeRef<'a>,
    /// The numbers.
    pub(super) numbers: Numbers<'a>,
    /// Whether other shapes may use the same node.
    pub(super) is_shared: bool,
}

impl<'a> List<'a> {
    /// The list in a field of a node such as `Coordinate`.
    pub(super) fn of(node: NodeRef<'a>, field: &str) -> Self {
        Self { node, numbers: node.numbers(field), is_shared: true }
    }

    /// The list in a field of `node`, unless there is nothing in it.
    pub(super) fn if_any(node: Option<NodeRef<'a>>, field: &str) -> Option<Self> {
        node.map(|node| Self::of(node, field)).filter(|list| !list.numbers.values.is_empty())
    }

    /// Numbers that were made for `node` alone.
    pub(super) const fn made(node: NodeRef<'a>, numbers: Numbers<'a>) -> Self {
        Self { node, numbers, is_shared: false }
    }

    /// How many groups of `N` numbers there are.
    pub(super) const fn count<const N: usize>(&self) -> usize {
        self.numbers.chunks::<N>().len()
    }
}

/// What tells lists in the model apart: what is in them, the address of the
/// document, the node, and the bits of the transformation.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) struct ListKey {
    kind: Kind,
    document: usize,
    node: NodeId,
    transform: [u64; 12],
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Kind {
    Positions,
    Normals,
    Texcoords,
}

impl ListKey {
    fn new(kind: Kind, node: NodeRef, transform: &DAffine3) -> Self {
        Self {
            kind,
            document: std::ptr::from_ref(node.document).addr(),
            node: node.id(),
            transform: transform.to_cols_array().map(f64::to_bits),
        }
    }
}

impl Scene<'_> {
    /// Adds the positions of a list, moved by `transform`; returns the index of
    /// the first one. `is_own` asks for positions that no other shape uses.
    pub(super) fn add_positions(
        &mut self,
        list: &List,
        transform: &DAffine3,
        is_own: bool,
    ) -> Result<u32, ReadError> {
        let key = (list.is_shared && !is_own).then_some(Kind::Positions);
        self.add_list(list, key, transform, 3, |scene| {
            let first = scene.model.positions.len();
            let moved = |&point: &[f64; 3]| transform.transform_point3(point.into()).to_array();
            scene.model.positions.extend(list.numbers.chunks::<3>().iter().map(moved));
            first
        })
    }

    /// Adds the normals of a list, turned as `transform` turns planes.
    pub(super) fn add_normals(
        &mut self,
        list: &List,
        transform: &DAffine3,
    ) -> Result<u32, ReadError> {
        let planes = of_planes(transform.matrix3);
        let key = list.is_shared.then_some(Kind::Normals);
        self.add_list(list, key, transform, 3, |scene| {
            let first = scene.model.normals.len();
            let turned = |&normal: &[f64; 3]| {
                (planes * DVec3::from(normal)).normalize_or_zero().as_vec3().to_array()
            };
            scene.model.normals.extend(list.numbers.chunks::<3>().iter().map(turned));
            first
        })
    }

    /// Adds the texture coordinates of a list.
    pub(super) fn add_texcoords(&mut self, list: &List) -> Result<u32, ReadError> {
        let key = list.is_shared.then_some(Kind::Texcoords);
        self.add_list(list, key, &DAffine3::IDENTITY, 2, |scene| {
            let first = scene.model.texcoords.len();
            let narrow = |texcoord: &[f64; 2]| texcoord.map(to_f32);
            scene.model.texcoords.extend(list.numbers.chunks::<2>().iter().map(narrow));
            first
        })
    }

    /// Adds a list by `add` unless it is there already; `width` is how many
    /// numbers an element has.
    fn add_list(
        &mut self,
        list: &List,
        kind: Option<Kind>,
        transform: &DAffine3,
        width: usize,
        add: impl FnOnce(&mut Self) -> usize,
    ) -> Result<u32, ReadError> {
        let key = kind.map(|kind| ListKey::new(kind, list.node, transform));
        if let Some(&first) = key.as_ref().and_then(|key| self.lists.get(key)) {
            return Ok(first);
        }
        let count = list.numbers.values.len();
        self.spend(list.node, count)?;
        if !count.is_multiple_of(width) {
            self.warn(list.node, WarningCode::Syntax, || {
                format!("a list of {count} numbers, {width} to an element: the rest was left out")
            });
        }
        let first = to_u32(add(self));
        if let Some(key) = key {
            self.lists.insert(key, first);
        }
        Ok(first)
    }
}

/// The matrix that turns normals where `matrix` moves points: its inverse,
/// transposed, but for a factor that is positive. Made of cross products, so
/// that a matrix without an inverse gives no infinities.
fn of_planes(matrix: DMat3) -> DMat3 {
    let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
    if matrix.determinant() < 0.0 { -cofactors } else { cofactors }
}

/// A number for lists of 32 bits.
#[expect(clippy::cast_possible_truncation, reason = "rounds, as is meant")]
pub(super) const fn to_f32(number: f64) -> f32 {
    number as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_stay_upright_where_points_are_squeezed_and_mirrored() {
        // The plane x + y = 0 is squeezed along y: the normal leans towards y.
        let squeezed = of_planes(DMat3::from_diagonal(DVec3::new(1.0, 0.5, 1.0)));
        assert_eq!(squeezed * DVec3::new(1.0, 1.0, 0.0), DVec3::new(0.5, 1.0, 0.0));
        // A mirrored plane looks the mirrored way.
        let mirrored = of_planes(DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0)));
        assert_eq!(mirrored * DVec3::X, -DVec3::X);
        assert_eq!(mirrored * DVec3::Y, DVec3::Y);
        let flat = of_planes(DMat3::from_diagonal(DVec3::new(1.0, 0.0, 1.0)));
        assert_eq!(flat * DVec3::ONE, DVec3::Y);
    }
}
