//! Finds the feature edges of edge meshes on the GPU and draws them as thick
//! strokes, with no work on the CPU that grows with the mesh.
//!
//! Based on M. McGuire and J. F. Hughes, *Hardware-Determined Feature Edges*
//! (NPAR 2004), sections 3 and 4, with compute shaders where the paper had vertex
//! programs only; its own path and layouts are there too, to compare with.
//!
//! ```text
//! EdgeMesh --upload--> MeshBuffers (in chunks) --+
//! Look --prepare--> PreparedLook ----------------+--> Object
//!                                                       |
//!     detect: facing bit a face -> live edges by layer  |  each frame
//!     expand: the vertices of each live stroke, once    |
//!     link:   or chains of edges, for linked strokes    |
//!     fill:   depth, a flat colour, stencil             |
//!     paths:  chains to ribbons, by the depth           |
//!     coverage, strokes: hidden, visible, silhouettes   v
//! ```
//!
//! Each primitive is one file with the same skeleton: an `XPipeline`, built once
//! and never changed, and what one mesh needs for it. The crate knows no file
//! format, no technique and no window.

#![warn(clippy::print_stdout, clippy::print_stderr)]

pub mod draw;
pub mod gpu;
pub mod graph;
pub mod mesh;
pub mod renderer;
pub mod style;
pub mod view;
