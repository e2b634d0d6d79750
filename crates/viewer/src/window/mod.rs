//! The window: a picture that is turned, and panels that change it.
//!
//! ```text
//!   command line, files, drops --> Session <--> panels
//!   pointer, keys -------------->    |
//!                                  Canvas --> PictureRenderer --> texture --> window
//! ```
//!
//! - `session`: what is shown and known, without GPU; `recipe`, `viewpoint`: what makes a
//!   picture, as a command line; `messages`, `remembered`.
//! - `navigation`: from hands to viewpoints; `light_hand`: to light and cuts. `background`, `loading`: models on another thread.
//!   `picking`: what is under the pointer. `watching`: files that change.
//! - `canvas`: the session as a picture, drawn when something changed; `picture_paint`: its
//!   pixels on the window.
//! - `inspection`: what passes draw for each other, shown. `marking`: edges marked by hand.
//!   `saving`, `thumbnails`: pictures drawn on the side.
//! - `opening`: the window opens, and again where its device was lost;
//!   `device_loss`: what it learns then and takes over.
//! - `style`: what the window looks like. `desktop`: light or dark as the desktop is, and its
//!   dialogs. `error_text`: errors as the window words them.
//! - `app`: one frame of the window. `hands`: pointer and keys. `panels`: what is beside the picture.

mod app;
pub mod background;
mod canvas;
mod desktop;
mod device_loss;
mod error_text;
pub mod hands;
pub mod inspection;
pub mod light_hand;
pub mod loading;
pub mod marking;
pub mod messages;
pub mod navigation;
mod opening;
pub mod panels;
pub mod picking;
mod picture_paint;
pub mod recipe;
pub mod remembered;
pub mod saving;
pub mod session;
mod style;
pub mod thumbnails;
pub mod viewpoint;
pub mod watching;

pub(crate) use opening::run;
