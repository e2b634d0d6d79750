//! Draws 3D models as line art: techniques, pictures, the window, and the `viewer` command.
//!
//! ```text
//! MODEL... --read, build (edgemesh)--> edge meshes --upload (strokes)--+
//! technique + --set --> Plan --> PassGraph ----------------------------+--> frame --> PNG, statistics
//! camera options --> View ---------------------------------------------+
//! ```
//!
//! The rooms, in the order in which a picture goes through them:
//!
//! | room | what is done there |
//! |---|---|
//! | [`technique`] | text files become passes with values, and a plan; no GPU |
//! | [`scene`] | models in their places, light and cuts |
//! | [`pass_graph`] | a plan on the GPU: pipelines, textures, steps |
//! | [`picture`] | a picture of any size, PNG files, turntables |
//! | `comparison` | stroke textures, measured along camera paths |
//! | `arguments` | a picture as the words of a command line |
//! | `window` | the window, a feature that is on by default |
//! | [`command`] | the verbs of `viewer`; `main.rs` only calls it |
//!
//! [`Error`] lists what can go wrong; [`watch`] reports files that change.

#![warn(clippy::print_stdout, clippy::print_stderr)]
#![cfg_attr(
    not(feature = "window"),
    expect(dead_code, reason = "only the window resizes pictures and writes techniques")
)]

mod arguments;
pub mod command;
mod comparison;
mod error;
pub mod pass_graph;
pub mod picture;
pub mod scene;
pub mod technique;
pub mod watch;
#[cfg(feature = "window")]
pub mod window;

pub use error::{Error, ImageError, SceneFileError};
