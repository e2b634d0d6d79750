//! Paints the picture on the window, texel by texel.
//!
//! Rejected: an egui image, whose shader converts colors per pixel; on a software adapter
//! that costs more than many pictures.

use edgemesh_shaders::{ShaderError, ShaderSource};
use egui_wgpu::{Callback, CallbackResources, CallbackTrait, RenderState};
use strokes::shader_module;

/// Paints pictures on a window.
#[derive(Debug, Clone)]
pub(super) struct PicturePainter {
    pipeline: wgpu::RenderPipeline,
}

/// A picture ready to be painted.
#[derive(Debug, Clone)]
pub(super) struct PaintedPicture {
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
}

impl PicturePainter {
    /// # Errors
    /// If the shader cannot be resolved.
    pub(super) fn new(window: &RenderState) -> Result<Self, ShaderError> {
        let device = &window.device;
        let module = shader_module(device, &ShaderSource::embedded("window.wgsl")?, "window");
        let is_linear = f64::from(u8::from(window.target_format.is_srgb()));
        let constants = [("IS_LINEAR", is_linear)];
        let compilation_options =
            wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() };
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("window"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("window_vertex"),
                compilation_options: compilation_options.clone(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("window_fragment"),
                compilation_options,
                targets: &[Some(window.target_format.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        Ok(Self { pipeline })
    }

    /// Binds a picture for painting.
    pub(super) fn picture(&self, device: &wgpu::Device, picture: &wgpu::Texture) -> PaintedPicture {
        let view = picture.create_view(&wgpu::TextureViewDescriptor::default());
        let resource = wgpu::BindingResource::TextureView(&view);
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("window"),
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource }],
        });
        PaintedPicture { pipeline: self.pipeline.clone(), group }
    }
}

impl PaintedPicture {
    /// Paints the picture at `rect`, clipped by the painter.
    pub(super) fn paint(&self, painter: &egui::Painter, rect: egui::Rect) {
        painter.add(Callback::new_paint_callback(rect, self.clone()));
    }
}

impl CallbackTrait for PaintedPicture {
    fn paint(
        &self,
        _info: egui::PaintCallbackInfo,
        pass: &mut wgpu::RenderPass<'static>,
        _resources: &CallbackResources,
    ) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.draw(0..3, 0..1);
    }
}
