//! The order of a frame.
//!
//! - `renderer`: the interface for programs; `frame_request`: the parts of a frame.
//! - `options`: the kind of meshes and targets; `error`: why they do not fit together.
//! - `pipelines`: all pipelines; `prepared_style`: a style with its pipelines.
//! - `drawing`: the lists and graphs of the instances; `scene_view`: all of it for one eye.
//! - `frame_encoder`: the passes that draw.

pub(crate) mod drawing;
pub(crate) mod error;
mod frame_encoder;
pub(crate) mod frame_request;
pub(crate) mod options;
mod pipelines;
pub(crate) mod prepared_style;
pub(crate) mod renderer;
pub(crate) mod scene_view;
