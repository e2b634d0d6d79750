//! Arguments of both commands, as clap reads them; they become plain options and know no exit
//! status.
//!
//! Shared by the programs `edgemesh` and `viewer` and hidden from the documentation: other
//! programs use [`LoadOptions`](crate::load::LoadOptions) and [`Camera`](crate::view::Camera).

mod camera;
mod degrees;
mod input;

pub use camera::CameraArguments;
pub use input::{CreaseArguments, InputArguments};
