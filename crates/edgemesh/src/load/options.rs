//! Options of loading.

use std::path::PathBuf;

use super::marks::SideMarks;
use crate::build::{BuildOptions, Welding};
use crate::format::read::Format;

/// Options for reading and building an input.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadOptions {
    /// The format. Default: detected from the content, then from the name; standard input needs
    /// a format.
    pub format: Option<InputFormat>,
    /// The vertices of a model that become one. Default: [`Welding::Exact`]. An edge mesh is
    /// already welded and fails to load with this option.
    pub welding: Option<Welding>,
    /// The file of marks. Default: [`side_file`](super::side_file) of the model, if it exists. An
    /// edge mesh fails to load with this option.
    pub marks: Option<PathBuf>,
    /// Whether warnings are errors. Default: false.
    pub is_strict: bool,
    /// The angle between the faces of a convex edge above which it is a ridge, in radians.
    /// Default: that of [`BuildOptions`]; an edge mesh, or an export that states them, keeps the
    /// creases of its file.
    pub ridge_angle_rad: Option<f64>,
    /// As `ridge_angle_rad`, for concave edges and valleys.
    pub valley_angle_rad: Option<f64>,
    /// Whether the fill is built, which only shading needs. Default: true.
    pub with_fill: bool,
    /// Whether skins and morph targets are kept, which only exports need. Default: false.
    pub with_rig: bool,
    /// Whether a large mesh that a model has in several places is kept once, in
    /// [`LoadedMesh::instanced`](super::LoadedMesh::instanced), instead of being copied. Welding
    /// does not join its places; its tolerance counts in the first of them. Default: false.
    pub with_instances: bool,
}

impl Default for LoadOptions {
    fn default() -> Self {
        Self {
            format: None,
            welding: None,
            marks: None,
            is_strict: false,
            ridge_angle_rad: None,
            valley_angle_rad: None,
            with_fill: true,
            with_rig: false,
            with_instances: false,
        }
    }
}

/// The format of an input.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum InputFormat {
    /// A model format.
    Model(Format),
    /// The edge mesh file.
    EdgeMesh,
}

impl LoadOptions {
    /// The angles above which edges of models are ridges and valleys, in radians.
    #[must_use]
    pub fn crease_angles_rad(&self) -> [f64; 2] {
        let default = BuildOptions::default();
        [
            self.ridge_angle_rad.unwrap_or(default.ridge_angle_rad),
            self.valley_angle_rad.unwrap_or(default.valley_angle_rad),
        ]
    }

    /// Whether a crease angle is given.
    pub(super) const fn has_crease_angles(&self) -> bool {
        self.ridge_angle_rad.is_some() || self.valley_angle_rad.is_some()
    }

    /// The builder's options, with marks.
    pub(super) fn build_options(&self, marks: SideMarks) -> BuildOptions {
        let [ridge_angle_rad, valley_angle_rad] = self.crease_angles_rad();
        BuildOptions {
            ridge_angle_rad,
            valley_angle_rad,
            welding: self.welding.unwrap_or_default(),
            marks: marks.marked,
            unmarked: marks.unmarked,
            with_fill: self.with_fill,
            ..BuildOptions::default()
        }
    }
}
