//! How an input is read and built.

use std::path::PathBuf;

use super::marks::SideMarks;
use crate::build::{BuildOptions, Welding};
use crate::format::read::Format;

/// How an input is read and built.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadOptions {
    /// The format. Default: detected from the content, then from the name; standard input
    /// needs one.
    pub format: Option<InputFormat>,
    /// Which vertices of a model become one. Default: [`Welding::Exact`]; an edge mesh is
    /// welded already and fails to load if any is given.
    pub welding: Option<Welding>,
    /// A file of marks. Default: the one beside the model
    /// ([`side_file`](super::marks::side_file)), if it exists; an edge mesh fails to load if
    /// any is given.
    pub marks: Option<PathBuf>,
    /// Whether warnings are errors. Default: no.
    pub is_strict: bool,
    /// Convex edges whose faces turn by more than this are ridges, in radians. Default: that
    /// of [`BuildOptions`]; an edge mesh keeps the creases of its file.
    pub ridge_angle_rad: Option<f64>,
    /// Concave edges whose faces turn by more than this are valleys, in radians. Default: as
    /// for ridges.
    pub valley_angle_rad: Option<f64>,
    /// Whether the fill is built, which only shading needs. Default: yes.
    pub with_fill: bool,
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
        }
    }
}

/// A format of inputs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum InputFormat {
    /// A model format.
    Model(Format),
    /// The edge mesh file.
    EdgeMesh,
}

impl LoadOptions {
    /// The angles in radians above which edges are ridges and valleys in models.
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
