//! The device, and how every room uses it.
//!
//! - `device`: the adapter and the device.
//! - `bind`: buffers, bind groups and compute pipelines.
//! - `shader`: WGSL with imports.
//! - `texture`: images with their mip levels.
//! - `target_formats`: the formats that pipelines and targets must agree on.
//! - `readback`, `timer`: from the GPU back to memory.
//! - `recent`: a cache of what was used last.

pub(crate) mod bind;
pub(crate) mod device;
pub(crate) mod readback;
pub(crate) mod recent;
pub(crate) mod shader;
pub(crate) mod target_formats;
pub(crate) mod texture;
pub(crate) mod timer;
