//! Face sets: lists of corner indices, with -1 after each face, and their attributes.
//!
//! ```text
//! coordIndex    0 1 2 3 -1   3 2 5 4 -1     the last -1 may be missing
//! normalIndex   0 0 0 0 -1   1 1 1 1 -1     CornerIndexed: one for each corner
//! normalIndex   0            1              FaceIndexed: one for each face
//! ```
//!
//! Solids, grids and extrusions are turned into face sets too, so that winding, mirrors
//! and attributes are handled in one place.

use super::number_list::NumberList;
use crate::format::read::vrml::parse::{NodeRef, Numbers};
use crate::model::{Material, Smoothing};

/// Which element of a list belongs to a corner.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Binding {
    /// The first one, for all corners.
    Overall,
    /// One for each face, in order.
    Face,
    /// One for each face, by index.
    FaceIndexed,
    /// One for each corner, in order.
    Corner,
    /// One for each corner, by an index at the same place as that of the corner; without
    /// indices, by that of the corner.
    CornerIndexed,
}

/// A corner of a face set.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct FaceCorner {
    /// The number of its face, not counting empty faces.
    pub(super) face: usize,
    /// The number of the corner, counted over all faces.
    pub(super) corner: usize,
    /// The place of its index in the list.
    pub(super) place: usize,
    /// The index of its point.
    pub(super) point: usize,
}

/// Finds the element of a list that belongs to a corner.
#[derive(Debug, Clone, Copy)]
pub(super) struct ElementLookup<'a> {
    /// Which element belongs to a corner.
    pub(super) binding: Binding,
    /// The indices; may be empty.
    pub(super) indices: Numbers<'a>,
}

impl ElementLookup<'_> {
    /// The element of a corner; `None` if its index is not a whole number.
    pub(super) fn element(&self, corner: FaceCorner) -> Option<usize> {
        match self.binding {
            Binding::Overall => Some(0),
            Binding::Face => Some(corner.face),
            Binding::FaceIndexed => self.indices.index(corner.face),
            Binding::Corner => Some(corner.corner),
            Binding::CornerIndexed if self.indices.values.is_empty() => Some(corner.point),
            Binding::CornerIndexed => self.indices.index(corner.place),
        }
    }
}

/// The materials of single faces.
pub(super) struct FaceMaterials<'a> {
    /// The number of the material of a face.
    pub(super) lookup: ElementLookup<'a>,
    /// The material with a number.
    pub(super) material: Box<dyn Fn(usize) -> Option<Material> + 'a>,
}

/// Faces with their attributes.
pub(super) struct FaceSet<'a> {
    /// The node, for messages.
    pub(super) node: NodeRef<'a>,
    /// The positions, three numbers each.
    pub(super) points: NumberList<'a>,
    /// The corner indices, -1 after each face.
    pub(super) indices: Numbers<'a>,
    /// The normals, three numbers each.
    pub(super) normals: Option<(ElementLookup<'a>, NumberList<'a>)>,
    /// The texture coordinates, two numbers each.
    pub(super) texcoords: Option<(ElementLookup<'a>, NumberList<'a>)>,
    /// The colors of corners, three numbers each; see [`FaceSet::set_colors`].
    pub(super) colors: Option<(ElementLookup<'a>, NumberList<'a>)>,
    /// The material of faces without one in `face_materials`.
    pub(super) material: Option<Material>,
    /// The materials of single faces.
    pub(super) face_materials: Option<FaceMaterials<'a>>,
    /// Whether faces are clockwise, seen from outside.
    pub(super) is_clockwise: bool,
    /// Which edges are shaded smoothly.
    pub(super) smoothing: Smoothing,
}

impl<'a> FaceSet<'a> {
    /// Faces with positions and one material.
    pub(super) const fn new(
        node: NodeRef<'a>,
        points: NumberList<'a>,
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

    /// Sets the colors of corners. They stand for the diffuse color of the material (VRML 97
    /// 6.10; VRML 1.0, `MaterialBinding`), so that of the material becomes white, which they are
    /// multiplied by.
    pub(super) fn set_colors(&mut self, lookup: ElementLookup<'a>, colors: NumberList<'a>) {
        self.colors = Some((lookup, colors));
        let white = |material| Material { diffuse: Some([1.0; 3]), ambient: None, ..material };
        self.material = self.material.take().map(white);
    }
}

#[cfg(test)]
mod tests {
    use crate::format::read::ReadErrorKind;
    use crate::format::read::vrml::tests::{diffuse_of_faces, faces_of, read, sound};
    use crate::index::NONE;
    use crate::model::{Model, Smoothing};
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
    fn clockwise_and_mirrored_faces_are_reversed() {
        let index = "coordIndex [ 0 1 2 3 ]";
        let mirrored = |shape: String| format!("Transform {{ scale 1 1 -1 children {shape} }}");
        let clockwise = face_set(&format!("ccw FALSE {index}"));
        let reversed = [[0, 3, 2, 1]];
        assert_eq!(faces_of(&sound(&clockwise)), reversed);
        assert_eq!(faces_of(&sound(&mirrored(face_set(index)))), reversed);
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
    fn indices_out_of_range_are_errors_with_their_line() {
        for wrong in ["5", "-2", "1.5", "1e30", "nan"] {
            let error = read(&face_set(&format!("coordIndex [ 0 1 2 -1\n 0 1 {wrong} ]")));
            let error = error.unwrap_err();
            let found = (error.kind, error.place.clone());
            assert_eq!(found, (ReadErrorKind::Index, Some(Place::Line(4))), "{error}");
        }
    }

    #[test]
    fn faces_without_area_or_points_give_warnings() {
        let (model, report) = read(&face_set("coordIndex [ 0 1 -1 0 1 2 ]")).unwrap();
        assert_eq!((model.polygon_count(), report.count(WarningCode::Degenerate)), (1, 1));
        let text = face_set("coordIndex [ 0 1 2 ]")
            + "Shape { geometry IndexedFaceSet { coordIndex [ 0 1 2 ] } }
               Shape { geometry IndexedFaceSet { coord Coordinate { point [ 0 0 0 1 ] } } }";
        let (_, report) = read(&text).unwrap();
        assert_eq!(report.count(WarningCode::Syntax), 2, "{report:?}");
    }

    #[test]
    fn normals_are_for_corners_indices_and_faces() {
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
    fn texture_coordinates_have_separate_indices() {
        let text = face_set(
            "coordIndex [ 0 1 2 ] texCoord TextureCoordinate { point [ 0 0, 0.5 1 ] }
             texCoordIndex [ 1 0 1 ]",
        );
        let model = sound(&text);
        assert_eq!(model.texcoords, [[0.0, 0.0], [0.5, 1.0]]);
        assert_eq!(model.corner_texcoords, [1, 0, 1]);
    }

    #[test]
    fn colors_of_vertices_are_kept_and_those_of_faces_become_materials() {
        let colors = "color Color { color [ 1 0 0, 0 1 0, 0 0 1, 1 1 0, 0 0 0 ] }
            coordIndex [ 0 1 2 -1 0 2 3 -1 ]";
        let plain = face_set("coordIndex [ 0 1 2 ]");
        let model = sound(&(plain + &face_set(colors)));
        let corners = |model: &Model, corners: std::ops::Range<usize>| -> Vec<[f32; 4]> {
            corners.map(|corner| model.corner_color(corner)).collect()
        };
        let [white, red, green] = [[1.; 4], [1., 0., 0., 1.], [0., 1., 0., 1.]];
        assert_eq!(corners(&model, 0..5), [white, white, white, red, green]);
        assert_eq!((model.colors.len(), model.materials.len()), (5, 0));
        let model = sound(&face_set(&format!("{colors} colorPerVertex FALSE colorIndex [ 2 0 ]")));
        assert_eq!(diffuse_of_faces(&model), [Some([0., 0., 1.]), Some([1., 0., 0.])]);
        assert!(model.colors.is_empty());
        let model = sound(&face_set(&format!("{colors} colorIndex [ 0 1 2 -1 4 2 3 ]")));
        let black = [0., 0., 0., 1.];
        assert_eq!([model.corner_color(0), model.corner_color(3)], [red, black], "of one point");
        let (model, report) =
            read(&face_set(&format!("{colors} colorPerVertex FALSE colorIndex [ 0 7 ]"))).unwrap();
        assert_eq!(diffuse_of_faces(&model), [Some([1., 0., 0.]), None]);
        assert_eq!(report.count(WarningCode::Index), 1);
    }
}
