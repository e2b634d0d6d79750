//! A polygonal model as its file describes it.
//!
//! Polygons are not cut here: the diagonal of a quad is not an edge of the model, and only the
//! polygon tells them apart.
//!
//! Each attribute has a list, which stays empty if the file lacks it: large models are mostly bare
//! triangles, with 12 bytes of corners and 4 of line each.

use glam::DMat4;

use crate::index::{NONE, to_u32};
use crate::model::material::Material;
use crate::model::rig::Rig;
use crate::report::Place;

/// The color of vertices and corners without one, if others have colors.
pub(crate) const WHITE: [f32; 4] = [1.0; 4];

/// A polygonal model as its file describes it.
#[derive(Debug, Clone, Default)]
pub struct Model {
    /// The name in messages: the path that the model was read from.
    pub name: String,
    /// All vertices of the file, used or not, in its units.
    pub positions: Vec<[f64; 3]>,
    /// Red, green, blue and opacity, 0 to 1, of each of `positions`, or a list that corners index:
    /// see `corner_colors`. Display values, coded as sRGB, like those of [`Material`]; empty if
    /// the file has no colors of vertices, corners or faces.
    pub colors: Vec<[f32; 4]>,
    /// Texture coordinates that corners index; (0, 0) is the lower left corner of a picture,
    /// (1, 1) the upper right corner.
    pub texcoords: Vec<[f32; 2]>,
    /// Normals that corners index, of any length.
    pub normals: Vec<[f32; 3]>,
    /// Index into `positions` of each corner, polygon by polygon.
    pub corner_positions: Vec<u32>,
    /// Index into `texcoords` of each corner, or [`NONE`]; empty if no corner has one.
    pub corner_texcoords: Vec<u32>,
    /// Index into `normals` of each corner, or [`NONE`]; empty if no corner has one.
    pub corner_normals: Vec<u32>,
    /// Index into `colors` of each corner, or [`NONE`] for white; empty if corners have the colors
    /// of their positions.
    pub corner_colors: Vec<u32>,
    /// The end of each polygon in the corner lists; empty if all polygons are triangles.
    pub polygon_ends: Vec<u32>,
    /// The line of each polygon in the file, counted from 1; empty if the format has no lines.
    pub polygon_lines: Vec<u32>,
    /// Attributes of polygons, in runs that ascend by first polygon; empty if no polygon has any.
    pub runs: Vec<PolygonRun>,
    /// Lines that the artist drew.
    pub segments: Vec<Segment>,
    /// Edges that are never drawn as creases: indices into `positions`, the smaller first, each
    /// edge once. A segment on the same edge takes precedence.
    pub suppressed_edges: Vec<[u32; 2]>,
    /// The classes of edges, if the file states them; an edge that is not in the list has none
    /// then. `None` leaves them to angles, materials and smoothing groups.
    pub stated_edges: Option<Vec<StatedEdge>>,
    /// Whether the file declares parts invisible. A file with nothing else is an empty model and
    /// not an error.
    pub has_invisible_parts: bool,
    /// Materials in the order of their first use.
    pub materials: Vec<Material>,
    /// Names of groups, objects or nodes in the order of their first use.
    pub groups: Vec<String>,
    /// Skins and morph targets, if the model has any; `positions` are those of the rest pose.
    pub rig: Option<Box<Rig>>,
    /// Large meshes that the file places several times. They are no part of the lists above. Marks
    /// count their vertices after those of `positions`, one mesh after the other.
    pub instanced: Vec<InstancedModel>,
}

/// A mesh that a file places several times, read once.
#[derive(Debug, Clone)]
pub struct InstancedModel {
    /// The mesh in its first place. It has no instances and no rig.
    pub model: Model,
    /// The transforms from the first place to each place, in units of the file: the identity, then
    /// turns, moves, mirrors and scales that are the same along all axes.
    pub placements: Vec<DMat4>,
}

/// One corner of a polygon.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Corner {
    /// Index into [`Model::positions`].
    pub position: u32,
    /// Index into [`Model::texcoords`], or [`NONE`].
    pub texcoord: u32,
    /// Index into [`Model::normals`], or [`NONE`].
    pub normal: u32,
    /// Index into [`Model::colors`], or [`NONE`]; see [`Model::corner_colors`].
    pub color: u32,
}

impl Corner {
    /// A corner without texture coordinate, normal and color of its own.
    #[must_use]
    pub const fn at(position: u32) -> Self {
        Self { position, texcoord: NONE, normal: NONE, color: NONE }
    }
}

/// Attributes of successive polygons.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PolygonRun {
    /// The first polygon; the run ends where the next one begins.
    pub first_polygon: u32,
    /// The attributes.
    pub attributes: Attributes,
}

/// Attributes of a polygon.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Attributes {
    /// Index into [`Model::materials`], or [`NONE`].
    pub material: u32,
    /// Index into [`Model::groups`], or [`NONE`].
    pub group: u32,
    /// The edges that are shaded smoothly.
    pub smoothing: Smoothing,
}

impl Default for Attributes {
    fn default() -> Self {
        Self { material: NONE, group: NONE, smoothing: Smoothing::Unstated }
    }
}

/// The edges of a polygon across which shading is smooth.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub enum Smoothing {
    /// The file does not say.
    #[default]
    Unstated,
    /// Edges to polygons of the same group; group 0 is flat (OBJ `s`).
    Group(u32),
    /// Edges to polygons whose normals differ by at most this angle in radians (VRML
    /// `creaseAngle`).
    Angle(f32),
}

/// A line from one vertex to another that the artist drew.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Segment {
    /// The ends, as indices into [`Model::positions`].
    pub ends: [u32; 2],
    /// The line in the file, counted from 1; 0 if the format has no lines.
    pub line: u32,
}

/// An edge of two faces or more with the classes that the file states.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StatedEdge {
    /// The ends, as indices into [`Model::positions`].
    pub ends: [u32; 2],
    /// The classes.
    pub classes: StatedClasses,
}

/// The classes of an edge that a file can state.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct StatedClasses {
    /// A convex crease.
    pub ridge: bool,
    /// A concave crease.
    pub valley: bool,
    /// Between two materials.
    pub material: bool,
    /// Between two smoothing groups.
    pub smoothing: bool,
    /// Of more than two faces, and a feature.
    pub non_manifold: bool,
}

impl Model {
    /// The number of polygons.
    #[must_use]
    pub const fn polygon_count(&self) -> usize {
        if self.polygon_ends.is_empty() {
            self.corner_positions.len() / 3
        } else {
            self.polygon_ends.len()
        }
    }

    /// Whether every polygon is a triangle.
    #[must_use]
    pub(crate) const fn is_triangles(&self) -> bool {
        self.polygon_ends.is_empty()
    }

    /// The range of a polygon in the corner lists.
    ///
    /// # Panics
    /// Panics if the model has fewer polygons, unless all are triangles.
    #[must_use]
    pub fn corner_range(&self, polygon: usize) -> std::ops::Range<usize> {
        match (self.polygon_ends.is_empty(), polygon) {
            (true, _) => 3 * polygon..3 * polygon + 3,
            (false, 0) => 0..self.polygon_ends[0] as usize,
            (false, _) => {
                self.polygon_ends[polygon - 1] as usize..self.polygon_ends[polygon] as usize
            }
        }
    }

    /// The polygon of a corner.
    #[must_use]
    pub(crate) fn polygon_of(&self, corner: usize) -> usize {
        if self.polygon_ends.is_empty() {
            corner / 3
        } else {
            self.polygon_ends.partition_point(|&end| end as usize <= corner)
        }
    }

    /// A corner with all its indices.
    ///
    /// # Panics
    /// Panics if the model has fewer corners.
    #[must_use]
    pub fn corner(&self, corner: usize) -> Corner {
        Corner {
            position: self.corner_positions[corner],
            texcoord: self.corner_texcoords.get(corner).copied().unwrap_or(NONE),
            normal: self.corner_normals.get(corner).copied().unwrap_or(NONE),
            color: self.corner_colors.get(corner).copied().unwrap_or(NONE),
        }
    }

    /// The index into [`Model::colors`] of a corner: its own, or that of its position.
    ///
    /// # Panics
    /// Panics if the model has fewer corners.
    #[must_use]
    pub(crate) fn color_index(&self, corner: usize) -> u32 {
        let own = self.corner_colors.get(corner);
        own.copied().unwrap_or_else(|| self.corner_positions[corner])
    }

    /// The color of a corner, which is white if it has none.
    ///
    /// # Panics
    /// Panics if the model has fewer corners.
    #[must_use]
    pub fn corner_color(&self, corner: usize) -> [f32; 4] {
        self.colors.get(self.color_index(corner) as usize).copied().unwrap_or(WHITE)
    }

    /// The index of the color of a face, for its corners; it is added unless it is that of the
    /// last face.
    pub(crate) fn color_of_face(&mut self, color: [f32; 4]) -> u32 {
        if self.colors.last() != Some(&color) {
            self.colors.push(color);
        }
        to_u32(self.colors.len() - 1)
    }

    /// The place of a polygon in the file.
    #[must_use]
    pub(crate) fn polygon_place(&self, polygon: usize) -> Place {
        match self.polygon_lines.get(polygon) {
            Some(&line) if line > 0 => Place::Line(line),
            _ => Place::Face(polygon as u64 + 1),
        }
    }

    /// Adds a polygon of at least three corners; `line` is 0 if the format has no lines.
    ///
    /// The indices are not checked here: `firewall` checks those of every reader.
    pub fn push_polygon(&mut self, corners: &[Corner], line: u32) {
        let before = self.corner_positions.len();
        if corners.len() != 3 && self.polygon_ends.is_empty() {
            self.polygon_ends = (1..=to_u32(before / 3)).map(|polygon| 3 * polygon).collect();
        }
        if line > 0 || !self.polygon_lines.is_empty() {
            self.polygon_lines.resize(self.polygon_count(), 0);
            self.polygon_lines.push(line);
        }
        let has_texcoord = |corner: &Corner| corner.texcoord != NONE;
        if !self.corner_texcoords.is_empty() || corners.iter().any(has_texcoord) {
            self.corner_texcoords.resize(before, NONE);
            self.corner_texcoords.extend(corners.iter().map(|corner| corner.texcoord));
        }
        if !self.corner_normals.is_empty() || corners.iter().any(|corner| corner.normal != NONE) {
            self.corner_normals.resize(before, NONE);
            self.corner_normals.extend(corners.iter().map(|corner| corner.normal));
        }
        if !self.corner_colors.is_empty() || corners.iter().any(|corner| corner.color != NONE) {
            self.corner_colors.resize(before, NONE);
            self.corner_colors.extend(corners.iter().map(|corner| corner.color));
        }
        let is_mixed = corners.len() != 3 || !self.polygon_ends.is_empty();
        self.corner_positions.extend(corners.iter().map(|corner| corner.position));
        if is_mixed {
            self.polygon_ends.push(to_u32(self.corner_positions.len()));
        }
    }

    /// Sets the attributes of all polygons that are pushed from now on.
    pub fn set_attributes(&mut self, attributes: Attributes) {
        self.set_attributes_from(to_u32(self.polygon_count()), attributes);
    }

    /// Sets the attributes from `first_polygon` on, which is not before the start of the last
    /// run.
    pub(crate) fn set_attributes_from(&mut self, first_polygon: u32, attributes: Attributes) {
        if self.runs.last().is_some_and(|run| run.first_polygon == first_polygon) {
            self.runs.pop();
        }
        let before = self.runs.last().map_or_else(Attributes::default, |run| run.attributes);
        if before != attributes {
            self.runs.push(PolygonRun { first_polygon, attributes });
        }
    }

    /// Maps the attributes of each polygon to a value.
    #[must_use]
    pub(crate) fn per_polygon<T: Clone>(&self, value: impl Fn(Attributes) -> T) -> Vec<T> {
        let mut values = Vec::with_capacity(self.polygon_count());
        let first =
            self.runs.first().map_or(self.polygon_count(), |run| run.first_polygon as usize);
        values.resize(first, value(Attributes::default()));
        for (at, run) in self.runs.iter().enumerate() {
            let end = self
                .runs
                .get(at + 1)
                .map_or(self.polygon_count(), |next| next.first_polygon as usize);
            values.resize(end, value(run.attributes));
        }
        values
    }

    /// A model of polygons without attributes.
    #[must_use]
    pub fn from_polygons(positions: &[[f32; 3]], polygons: &[&[u32]]) -> Self {
        let positions = positions.iter().map(|point| point.map(f64::from)).collect();
        let mut model = Self { positions, ..Self::default() };
        for polygon in polygons {
            let corners: Vec<Corner> = polygon.iter().copied().map(Corner::at).collect();
            model.push_polygon(&corners, 0);
        }
        model
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_need_no_ends_until_a_quad_comes() {
        let mut model = Model::from_polygons(&[[0.0; 3]; 4], &[&[0, 1, 2], &[1, 2, 3]]);
        assert!(model.is_triangles());
        assert_eq!((model.polygon_count(), model.corner_range(1)), (2, 3..6));
        model.push_polygon(&[0, 1, 2, 3].map(Corner::at), 0);
        model.push_polygon(&[0, 1, 2].map(Corner::at), 7);
        assert_eq!(model.polygon_ends, [3, 6, 10, 13]);
        assert_eq!(model.polygon_lines, [0, 0, 0, 7]);
        assert_eq!((model.polygon_count(), model.corner_range(3)), (4, 10..13));
        assert_eq!(model.polygon_place(3), Place::Line(7));
        assert_eq!(model.polygon_place(0), Place::Face(1));
    }

    #[test]
    fn attributes_of_corners_begin_where_the_first_one_has_any() {
        let mut model = Model::from_polygons(&[[0.0; 3]; 3], &[&[0, 1, 2]]);
        assert_eq!(model.corner(2), Corner::at(2));
        model.push_polygon(&[0, 1, 2].map(|k| Corner { texcoord: k, ..Corner::at(k) }), 0);
        assert_eq!(model.corner_texcoords, [NONE, NONE, NONE, 0, 1, 2]);
        assert!(model.corner_normals.is_empty());
        assert_eq!(model.corner(4).texcoord, 1);
    }

    #[test]
    fn colors_are_those_of_corners_or_of_positions() {
        let mut model = Model::from_polygons(&[[0.0; 3]; 3], &[&[2, 1, 0]]);
        assert_eq!(model.corner_color(0), WHITE, "no colors at all");
        let [red, green, blue] = [[1., 0., 0., 1.], [0., 1., 0., 0.5], [0., 0., 1., 1.]];
        model.colors = vec![red, green, blue];
        assert_eq!([0, 1, 2].map(|corner| model.corner_color(corner)), [blue, green, red]);
        model.push_polygon(&[0, 1, 2].map(|k| Corner { color: 1, ..Corner::at(k) }), 0);
        assert_eq!(model.corner_colors, [NONE, NONE, NONE, 1, 1, 1]);
        assert_eq!([0, 3].map(|corner| model.corner_color(corner)), [WHITE, green]);
    }

    #[test]
    fn runs_cover_the_polygons_behind_them() {
        let mut model = Model::from_polygons(&[[0.0; 3]; 3], &[&[0, 1, 2]]);
        let attributes = Attributes { material: 4, ..Attributes::default() };
        model.set_attributes(Attributes::default());
        assert!(model.runs.is_empty(), "nothing new");
        model.set_attributes(Attributes { material: 9, ..attributes });
        model.set_attributes(attributes);
        for _ in 0..2 {
            model.push_polygon(&[0, 1, 2].map(Corner::at), 0);
        }
        assert_eq!(model.runs, [PolygonRun { first_polygon: 1, attributes }]);
        assert_eq!(model.per_polygon(|run| run.material), [NONE, 4, 4]);
    }
}
