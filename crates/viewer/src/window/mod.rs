//! The window: a picture that can be turned, and panels that change it.
//!
//! ```text
//!   command line, files, drops --> Session <--> panels
//!   pointer, keys -------------->    |
//!                                  Canvas --> PictureRenderer --> texture --> window
//! ```
//!
//! - `session`: the state of the window, without a GPU; `recipe`, `viewpoint`: the state of a
//!   picture, as a command line; `messages`, `remembered`.
//! - `navigation`, `light_hand`: drags and keys to viewpoints, light and cuts. `picking`: the
//!   triangle under the pointer.
//! - `background`: work on other threads; `loading`, `saving`, `thumbnails`, `watching`.
//! - `canvas`: draws the session when it has changed; `picture_paint`: paints the picture.
//! - `inspection`: shows textures between passes. `marking`: edges marked by hand.
//! - `opening`: opens the window, and again after `device_loss`.
//! - `style`, `desktop`: colors, fonts, theme and file dialogs. `error_text`: errors in the
//!   words of the window.
//! - `app`: one frame. `hands`: pointer and keys. `panels`: everything beside the picture.

mod app;
mod background;
mod canvas;
mod desktop;
mod device_loss;
mod error_text;
pub mod hands;
pub mod inspection;
mod light_hand;
mod loading;
mod marking;
mod messages;
pub mod navigation;
mod opening;
pub mod panels;
mod picking;
mod picture_paint;
pub mod recipe;
pub mod remembered;
pub mod saving;
pub mod session;
mod style;
mod thumbnails;
pub mod viewpoint;
mod watching;

pub use messages::Messages;
pub(crate) use opening::run;
