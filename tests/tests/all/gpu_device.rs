//! The GPU device, which all tests of a process share.

use std::sync::OnceLock;

use strokes::Gpu;

/// The device; tests fail, and are not skipped, without an adapter.
pub(crate) fn gpu() -> &'static Gpu {
    static GPU: OnceLock<Gpu> = OnceLock::new();
    GPU.get_or_init(|| match pollster::block_on(Gpu::open(None)) {
        Ok(gpu) => gpu,
        Err(error) => panic!("the feature 'gpu' needs an adapter: {error}"),
    })
}

/// Another device, with other limits.
pub(crate) fn gpu_with_limits(adjust: impl FnOnce(&mut wgpu::Limits)) -> Gpu {
    match pollster::block_on(Gpu::open_with(None, adjust)) {
        Ok(gpu) => gpu,
        Err(error) => panic!("the feature 'gpu' needs an adapter: {error}"),
    }
}

/// Whether this is the software driver that drew the goldens.
pub(crate) fn is_pinned_driver() -> bool {
    let info = &gpu().info;
    info.name.starts_with("llvmpipe") && info.driver_info.starts_with("Mesa 22.3")
}
