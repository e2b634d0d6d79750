//! The order of a frame.
//!
//! - [`renderer`]: what programs call; [`frame_request`]: what a frame is drawn from.
//! - [`pipelines`]: all pipelines; [`prepared_style`]: a style with its pipelines.
//! - [`drawing`]: what a view makes of the instances; [`scene_view`]: all of it for one eye.
//! - `frame_encoder`: the passes that draw.

pub mod drawing;
pub mod error;
mod frame_encoder;
pub mod frame_request;
pub mod pipelines;
pub mod prepared_style;
pub mod renderer;
pub mod scene_view;
