//! The device, and what every part of the crate does with it.
//!
//! - [`device`]: the adapter and the device.
//! - `bind`: buffers, bind groups and compute pipelines.
//! - [`shader`]: WGSL with imports.
//! - [`target_formats`]: what pipelines and targets must agree on.
//! - [`readback`], [`timer`]: from the GPU back to memory.
//! - [`recent`]: what was made before and may be wanted again.

pub(crate) mod bind;
pub mod device;
pub mod readback;
pub mod recent;
pub mod shader;
pub mod target_formats;
pub mod timer;

pub use self::device::{Gpu, GpuError, ResourceError};
