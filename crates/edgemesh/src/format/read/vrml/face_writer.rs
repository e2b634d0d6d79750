//! Writes the faces of a [`FaceSet`] into the model, corner by corner.

use super::faces::{Bases, Bound, FaceSet, Spot, is_end, point_index};
use super::lists::{List, to_f32};
use super::scene::{Placement, Scene};
use crate::format::read::error::ReadError;
use crate::index::{NONE, to_u32};
use crate::model::{Corner, Material};
use crate::report::WarningCode;

/// The face that is being read.
pub(super) struct FaceWriter<'w, 's, 'a> {
    scene: &'w mut Scene<'s>,
    set: &'w FaceSet<'a>,
    placement: &'w Placement,
    bases: Bases,
    is_reversed: bool,
    corners: Vec<Corner>,
    /// The line of its first corner.
    line: u32,
    /// How many faces are done.
    face: usize,
    /// How many corners are done, over all faces.
    corner: usize,
    /// Which points have got their colour.
    has_color: Vec<bool>,
}

impl<'w, 's, 'a> FaceWriter<'w, 's, 'a> {
    /// Prepares to write `set`, whose lists begin at `bases` in the model.
    pub(super) fn new(
        scene: &'w mut Scene<'s>,
        set: &'w FaceSet<'a>,
        placement: &'w Placement,
        bases: Bases,
    ) -> Self {
        let colored = if set.colors.is_some() { set.points.count::<3>() } else { 0 };
        Self {
            scene,
            set,
            placement,
            bases,
            is_reversed: set.is_clockwise != placement.is_mirrored(),
            corners: Vec::new(),
            line: 0,
            face: 0,
            corner: 0,
            has_color: vec![false; colored],
        }
    }

    /// Writes all faces.
    pub(super) fn write(mut self) -> Result<(), ReadError> {
        if self.set.face_materials.is_none() {
            let material = self.material(self.set.material.clone());
            self.scene.set_attributes(self.placement, material, self.set.smoothing);
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
        let spot = Spot { face: self.face, corner: self.corner, place, point };
        let corner = Corner {
            position: self.bases.position + to_u32(point),
            texcoord: self.attribute::<2>(set.texcoords.as_ref(), self.bases.texcoord, spot),
            normal: self.attribute::<3>(set.normals.as_ref(), self.bases.normal, spot),
        };
        self.corners.push(corner);
        self.color_point(spot);
        self.corner += 1;
        Ok(())
    }

    /// The index in the model of what belongs to a corner, or [`NONE`].
    fn attribute<const N: usize>(
        &mut self,
        attribute: Option<&(Bound, List)>,
        base: u32,
        spot: Spot,
    ) -> u32 {
        let Some((bound, list)) = attribute else { return NONE };
        self.element(bound, list.count::<N>(), spot).map_or(NONE, |element| base + to_u32(element))
    }

    /// What belongs to a corner, out of `count`; says so where it is not there.
    fn element(&mut self, bound: &Bound, count: usize, spot: Spot) -> Option<usize> {
        let element = bound.element(spot).filter(|&element| element < count);
        if element.is_none() {
            let line = self.set.indices.line_of(spot.place);
            self.scene.warn_in_line(self.set.node, WarningCode::Index, line, || {
                format!("a corner has no normal, colour or the like among {count}; it was left out")
            });
        }
        element
    }

    /// Gives a point its colour; where its corners differ the first one counts.
    fn color_point(&mut self, spot: Spot) {
        let Some((bound, list)) = self.set.colors.as_ref() else { return };
        let colors = list.numbers.chunks::<3>();
        let element = self.element(bound, colors.len(), spot);
        let Some(color) = element.map(|element| colors[element].map(to_f32)) else { return };
        let position = self.bases.position as usize + spot.point;
        let kept = &mut self.scene.model.colors[position];
        if !std::mem::replace(&mut self.has_color[spot.point], true) {
            *kept = color;
        } else if *kept != color {
            let line = self.set.indices.line_of(spot.place);
            self.scene.warn_in_line(self.set.node, WarningCode::Unsupported, line, || {
                "a vertex has several colours; the first one is kept".into()
            });
        }
    }

    fn finish_face(&mut self) {
        let count = self.corners.len();
        if count == 0 {
            return;
        }
        if count < 3 {
            self.scene.warn_in_line(self.set.node, WarningCode::Degenerate, self.line, || {
                format!("a face of {count} corners was dropped")
            });
        } else {
            if self.is_reversed {
                // The first corner stays the first.
                self.corners[1..].reverse();
            }
            self.paint_face();
            let line = self.scene.model_line(self.line);
            self.scene.model.push_polygon(&self.corners, line);
        }
        self.face += 1;
        self.corners.clear();
    }

    fn paint_face(&mut self) {
        let Some(materials) = &self.set.face_materials else { return };
        let spot = Spot { face: self.face, ..Spot::default() };
        let own = materials.bound.element(spot).and_then(&materials.material);
        if own.is_none() {
            self.scene.warn_in_line(self.set.node, WarningCode::Index, self.line, || {
                "a face has no colour of its own among those listed; it was left out".into()
            });
        }
        let material = self.material(own.or_else(|| self.set.material.clone()));
        self.scene.set_attributes(self.placement, material, self.set.smoothing);
    }

    /// The index of a material in the model, or [`NONE`].
    fn material(&mut self, material: Option<Material>) -> u32 {
        material.map_or(NONE, |material| self.scene.material(material))
    }
}
