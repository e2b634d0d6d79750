//! Marked edges: `IndexedLineSet` of both versions.

use super::indices::{is_end, point_index};
use super::number_list::NumberList;
use super::placement::Placement;
use super::scene_builder::SceneBuilder;
use crate::format::read::error::ReadError;
use crate::format::read::vrml::parse::{NodeRef, Numbers};
use crate::index::to_u32;
use crate::model::Segment;

impl SceneBuilder<'_> {
    /// Adds polylines, which -1 ends in the list of indices.
    ///
    /// # Errors
    /// [`ReadErrorKind::Index`](crate::format::read::ReadErrorKind::Index) if an index
    /// names a point that does not exist, with its line.
    pub(super) fn add_lines(
        &mut self,
        node: NodeRef,
        points: &NumberList,
        indices: &Numbers,
        placement: &Placement,
    ) -> Result<(), ReadError> {
        self.spend(node, indices.values.len())?;
        let first = self.add_positions(points, &placement.transform)?;
        let mut previous = None;
        for (place, &value) in indices.values.iter().enumerate() {
            if is_end(value) {
                previous = None;
                continue;
            }
            let end = first + to_u32(point_index(node, indices, place, points.count::<3>())?);
            if let Some(start) = previous {
                let line = self.model_line(indices.line_of(place));
                self.model.segments.push(Segment { ends: [start, end], line });
            }
            previous = Some(end);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use crate::format::read::ReadErrorKind;
    use crate::format::read::vrml::tests::{read, sound};
    use crate::model::Segment;
    use crate::report::Place;

    #[test]
    fn polylines_become_segments() {
        let text = "Transform { translation 1 0 0 children Shape { geometry IndexedLineSet {
            coord Coordinate { point [ 0 0 0, 1 0 0, 1 1 0 ] }
            coordIndex [ 0 1 2 -1 -1 1 -1\n 2 0 ] } } }";
        let model = sound(text);
        let ends: Vec<_> =
            model.segments.iter().map(|&Segment { ends, line }| (ends, line)).collect();
        assert_eq!(ends, [([0, 1], 4), ([1, 2], 4), ([2, 0], 5)]);
        assert_eq!(model.positions[0], [1.0, 0.0, 0.0]);
    }

    #[test]
    fn lines_of_the_first_version_take_the_points_in_force() {
        let text = "#VRML V1.0 ascii\nCoordinate3 { point [ 0 0 0, 1 0 0 ] }
            IndexedLineSet { coordIndex [ 0, 1, ] }";
        assert_eq!(sound(text).segments, [Segment { ends: [0, 1], line: 3 }]);
        let error = read(&text.replace("0, 1, ]", "0,\n 7 ]")).unwrap_err();
        assert_eq!((error.kind, error.place), (ReadErrorKind::Index, Some(Place::Line(4))));
    }
}
