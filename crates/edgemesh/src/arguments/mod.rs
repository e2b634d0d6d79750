//! Arguments that both commands take, as clap reads them. They become plain options, and
//! know no exit status.

mod camera;
mod degrees;
mod input;

pub use camera::CameraArguments;
pub use input::{CreaseArguments, InputArguments};
