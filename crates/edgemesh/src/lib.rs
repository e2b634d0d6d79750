//! Turns a triangle mesh into an **edge mesh**: every undirected edge a record
//! of its two vertices, its two faces and its classes, ready for the GPU to find
//! the feature edges of any view.
//!
//! Based on M. McGuire and J. F. Hughes, *Hardware-Determined Feature Edges*
//! (NPAR 2004), sections 1 to 3.
//!
//! ```text
//! file --read--> Model --build--> EdgeMesh + Report
//!                                   |--> records, planes, positions --> GPU (crate strokes)
//!                                   '--> oracle: the same decisions and corners on the CPU
//! ```
//!
//! - [`read`]: files in, [`model::Model`] out, every error with file and line.
//! - [`build`]: weld, repair, classify; one stage a file.
//! - [`load`]: a file to an edge mesh in one call, with the marks beside it.
//! - [`export`]: the mesh and its edges for other programs: glTF, PLY, OBJ, JSON.
//! - [`mod@file`]: edge meshes on disk, with a checksum, used where they lie.
//! - [`oracle`]: the CPU twin of the shaders, and the reference they are held to.
//! - [`camera`]: the eye and the clip-space matrix, the same for every command.
//!
//! ```
//! use edgemesh::{build, camera::Camera, model::Model, oracle, report::Report};
//!
//! let corners = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]];
//! let model = Model::from_polygons(&corners, &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[0, 3, 2]]);
//! let mesh = build::build_edge_mesh(&model, &build::BuildOptions::default(), &mut Report::default());
//! let view = Camera::default_view(&mesh.bounds).view(&mesh.bounds, 1.0);
//! let features = oracle::count_features(&mesh, view.eye);
//! assert_eq!(mesh.records.len(), 6);
//! assert_eq!(features.contour, 3);
//! ```

#![warn(clippy::print_stdout, clippy::print_stderr)]

#[cfg(feature = "command")]
pub mod arguments;
pub mod build;
#[cfg(feature = "command")]
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
