//! The device that all GPU tests of this process share.

use std::sync::OnceLock;

use strokes::Gpu;

/// The device; no test passes by being skipped where there is none.
pub(crate) fn gpu() -> &'static Gpu {
    static GPU: OnceLock<Gpu> = OnceLock::new();
    GPU.get_or_init(|| match pollster::block_on(Gpu::open(None)) {
        Ok(gpu) => gpu,
        Err(error) => panic!("the feature 'gpu' needs an adapter: {error}"),
    })
}

/// A device of its own with other limits.
pub(crate) fn gpu_with_limits(adjust: impl FnOnce(&mut wgpu::Limits)) -> Gpu {
    match pollster::block_on(Gpu::open_with(None, adjust)) {
        Ok(gpu) => gpu,
        Err(error) => panic!("the feature 'gpu' needs an adapter: {error}"),
    }
}

/// Whether this is the software driver that the goldens were drawn on.
pub(crate) fn is_pinned_driver() -> bool {
    let info = &gpu().info;
    info.name.starts_with("llvmpipe") && info.driver_info.starts_with("Mesa 22.3")
}
