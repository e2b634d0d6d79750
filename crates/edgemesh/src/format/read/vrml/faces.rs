//! Faces as both versions and every solid have them: corner indices in a row,
//! -1 behind each face.
//!
//! ```text
//! coordIndex    0 1 2 3 -1   3 2 5 4 -1     a face each; the last -1 may be missing
//! normalIndex   0 0 0 0 -1   1 1 1 1 -1     CornerIndexed: the same places
//! normalIndex   0            1              FaceIndexed: one a face
//! ```
//!
//! Rejected: a way of its own for solids, grids and extrusions. They are turned
//! into such lists instead, so winding, mirrors and attributes are minded once.

use super::document::{NodeRef, Numbers};
use super::face_writer::FaceWriter;
use super::lists::List;
use super::scene::{Placement, Scene};
use crate::format::read::error::{ReadError, ReadErrorKind};
use crate::model::{Material, Smoothing};

/// Colour of vertices that have none, in a model where others have one.
const WHITE: [f32; 3] = [1.0; 3];

/// Which element of a list belongs to a corner.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Binding {
    /// The first one, for all.
    Overall,
    /// One a face, in order.
    Face,
    /// One a face, by its index.
    FaceIndexed,
    /// One a corner, in order.
    Corner,
    /// One a corner, by an index in the same place as the corner's own; by the
    /// corner's own where there are no others.
    CornerIndexed,
}

/// Where in a list of faces a corner stands.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Spot {
    /// The face, counted without empty ones.
    pub(super) face: usize,
    /// The corner, counted over all faces.
    pub(super) corner: usize,
    /// The place in the list of indices.
    pub(super) place: usize,
    /// The corner's own index.
    pub(super) point: usize,
}

/// Where the lists of a face set begin in those of the model.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Bases {
    /// The first position.
    pub(super) position: u32,
    /// The first normal.
    pub(super) normal: u32,
    /// The first texture coordinate.
    pub(super) texcoord: u32,
}

/// How a list is bound to corners.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bound<'a> {
    /// What belongs to what.
    pub(super) binding: Binding,
    /// The indices, where the binding has any.
    pub(super) indices: Numbers<'a>,
}

impl Bound<'_> {
    /// The element of a corner; `None` where its index is no index.
    pub(super) fn element(&self, spot: Spot) -> Option<usize> {
        match self.binding {
            Binding::Overall => Some(0),
            Binding::Face => Some(spot.face),
            Binding::FaceIndexed => self.indices.index(spot.face),
            Binding::Corner => Some(spot.corner),
            Binding::CornerIndexed if self.indices.values.is_empty() => Some(spot.point),
            Binding::CornerIndexed => self.indices.index(spot.place),
        }
    }
}

/// Materials of single faces.
pub(super) struct FaceMaterials<'a> {
    /// The number of each face's material.
    pub(super) bound: Bound<'a>,
    /// The material of a number.
    pub(super) material: Box<dyn Fn(usize) -> Option<Material> + 'a>,
}

/// Faces with all that a file may say of them.
pub(super) struct FaceSet<'a> {
    /// The node, for messages.
    pub(super) node: NodeRef<'a>,
    /// Positions, three numbers each.
    pub(super) points: List<'a>,
    /// Corner indices, -1 behind each face.
    pub(super) indices: Numbers<'a>,
    /// Normals, three numbers each.
    pub(super) normals: Option<(Bound<'a>, List<'a>)>,
    /// Texture coordinates, two numbers each.
    pub(super) texcoords: Option<(Bound<'a>, List<'a>)>,
    /// Colours of vertices, three numbers each.
    pub(super) colors: Option<(Bound<'a>, List<'a>)>,
    /// The material of all faces that have none of their own.
    pub(super) material: Option<Material>,
    /// The materials of single faces.
    pub(super) face_materials: Option<FaceMaterials<'a>>,
    /// Whether faces run clockwise as seen from outside.
    pub(super) is_clockwise: bool,
    /// Where shading is smooth.
    pub(super) smoothing: Smoothing,
}

impl<'a> FaceSet<'a> {
    /// Faces with nothing but a place and a material.
    pub(super) const fn bare(
        node: NodeRef<'a>,
        points: List<'a>,
        indices: Numbers<'a>,
        material: Option<Material>,
        smoothing: Smoothing,
    ) -> Self {
        Self {
            node,
            points,
            indices,
            normals: None,
            texcoords: None,
            colors: None,
            material,
            face_materials: None,
            is_clockwise: false,
            smoothing,
        }
    }
}

impl Scene<'_> {
    /// Adds faces to the model.
    ///
    /// # Errors
    /// [`ReadErrorKind::Index`] for a corner that is no point, with its line.
    pub(super) fn add_faces(
        &mut self,
        set: &FaceSet,
        placement: &Placement,
    ) -> Result<(), ReadError> {
        self.spend(set.node, set.indices.values.len())?;
        let transform = &placement.transform;
        let mut bases = Bases {
            position: self.add_positions(&set.points, transform, set.colors.is_some())?,
            ..Bases::default()
        };
        if let Some((_, list)) = &set.normals {
            bases.normal = self.add_normals(list, transform)?;
        }
        if let Some((_, list)) = &set.texcoords {
            bases.texcoord = self.add_texcoords(list)?;
        }
        if set.colors.is_some() {
            self.pad_colors();
        }
        FaceWriter::new(self, set, placement, bases).write()
    }

    /// Gives every vertex a colour that has none yet.
    pub(super) fn pad_colors(&mut self) {
        self.model.colors.resize(self.model.positions.len(), WHITE);
    }
}

/// Whether an index ends a face or a line.
pub(super) fn is_end(value: f64) -> bool {
    value.to_bits() == (-1.0_f64).to_bits()
}

/// The index at `place`, which must be one of `count` points.
pub(super) fn point_index(
    node: NodeRef,
    indices: &Numbers,
    place: usize,
    count: usize,
) -> Result<usize, ReadError> {
    match indices.index(place) {
        Some(index) if index < count => Ok(index),
        _ => {
            let found = indices.values.get(place).copied().unwrap_or_default();
            let what = format!(
                "{} names point {found}, counted from 0, of {count}; mend the index",
                node.kind()
            );
            Err(node.document.origin.error(ReadErrorKind::Index, indices.line_of(place), what))
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::format::read::ReadErrorKind;
    use crate::format::read::vrml::tests::{diffuse_of_faces, faces_of, read, sound};
    use crate::index::NONE;
    use crate::model::Smoothing;
    use crate::report::{Place, WarningCode};

    const POINTS: &str = "coord Coordinate { point [ 0 0 0, 1 0 0, 1 1 0, 0 1 0, 0 0 1 ] }";

    fn face_set(fields: &str) -> String {
        format!("Shape {{ geometry IndexedFaceSet {{ {POINTS}\n{fields} }} }}")
    }

    #[test]
    fn faces_end_at_minus_one_and_at_the_end_of_the_list() {
        let model = sound(&face_set("coordIndex [ -1 0 1 2 -1 -1\n\n 0, 1, 2, 3, -1\n 2 1 4 ]"));
        assert_eq!(faces_of(&model), [vec![0, 1, 2], vec![0, 1, 2, 3], vec![2, 1, 4]]);
        assert_eq!((model.polygon_lines, model.positions.len()), (vec![3, 5, 6], 5));
    }

    #[test]
    fn clockwise_and_mirrored_faces_are_turned_around() {
        let index = "coordIndex [ 0 1 2 3 ]";
        let mirrored = |shape: String| format!("Transform {{ scale 1 1 -1 children {shape} }}");
        let clockwise = face_set(&format!("ccw FALSE {index}"));
        let turned = [[0, 3, 2, 1]];
        assert_eq!(faces_of(&sound(&clockwise)), turned);
        assert_eq!(faces_of(&sound(&mirrored(face_set(index)))), turned);
        assert_eq!(faces_of(&sound(&mirrored(clockwise))), [[0, 1, 2, 3]]);
    }

    #[test]
    fn crease_angles_are_those_of_the_face_set() {
        let text =
            face_set("coordIndex [ 0 1 2 ]") + &face_set("creaseAngle 0.5 coordIndex [ 0 1 2 ]");
        let angles = sound(&text).per_polygon(|run| run.smoothing);
        assert_eq!(angles, [Smoothing::Angle(0.0), Smoothing::Angle(0.5)]);
    }

    #[test]
    fn indices_that_are_no_points_are_errors_with_their_line() {
        for wrong in ["5", "-2", "1.5", "1e30", "nan"] {
            let error = read(&face_set(&format!("coordIndex [ 0 1 2 -1\n 0 1 {wrong} ]")));
            let error = error.unwrap_err();
            let found = (error.kind, error.place.clone());
            assert_eq!(found, (ReadErrorKind::Index, Some(Place::Line(4))), "{error}");
        }
    }

    #[test]
    fn faces_without_area_or_points_are_told() {
        let (model, report) = read(&face_set("coordIndex [ 0 1 -1 0 1 2 ]")).unwrap();
        assert_eq!((model.polygon_count(), report.count(WarningCode::Degenerate)), (1, 1));
        let text = face_set("coordIndex [ 0 1 2 ]")
            + "Shape { geometry IndexedFaceSet { coordIndex [ 0 1 2 ] } }
               Shape { geometry IndexedFaceSet { coord Coordinate { point [ 0 0 0 1 ] } } }";
        let (_, report) = read(&text).unwrap();
        assert_eq!(report.count(WarningCode::Syntax), 2, "{report:?}");
    }

    #[test]
    fn normals_go_by_corner_by_index_and_by_face() {
        let normals = "normal Normal { vector [ 0 0 1, 0 0 2, 1 0 0, 0 1 0, 0 0 -1 ] }
            coordIndex [ 0 1 2 -1 0 2 3 -1 ]";
        let of = |fields: &str| sound(&face_set(&format!("{normals} {fields}"))).corner_normals;
        assert_eq!(of(""), [0, 1, 2, 0, 2, 3]);
        assert_eq!(of("normalIndex [ 4 4 3 -1 2 1 0 ]"), [4, 4, 3, 2, 1, 0]);
        assert_eq!(of("normalPerVertex FALSE"), [0, 0, 0, 1, 1, 1]);
        assert_eq!(of("normalPerVertex FALSE normalIndex [ 3 1 ]"), [3, 3, 3, 1, 1, 1]);
        let wrong = face_set(&format!("{normals} normalPerVertex FALSE normalIndex [ 3 9 ]"));
        let (model, report) = read(&wrong).unwrap();
        assert_eq!(model.corner_normals, [3, 3, 3, NONE, NONE, NONE]);
        assert_eq!(report.count(WarningCode::Index), 3);
    }

    #[test]
    fn texture_coordinates_have_indices_of_their_own() {
        let text = face_set(
            "coordIndex [ 0 1 2 ] texCoord TextureCoordinate { point [ 0 0, 0.5 1 ] }
             texCoordIndex [ 1 0 1 ]",
        );
        let model = sound(&text);
        assert_eq!(model.texcoords, [[0.0, 0.0], [0.5, 1.0]]);
        assert_eq!(model.corner_texcoords, [1, 0, 1]);
    }

    #[test]
    fn colors_of_vertices_stay_and_those_of_faces_become_materials() {
        let colors = "color Color { color [ 1 0 0, 0 1 0, 0 0 1, 1 1 0, 0 0 0 ] }
            coordIndex [ 0 1 2 -1 0 2 3 -1 ]";
        let plain = face_set("coordIndex [ 0 1 2 ]");
        let model = sound(&(plain + &face_set(colors)));
        assert_eq!(
            model.colors[..7],
            [
                [1., 1., 1.],
                [1., 1., 1.],
                [1., 1., 1.],
                [1., 1., 1.],
                [1., 1., 1.],
                [1., 0., 0.],
                [0., 1., 0.]
            ]
        );
        assert_eq!((model.colors.len(), model.materials.len()), (10, 0));
        let model = sound(&face_set(&format!("{colors} colorPerVertex FALSE colorIndex [ 2 0 ]")));
        assert_eq!(diffuse_of_faces(&model), [Some([0., 0., 1.]), Some([1., 0., 0.])]);
        assert!(model.colors.is_empty());
        let (model, report) =
            read(&face_set(&format!("{colors} colorIndex [ 0 1 2 -1 4 2 3 ]"))).unwrap();
        assert_eq!((model.colors[0], report.count(WarningCode::Unsupported)), ([1., 0., 0.], 1));
        let (model, report) =
            read(&face_set(&format!("{colors} colorPerVertex FALSE colorIndex [ 0 7 ]"))).unwrap();
        assert_eq!(diffuse_of_faces(&model), [Some([1., 0., 0.]), None]);
        assert_eq!(report.count(WarningCode::Index), 1);
    }
}
