//! Arguments of a picture, as clap reads them, for `viewer render` and the window. They
//! become plain options and know no exit status.
//!
//! - `library`: folders of techniques. `lighting`: light and clip planes.
//! - `picture`: all arguments of a picture except the models and the size.
//! - `camera`, `words`: the camera, and whole pictures, as the words of a command line, for
//!   the window alone.

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
