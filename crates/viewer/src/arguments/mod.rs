//! Arguments that make a picture, as clap reads them, for `viewer render` and the window
//! alike. They become plain options, and know no exit status.
//!
//! - `library`: where techniques come from. `lighting`: the light, and what cuts the scene.
//! - `picture`: everything that makes a picture but the models and its size.
//! - `camera`, `words`: the camera, and whole pictures, as the words of a command line, for the
//!   window alone.

#[cfg(feature = "window")]
mod camera;
mod library;
mod lighting;
mod picture;
#[cfg(feature = "window")]
mod words;

#[cfg(feature = "window")]
pub(crate) use camera::{camera_words, read_camera};
#[cfg(feature = "window")]
pub(crate) use edgemesh::arguments::CameraArguments;
pub(crate) use library::LibraryArguments;
pub(crate) use picture::PictureArguments;
#[cfg(feature = "window")]
pub(crate) use words::{PictureWords, read_words, render_command, shell_line};
