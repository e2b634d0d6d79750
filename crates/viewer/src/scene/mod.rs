//! What is drawn: models in their places, and the light that falls on them.
//!
//! - [`scene_file`]: objects as a text file has them.
//! - [`models`]: models in memory, and where they stand.
//! - [`object_techniques`]: the techniques that objects of scene files have.
//! - [`lighting`]: the light, and planes that cut the scene.

pub mod lighting;
pub mod models;
pub mod object_techniques;
pub mod scene_file;
