//! Arguments that make a picture, as clap reads them, for `viewer render` and the window
//! alike. They become plain options, and know no exit status.
//!
//! - `library`: where techniques come from. `lighting`: the light, and what cuts the scene.
//! - `picture`: everything that makes a picture but the models and its size.

mod library;
mod lighting;
mod picture;

pub(crate) use library::LibraryArguments;
pub(crate) use picture::PictureArguments;
