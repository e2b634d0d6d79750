//! Images with their mip levels as textures.

use edgemesh::index::to_u32;
use image::RgbaImage;

use crate::gpu::device::Gpu;

/// Uploads an image as a texture of 8 bits per channel, without conversion.
///
/// `levels` are its mip levels, the largest first. Each side of a level is half that of the
/// level before, rounded down, and at least 1.
///
/// # Panics
/// If there are no levels.
#[must_use]
pub fn upload_levels(gpu: &Gpu, label: &str, levels: &[RgbaImage]) -> wgpu::TextureView {
    assert!(!levels.is_empty(), "an image has at least one level");
    let extent = |level: &RgbaImage| wgpu::Extent3d {
        width: level.width(),
        height: level.height(),
        depth_or_array_layers: 1,
    };
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: extent(&levels[0]),
        mip_level_count: to_u32(levels.len()),
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for (mip_level, level) in (0..).zip(levels) {
        gpu.queue.write_texture(
            wgpu::TexelCopyTextureInfo { mip_level, ..texture.as_image_copy() },
            level.as_raw(),
            wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(4 * level.width()),
                rows_per_image: None,
            },
            extent(level),
        );
    }
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}
