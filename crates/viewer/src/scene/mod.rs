//! Scenes: models in their places, and the light.
//!
//! - `scene_file`: scene files.
//! - `models`: models in memory, with their places.
//! - `object_techniques`: the overrides of scene files.
//! - `lighting`: light and clip planes.
//! - `sight`: the nearest surface in sight.

pub mod lighting;
pub mod models;
pub(crate) mod object_techniques;
pub mod scene_file;
pub(crate) mod sight;
