//! Adds positions, normals, texture coordinates and colors to the model.
//!
//! Several shapes may use one list, by `USE`, or because VRML 1.0 keeps the last list in
//! force. Shapes with the same list and the same transform share its elements in the
//! model. So faces that meet in the file meet in the model, and a hundred face sets with
//! one large list need it only once.

use glam::{DAffine3, DVec3};

use super::number_list::{ListKey, ListKind, NumberList, to_f32};
use super::scene_builder::SceneBuilder;
use crate::format::read::error::ReadError;
use crate::format::read::normal_transform::normal_transform;
use crate::index::to_u32;
use crate::report::WarningCode;

impl SceneBuilder<'_> {
    /// Adds the positions of a list, transformed; returns the index of the first.
    pub(super) fn add_positions(
        &mut self,
        list: &NumberList,
        transform: &DAffine3,
    ) -> Result<u32, ReadError> {
        let kind = list.is_shared.then_some(ListKind::Positions);
        self.add_list(list, kind, transform, 3, |builder| {
            let first = builder.model.positions.len();
            let moved = |&point: &[f64; 3]| transform.transform_point3(point.into()).to_array();
            builder.model.positions.extend(list.numbers.chunks::<3>().iter().map(moved));
            first
        })
    }

    /// Adds the normals of a list, transformed as `transform` does points; returns the
    /// index of the first.
    pub(super) fn add_normals(
        &mut self,
        list: &NumberList,
        transform: &DAffine3,
    ) -> Result<u32, ReadError> {
        let matrix = normal_transform(transform.matrix3);
        let kind = list.is_shared.then_some(ListKind::Normals);
        self.add_list(list, kind, transform, 3, |builder| {
            let first = builder.model.normals.len();
            let moved = |&normal: &[f64; 3]| {
                (matrix * DVec3::from(normal)).normalize_or_zero().as_vec3().to_array()
            };
            builder.model.normals.extend(list.numbers.chunks::<3>().iter().map(moved));
            first
        })
    }

    /// Adds the texture coordinates of a list; returns the index of the first.
    pub(super) fn add_texcoords(&mut self, list: &NumberList) -> Result<u32, ReadError> {
        let kind = list.is_shared.then_some(ListKind::Texcoords);
        self.add_list(list, kind, &DAffine3::IDENTITY, 2, |builder| {
            let first = builder.model.texcoords.len();
            let narrow = |texcoord: &[f64; 2]| texcoord.map(to_f32);
            builder.model.texcoords.extend(list.numbers.chunks::<2>().iter().map(narrow));
            first
        })
    }

    /// Adds the colors of a list; returns the index of the first.
    pub(super) fn add_colors(&mut self, list: &NumberList) -> Result<u32, ReadError> {
        let kind = list.is_shared.then_some(ListKind::Colors);
        self.add_list(list, kind, &DAffine3::IDENTITY, 3, |builder| {
            let first = builder.model.colors.len();
            let opaque = |color: &[f64; 3]| {
                let [red, green, blue] = color.map(to_f32);
                [red, green, blue, 1.0]
            };
            builder.model.colors.extend(list.numbers.chunks::<3>().iter().map(opaque));
            first
        })
    }

    /// Adds a list of elements of `width` numbers with `add`, unless the model has it
    /// already; lists without a `kind` are not shared.
    fn add_list(
        &mut self,
        list: &NumberList,
        kind: Option<ListKind>,
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
                format!(
                    "a list has {count} numbers, not a multiple of {width}; the rest was left out"
                )
            });
        }
        let first = to_u32(add(self));
        if let Some(key) = key {
            self.lists.insert(key, first);
        }
        Ok(first)
    }
}
