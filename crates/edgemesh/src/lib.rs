//! Turns a triangle mesh into an **edge mesh**: a record for every undirected edge, with its two
//! vertices, its two faces and its classes. From these records a GPU finds the feature edges of
//! any view.
//!
//! Based on M. McGuire and J. F. Hughes, *Hardware-Determined Feature Edges* (NPAR 2004),
//! sections 1 to 3.
//!
//! | module | content |
//! |---|---|
//! | [`load`] | reads a file and builds its edge mesh, in one call |
//! | [`model`] | polygons, materials and rigs, as files have them |
//! | [`format`](mod@format) | reads models, writes edge mesh files, exports |
//! | [`build`] | builds the edge mesh of a model |
//! | [`edge_mesh`] | the edge mesh, its records and layouts |
//! | [`line`](mod@line) | line classes, kinds of lines, their placement |
//! | [`view`] | cameras, facing and feature edges of one view |
//! | [`report`] | warnings and repairs |
//! | [`index`] | limits of indices |
//! | [`oracle`] | CPU twins of the shaders |
//!
//! ```
//! use edgemesh::{BuildOptions, Camera, LineClass, Model, Report, build_edge_mesh, count_features};
//!
//! let corners = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]];
//! let model = Model::from_polygons(&corners, &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[0, 3, 2]]);
//! let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default());
//! let view = Camera::default_view(&mesh.bounds).view(&mesh.bounds, 1.0);
//! let features = count_features(&mesh, view.eye);
//! assert_eq!(mesh.records.len(), 6);
//! assert_eq!(features[LineClass::Contour], 3);
//! ```

#![warn(clippy::print_stdout, clippy::print_stderr)]

#[cfg(feature = "command")]
#[doc(hidden)]
pub mod arguments;
pub mod build;
#[cfg(feature = "command")]
#[doc(hidden)]
pub mod command;
pub mod edge_mesh;
pub mod format;
pub mod index;
pub mod line;
pub mod load;
pub mod model;
pub mod oracle;
pub mod report;
pub mod view;

pub use glam;

pub use self::build::{BuildOptions, build_edge_mesh};
pub use self::edge_mesh::{Bounds, EdgeMesh};
pub use self::format::read::{ReadError, read_model};
pub use self::line::LineClass;
pub use self::model::Model;
pub use self::report::Report;
pub use self::view::{Camera, FeatureCounts, View, count_features};
