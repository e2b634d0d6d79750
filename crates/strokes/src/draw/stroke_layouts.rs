//! The bind group layouts of strokes.
//!
//! No shader of strokes reads more than three uniform buffers: Mesa's software Vulkan driver
//! (22.3) crashes on a fourth if the shader branches on its contents.

use wgpu::ShaderStages;

use crate::draw::targets::frame_fill_layout;
use crate::gpu::bind::{bind_layout, storage_entry, uniform_entry};
use crate::gpu::target_formats::TargetFormats;
use crate::mesh::layout::Layout;

/// The bind group layouts of strokes in one layout of edges.
#[derive(Debug)]
pub(crate) struct StrokeLayouts {
    /// `@group(0)`.
    pub(crate) frame: wgpu::BindGroupLayout,
    /// `@group(0)` of strokes that read the fill.
    pub(crate) frame_fill: wgpu::BindGroupLayout,
    /// `@group(1)`: the style.
    pub(crate) pass: wgpu::BindGroupLayout,
    /// `@group(2)` of shaders that read edges from buffers: the object and the edges.
    pub(crate) edges: wgpu::BindGroupLayout,
    /// `@group(2)` of shaders that get edges as vertices: the object.
    pub(crate) object: wgpu::BindGroupLayout,
    /// `@group(3)` of the expansion: live list, arguments, vertices.
    pub(crate) expand: wgpu::BindGroupLayout,
    /// `@group(3)` of strokes from the list: live list, arguments.
    pub(crate) listed: wgpu::BindGroupLayout,
    /// `@group(3)` of strokes of all edges: face planes.
    pub(crate) planes: wgpu::BindGroupLayout,
}

impl StrokeLayouts {
    pub(crate) fn new(
        device: &wgpu::Device,
        frame: &wgpu::BindGroupLayout,
        layout: Layout,
        formats: &TargetFormats,
    ) -> Self {
        let make = |label: &str, entries: &[wgpu::BindGroupLayoutEntry]| {
            bind_layout(device, label, entries)
        };
        let both = ShaderStages::VERTEX | ShaderStages::COMPUTE;
        let read = |binding, visibility| storage_entry(binding, visibility, true);
        let (vertex, compute) = (ShaderStages::VERTEX, ShaderStages::COMPUTE);
        let mut edges = vec![uniform_entry(0, both), uniform_entry(1, both), read(2, both)];
        if layout == Layout::Indexed {
            edges.extend([3, 4, 5].map(|binding| read(binding, both)));
        }
        let write = storage_entry(2, compute, false);
        Self {
            frame: frame.clone(),
            frame_fill: frame_fill_layout(device, formats),
            pass: make("stroke style", &style_entries()),
            edges: make("stroke edges", &edges),
            object: make("stroke object", &[uniform_entry(0, both), uniform_entry(1, both)]),
            expand: make("expand strokes", &[read(0, compute), read(1, compute), write]),
            listed: make("listed strokes", &[read(0, vertex), read(1, vertex)]),
            planes: make("all strokes", &[read(0, vertex)]),
        }
    }

    /// The four groups of a pipeline, with `draw` as the third and `view` as the fourth.
    pub(crate) const fn groups<'a>(
        &'a self,
        draw: Option<&'a wgpu::BindGroupLayout>,
        view: Option<&'a wgpu::BindGroupLayout>,
    ) -> [Option<&'a wgpu::BindGroupLayout>; 4] {
        [Some(&self.frame), Some(&self.pass), draw, view]
    }
}

fn style_entries() -> [wgpu::BindGroupLayoutEntry; 3] {
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: ShaderStages::FRAGMENT,
        ty,
        count: None,
    };
    let texture = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: true },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let all = ShaderStages::VERTEX_FRAGMENT | ShaderStages::COMPUTE;
    [
        uniform_entry(0, all),
        entry(1, texture),
        entry(2, wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering)),
    ]
}
