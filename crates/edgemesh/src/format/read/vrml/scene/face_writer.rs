//! Adds the faces of a [`FaceSet`] to the model, corner by corner.

use super::face_set::{ElementLookup, FaceCorner, FaceSet};
use super::indices::{is_end, point_index};
use super::number_list::NumberList;
use super::placement::Placement;
use super::scene_builder::SceneBuilder;
use crate::format::read::error::ReadError;
use crate::index::{NONE, to_u32};
use crate::model::{Corner, Material};
use crate::report::WarningCode;

impl SceneBuilder<'_> {
    /// Adds the faces of a set.
    ///
    /// # Errors
    /// [`ReadErrorKind::Index`](crate::format::read::ReadErrorKind::Index) if a corner
    /// names a point that does not exist, with its line.
    pub(super) fn add_faces(
        &mut self,
        set: &FaceSet,
        placement: &Placement,
    ) -> Result<(), ReadError> {
        self.spend(set.node, set.indices.values.len())?;
        let transform = &placement.transform;
        let mut first = FirstElements {
            position: self.add_positions(&set.points, transform)?,
            ..FirstElements::default()
        };
        if let Some((_, list)) = &set.normals {
            first.normal = self.add_normals(list, transform)?;
        }
        if let Some((_, list)) = &set.texcoords {
            first.texcoord = self.add_texcoords(list)?;
        }
        if let Some((_, list)) = &set.colors {
            first.color = self.add_colors(list)?;
        }
        FaceWriter::new(self, set, placement, first).write()
    }
}

/// The indices in the model of the first elements of the lists of a face set.
#[derive(Debug, Clone, Copy, Default)]
struct FirstElements {
    position: u32,
    normal: u32,
    texcoord: u32,
    color: u32,
}

/// Adds faces one by one; the corners are those of the current face.
struct FaceWriter<'w, 's, 'a> {
    builder: &'w mut SceneBuilder<'s>,
    set: &'w FaceSet<'a>,
    placement: &'w Placement,
    first: FirstElements,
    is_reversed: bool,
    corners: Vec<Corner>,
    /// The line of the first corner.
    line: u32,
    /// The number of faces so far.
    face: usize,
    /// The number of corners so far, over all faces.
    corner: usize,
}

impl<'w, 's, 'a> FaceWriter<'w, 's, 'a> {
    fn new(
        builder: &'w mut SceneBuilder<'s>,
        set: &'w FaceSet<'a>,
        placement: &'w Placement,
        first: FirstElements,
    ) -> Self {
        Self {
            builder,
            set,
            placement,
            first,
            is_reversed: set.is_clockwise != placement.is_mirrored(),
            corners: Vec::new(),
            line: 0,
            face: 0,
            corner: 0,
        }
    }

    /// Adds all faces.
    fn write(mut self) -> Result<(), ReadError> {
        if self.set.face_materials.is_none() {
            let material = self.material(self.set.material.clone());
            self.builder.set_attributes(self.placement, material, self.set.smoothing);
        }
        for (place, &value) in self.set.indices.values.iter().enumerate() {
            if is_end(value) {
                self.finish_face();
            } else {
                self.push_corner(place)?;
            }
        }
        self.finish_face();
        Ok(())
    }

    fn push_corner(&mut self, place: usize) -> Result<(), ReadError> {
        let set = self.set;
        let count = set.points.count::<3>();
        let point = point_index(set.node, &set.indices, place, count)?;
        if self.corners.is_empty() {
            self.line = set.indices.line_of(place);
        }
        let at = FaceCorner { face: self.face, corner: self.corner, place, point };
        let corner = Corner {
            position: self.first.position + to_u32(point),
            texcoord: self.attribute::<2>(set.texcoords.as_ref(), self.first.texcoord, at),
            normal: self.attribute::<3>(set.normals.as_ref(), self.first.normal, at),
            color: self.attribute::<3>(set.colors.as_ref(), self.first.color, at),
        };
        self.corners.push(corner);
        self.corner += 1;
        Ok(())
    }

    /// The index in the model of an attribute of a corner, or [`NONE`].
    fn attribute<const N: usize>(
        &mut self,
        attribute: Option<&(ElementLookup, NumberList)>,
        first: u32,
        at: FaceCorner,
    ) -> u32 {
        let Some((lookup, list)) = attribute else { return NONE };
        self.element(lookup, list.count::<N>(), at).map_or(NONE, |element| first + to_u32(element))
    }

    /// The element of `count` that belongs to a corner; warns if it does not exist.
    fn element(&mut self, lookup: &ElementLookup, count: usize, at: FaceCorner) -> Option<usize> {
        let element = lookup.element(at).filter(|&element| element < count);
        if element.is_none() {
            let line = self.set.indices.line_of(at.place);
            self.builder.warn_in_line(self.set.node, WarningCode::Index, line, || {
                format!("a corner names an attribute past the last of {count}; it was left out")
            });
        }
        element
    }

    fn finish_face(&mut self) {
        let count = self.corners.len();
        if count == 0 {
            return;
        }
        if count < 3 {
            self.builder.warn_in_line(self.set.node, WarningCode::Degenerate, self.line, || {
                format!("a face needs three corners, this one has {count}; it was dropped")
            });
        } else {
            if self.is_reversed {
                // The first corner stays the first.
                self.corners[1..].reverse();
            }
            self.paint_face();
            let line = self.builder.model_line(self.line);
            self.builder.model.push_polygon(&self.corners, line);
        }
        self.face += 1;
        self.corners.clear();
    }

    fn paint_face(&mut self) {
        let Some(materials) = &self.set.face_materials else { return };
        let at = FaceCorner { face: self.face, ..FaceCorner::default() };
        let material = materials.lookup.element(at).and_then(&materials.material);
        if material.is_none() {
            self.builder.warn_in_line(self.set.node, WarningCode::Index, self.line, || {
                "a face names a color past the last of the list; it was left out".into()
            });
        }
        let material = self.material(material.or_else(|| self.set.material.clone()));
        self.builder.set_attributes(self.placement, material, self.set.smoothing);
    }

    /// The index of a material in the model, or [`NONE`].
    fn material(&mut self, material: Option<Material>) -> u32 {
        material.map_or(NONE, |material| self.builder.material(material))
    }
}
