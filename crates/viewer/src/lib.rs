//! Draws 3D models as line art: looks, pictures, the window, and the `viewer` command.
//!
//! ```text
//! MODEL... --read, build (edgemesh)--> edge meshes --upload (strokes)--+
//! technique + --set --> Look --> pipelines ----------------------------+--> frame --> PNG, statistics
//! camera options --> View ---------------------------------------------+
//! ```
//!
//! - [`technique`]: what a picture looks like, by name, with its variables.
//! - [`render`]: a scene of edge meshes to pictures, without any window.
//! - [`parts`]: pictures of any size, in parts where they are too large.
//! - [`picture`]: PNG in and out, and the comparison with a reference.
//! - [`animation`]: several pictures as a GIF or an animated PNG.
//! - [`comparison`]: stroke textures, measured along camera paths.
//! - [`turntable`]: a camera that goes around.
//! - [`Error`]: what can go wrong.
//! - [`window`]: the window.
//! - [`command`]: the command line; `main.rs` only calls it.

#![warn(clippy::print_stdout, clippy::print_stderr)]

mod arguments;
pub mod command;
pub mod comparison;
pub mod error;
pub mod pass_graph;
pub mod picture;
pub mod scene;
pub mod technique;
pub mod watch;
pub mod window;

pub use error::Error;
