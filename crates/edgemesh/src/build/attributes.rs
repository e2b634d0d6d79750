//! Material and smoothing of each face.

use super::faces::FaceSources;
use crate::edge_mesh::EdgeFlags;
use crate::index::to_u32;
use crate::model::{Attributes, Model, Smoothing};

/// Attributes by face.
#[derive(Debug)]
pub(crate) struct FaceAttributes {
    materials: ByFace<u32>,
    smoothing: ByFace<Smoothing>,
}

/// A value for each face.
#[derive(Debug)]
enum ByFace<T> {
    /// All faces have the same value.
    Same(T),
    Each(Vec<T>),
}

impl<T: Copy + PartialEq> ByFace<T> {
    fn of(model: &Model, sources: &FaceSources, value: impl Fn(Attributes) -> T) -> Self {
        let mut values = model.runs.iter().map(|run| value(run.attributes));
        let starts_late = model.runs.first().is_none_or(|run| run.first_polygon > 0);
        let first = if starts_late { None } else { values.next() };
        let first = first.unwrap_or_else(|| value(Attributes::default()));
        if values.all(|value| value == first) {
            return Self::Same(first);
        }
        let by_polygon = model.per_polygon(value);
        Self::Each((0..sources.len()).map(|face| by_polygon[sources.polygon(face)]).collect())
    }

    fn get(&self, face: u32) -> T {
        match self {
            Self::Same(value) => *value,
            Self::Each(values) => values[face as usize],
        }
    }
}

impl FaceAttributes {
    pub(crate) fn of(model: &Model, sources: &FaceSources) -> Self {
        Self {
            materials: ByFace::of(model, sources, |run| run.material),
            smoothing: ByFace::of(model, sources, |run| run.smoothing),
        }
    }

    /// The faces through which others are seen: of materials that are not opaque.
    pub(crate) fn see_through_faces(
        &self,
        model: &Model,
        face_count: usize,
    ) -> impl Iterator<Item = usize> {
        let is_seen_through: Vec<bool> =
            model.materials.iter().map(|material| !material.is_opaque()).collect();
        let count = if is_seen_through.contains(&true) { face_count } else { 0 };
        (0..count).filter(move |&face| {
            let material = self.materials.get(to_u32(face)) as usize;
            is_seen_through.get(material).copied().unwrap_or(false)
        })
    }

    /// The edges across which shading of a face is smooth.
    pub(crate) fn smoothing(&self, face: u32) -> Smoothing {
        self.smoothing.get(face)
    }

    /// The classes of an edge whose faces have different attributes.
    ///
    /// Two faces without a smoothing group are both flat, and the edge between them has no class.
    pub(crate) fn borders(&self, face_a: u32, face_b: u32) -> EdgeFlags {
        let mut flags = EdgeFlags::empty();
        flags.set(EdgeFlags::MATERIAL, self.materials.get(face_a) != self.materials.get(face_b));
        if let (Smoothing::Group(a), Smoothing::Group(b)) =
            (self.smoothing(face_a), self.smoothing(face_b))
        {
            flags.set(EdgeFlags::SMOOTHING, a != b);
        }
        flags
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::index::NONE;
    use crate::report::Report;

    #[test]
    fn borders_lie_between_materials_and_smoothing_groups() {
        let mut model = Model::from_polygons(&[[0.0; 3]; 3], &[&[0, 1, 2]]);
        let corners = [0, 1, 2].map(crate::model::Corner::at);
        for (material, group) in [(NONE, 0), (1, 0), (1, 3)] {
            let smoothing = Smoothing::Group(group);
            model.set_attributes(Attributes { material, smoothing, ..Attributes::default() });
            model.push_polygon(&corners, 0);
        }
        let sources = FaceSources::of(&model, &[], &mut Report::default());
        let attributes = FaceAttributes::of(&model, &sources);
        assert_eq!(attributes.borders(0, 1), EdgeFlags::empty(), "unstated is no group");
        assert_eq!(attributes.borders(1, 2), EdgeFlags::MATERIAL);
        assert_eq!(attributes.borders(2, 3), EdgeFlags::SMOOTHING);
        assert_eq!(attributes.borders(0, 3), EdgeFlags::MATERIAL);
    }
}
