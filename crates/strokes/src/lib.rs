//! Finds the feature edges of edge meshes on the GPU and draws them as thick
//! strokes, with no work on the CPU that grows with the mesh.
//!
//! Based on M. McGuire and J. F. Hughes, *Hardware-Determined Feature Edges*
//! (NPAR 2004), sections 3 to 3.3, with compute shaders where the paper had
//! vertex programs only.
//!
//! ```text
//! EdgeMesh --upload--> MeshBuffers
//!     detect: facing bit a face -> live edges, in order -> arguments of the draw
//!     fill:   depth and a flat colour
//!     strokes: 12 vertices a live edge, pulled by index
//! ```
//!
//! Each primitive is one file with the same skeleton: an `XPipeline`, built once
//! and never changed, and what one mesh needs for it in [`mesh_buffers`]. The
//! crate knows no file format, no technique and no window.

#![warn(clippy::print_stdout, clippy::print_stderr)]

pub mod brush;
pub mod detect;
pub mod fill;
pub mod frame;
pub mod gpu;
pub mod gpu_time;
pub mod mesh_buffers;
pub mod readback;
pub mod renderer;
pub mod shader;
pub mod stroke;
pub mod targets;
