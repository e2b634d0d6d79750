//! `copy_to_texture`: copies the current picture, or its depth, to a texture (NPRView
//! thesis, section 2.3).
//!
//! A color is the average of a pixel's samples. The depth is that of the first sample,
//! since no surface has an average of depths.

use strokes::{Gpu, TargetFormats, TimedPasses, shader_module};

use super::Encoding;
use super::bindings::Sources;
use super::screen_pass::screen_vertex;
use super::textures::wgpu_format;
use crate::error::Error;
use crate::technique::core_view::CopyToTexture;
use crate::technique::plan::{PassPlan, Target};
use crate::technique::texture_format::TextureFormat;

/// A copy of the framebuffer.
#[derive(Debug)]
pub(crate) struct CopyPass {
    /// None if the color is copied.
    depth: Option<DepthCopy>,
}

/// Copies the depth to a texture.
#[derive(Debug)]
struct DepthCopy {
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
}

impl CopyPass {
    pub(crate) fn new(
        gpu: &Gpu,
        view: &CopyToTexture,
        formats: &TargetFormats,
    ) -> Result<Self, Error> {
        let depth = view.is_depth.then(|| DepthCopy::new(gpu, formats)).transpose()?;
        Ok(Self { depth })
    }

    pub(crate) fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        encoding: &mut Encoding,
        plan: &PassPlan,
        sources: &Sources,
        timer: Option<TimedPasses>,
    ) {
        let Target::Textures { colors, depth } = &plan.target else { return };
        let timestamps = timer.map(|timer| timer.render(0));
        let load = encoding.load();
        if encoding.is_fresh {
            // Nothing was drawn yet: an empty picture is copied.
            encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("clear"),
                color_attachments: &[Some(encoding.framebuffer.color_attachment(load, false))],
                depth_stencil_attachment: Some(encoding.framebuffer.cleared_depth()),
                ..Default::default()
            });
            encoding.is_fresh = false;
        }
        for &color in colors {
            let texture = &sources.generated[color];
            encoding.framebuffer.copy_picture(
                encoder,
                texture.write(plan.is_in_place),
                texture.write_texture(plan.is_in_place),
                timestamps.clone(),
            );
        }
        if let (Some(depth), Some(DepthCopy { pipeline, layout })) = (depth, &self.depth) {
            let group = encoding.gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("depth"),
                layout,
                entries: &[wgpu::BindGroupEntry {
                    binding: 0,
                    resource: wgpu::BindingResource::TextureView(
                        encoding.framebuffer.depth_texture(),
                    ),
                }],
            });
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("copy depth"),
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: sources.generated[*depth].write(plan.is_in_place),
                    depth_ops: Some(wgpu::Operations {
                        load: wgpu::LoadOp::Clear(0.0),
                        store: wgpu::StoreOp::Store,
                    }),
                    stencil_ops: None,
                }),
                timestamp_writes: timestamps,
                ..Default::default()
            });
            pass.set_pipeline(pipeline);
            pass.set_bind_group(1, &group, &[]);
            pass.draw(0..3, 0..1);
        }
    }
}

impl DepthCopy {
    fn new(gpu: &Gpu, formats: &TargetFormats) -> Result<Self, Error> {
        let device = &gpu.device;
        let is_sampled = formats.samples > 1;
        let name = if is_sampled { "copy_depth_of_samples" } else { "copy_depth" };
        let vertex = screen_vertex()?;
        let source = edgemesh_shaders::ShaderSource::embedded(&format!("programs/{name}.wgsl"));
        let source = source.map_err(|error| Error::Internal(error.to_string()))?;
        let fragment = shader_module(device, &source, name);
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(name),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Depth,
                    view_dimension: wgpu::TextureViewDimension::D2,
                    multisampled: is_sampled,
                },
                count: None,
            }],
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(name),
            bind_group_layouts: &[None, Some(&layout)],
            immediate_size: 0,
        });
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(name),
            layout: Some(&pipeline_layout),
            vertex: wgpu::VertexState {
                module: &shader_module(device, &vertex.source, "screen"),
                entry_point: Some(&vertex.function),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: wgpu_format(TextureFormat::DEPTH),
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Always),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &fragment,
                entry_point: Some("copy_depth"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[],
            }),
            multiview_mask: None,
            cache: None,
        });
        Ok(Self { pipeline, layout })
    }
}
