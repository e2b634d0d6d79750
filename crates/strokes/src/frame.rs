//! What one view needs, the same for every pass: `@group(0)` everywhere.

use bytemuck::{Pod, Zeroable};
use edgemesh::camera::View;
use glam::Vec2;
use wgpu::util::DeviceExt as _;

/// The uniform of a view. WGSL twin: `shaders/common/frame.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct FrameUniform {
    /// Takes world positions to clip space; depth 1 near, 0 far.
    pub clip_from_world: [[f32; 4]; 4],
    /// The eye with w = 1, or the direction to the viewer with w = 0.
    pub eye: [f32; 4],
    /// Size of the picture.
    pub viewport_px: [f32; 2],
    /// Unused.
    pub padding: [f32; 2],
}

impl FrameUniform {
    /// The uniform of `view` on a picture of `viewport_px`.
    #[must_use]
    pub fn new(view: &View, viewport_px: Vec2) -> Self {
        Self {
            clip_from_world: view.clip_from_world.to_cols_array_2d(),
            eye: view.eye.to_array(),
            viewport_px: viewport_px.to_array(),
            padding: [0.0; 2],
        }
    }
}

/// The layout that all pipelines share for `@group(0)`.
#[must_use]
pub fn frame_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let visibility = wgpu::ShaderStages::VERTEX_FRAGMENT | wgpu::ShaderStages::COMPUTE;
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("frame"),
        entries: &[uniform_entry(0, visibility)],
    })
}

/// The frame's uniform buffer and bind group.
#[derive(Debug)]
pub struct Frame {
    buffer: wgpu::Buffer,
    pub(crate) bind_group: wgpu::BindGroup,
}

impl Frame {
    /// Makes the buffer, holding `uniform`.
    #[must_use]
    pub fn new(
        device: &wgpu::Device,
        layout: &wgpu::BindGroupLayout,
        uniform: &FrameUniform,
    ) -> Self {
        let buffer = uniform_buffer(device, "frame", uniform);
        let bind_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("frame"),
            layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }],
        });
        Self { buffer, bind_group }
    }

    /// Replaces the view for the next submission.
    pub fn write(&self, queue: &wgpu::Queue, uniform: &FrameUniform) {
        queue.write_buffer(&self.buffer, 0, bytemuck::bytes_of(uniform));
    }
}

/// A uniform buffer that holds `value`.
pub(crate) fn uniform_buffer<T: Pod>(
    device: &wgpu::Device,
    label: &str,
    value: &T,
) -> wgpu::Buffer {
    device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: Some(label),
        contents: bytemuck::bytes_of(value),
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
    })
}

/// A layout entry for a uniform buffer.
pub(crate) const fn uniform_entry(
    binding: u32,
    visibility: wgpu::ShaderStages,
) -> wgpu::BindGroupLayoutEntry {
    buffer_entry(binding, visibility, wgpu::BufferBindingType::Uniform)
}

/// A layout entry for a storage buffer.
pub(crate) const fn storage_entry(
    binding: u32,
    visibility: wgpu::ShaderStages,
    read_only: bool,
) -> wgpu::BindGroupLayoutEntry {
    buffer_entry(binding, visibility, wgpu::BufferBindingType::Storage { read_only })
}

const fn buffer_entry(
    binding: u32,
    visibility: wgpu::ShaderStages,
    ty: wgpu::BufferBindingType,
) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility,
        ty: wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None },
        count: None,
    }
}
