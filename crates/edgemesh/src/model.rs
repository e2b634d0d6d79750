//! What a file says, before anything is made of it.
//!
//! Polygons stay polygons here: the diagonal that cuts a quad is no edge of
//! the model, and only who still knows the polygon can tell.

use crate::index::NONE;

/// A polygonal model as its file describes it.
#[derive(Debug, Clone, Default)]
pub struct Model {
    /// How the model is called in messages: the path it was read from.
    pub name: String,
    /// Vertices listed in the file, used or not.
    pub vertex_count_in_file: usize,
    /// Positions that polygons use, in the file's own units.
    pub positions: Vec<[f32; 3]>,
    /// Texture coordinates that corners use.
    pub texcoords: Vec<[f32; 2]>,
    /// Normals that corners use, of any length.
    pub normals: Vec<[f32; 3]>,
    /// The corners of all polygons, polygon by polygon.
    pub corners: Vec<Corner>,
    /// The polygons, in file order.
    pub polygons: Vec<Polygon>,
    /// Materials in the order of their first use.
    pub materials: Vec<Material>,
    /// Whether the file states smoothing groups at all.
    pub has_smoothing_groups: bool,
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
}

impl Corner {
    /// A corner with nothing but a position.
    #[must_use]
    pub const fn at(position: u32) -> Self {
        Self { position, texcoord: NONE, normal: NONE }
    }
}

/// One face of the file: three corners or more.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Polygon {
    /// Index of its first corner in [`Model::corners`].
    pub first_corner: u32,
    /// How many corners it has.
    pub corner_count: u32,
    /// Index into [`Model::materials`], or [`NONE`].
    pub material: u32,
    /// The smoothing group; 0 is off.
    pub smoothing_group: u32,
    /// The line of the file, counted from 1; 0 where there is no file.
    pub line: u32,
}

impl Polygon {
    /// The range of its corners in [`Model::corners`].
    #[must_use]
    pub const fn corner_range(&self) -> std::ops::Range<usize> {
        self.first_corner as usize..(self.first_corner + self.corner_count) as usize
    }
}

/// A material by name, with the colours its library gives it, if any does.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Material {
    /// The name that `usemtl` gives.
    pub name: String,
    /// Ambient colour, linear, 0 to 1 (`Ka`).
    pub ambient: Option<[f32; 3]>,
    /// Diffuse colour, linear, 0 to 1 (`Kd`).
    pub diffuse: Option<[f32; 3]>,
    /// Specular colour, linear, 0 to 1 (`Ks`).
    pub specular: Option<[f32; 3]>,
    /// Specular exponent (`Ns`).
    pub shininess: Option<f32>,
    /// Opacity, 0 to 1 (`d`, or 1 - `Tr`).
    pub opacity: Option<f32>,
    /// The diffuse texture's file name as written (`map_Kd`); nothing opens it.
    pub diffuse_texture: Option<String>,
}

impl Model {
    /// Adds a polygon that has nothing but positions; for models made in code.
    ///
    /// `positions` are indices into [`Model::positions`].
    pub fn push_polygon(&mut self, positions: &[u32]) {
        let first_corner = crate::index::to_u32(self.corners.len());
        self.corners.extend(positions.iter().copied().map(Corner::at));
        self.polygons.push(Polygon {
            first_corner,
            corner_count: crate::index::to_u32(positions.len()),
            material: NONE,
            smoothing_group: 0,
            line: 0,
        });
    }

    /// A model of bare polygons; for tests, benches and generators.
    #[must_use]
    pub fn from_polygons(positions: &[[f32; 3]], polygons: &[&[u32]]) -> Self {
        let mut model = Self {
            vertex_count_in_file: positions.len(),
            positions: positions.to_vec(),
            ..Self::default()
        };
        for polygon in polygons {
            model.push_polygon(polygon);
        }
        model
    }
}
