//! The formats that pipelines and targets must agree on.

use edgemesh_shaders::{ShaderError, ShaderSource};

use crate::gpu::shader::shader_module;

pub(crate) const COVERAGE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

const COLOR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// The formats and the sample count that pipelines and targets must agree on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TargetFormats {
    /// Format of the picture: `Rgba8Unorm`, or floats if later passes work on it.
    pub color: wgpu::TextureFormat,
    /// Format of the depth, with or without a stencil. Depth is reversed: 1 near, 0 far.
    pub depth: wgpu::TextureFormat,
    /// Samples per pixel, 1 or 4.
    pub samples: u32,
}

impl TargetFormats {
    /// The formats for styles without silhouettes: `Rgba8Unorm` and `Depth32Float`.
    #[must_use]
    pub const fn new(samples: u32) -> Self {
        Self { color: COLOR_FORMAT, depth: wgpu::TextureFormat::Depth32Float, samples }
    }

    /// The formats for styles with silhouettes, which need a stencil. The depth has 24 bits
    /// if the device has no stencil beside 32.
    #[must_use]
    pub fn with_stencil(device: &wgpu::Device, samples: u32) -> Self {
        let is_exact = device.features().contains(wgpu::Features::DEPTH32FLOAT_STENCIL8);
        let depth = if is_exact {
            wgpu::TextureFormat::Depth32FloatStencil8
        } else {
            wgpu::TextureFormat::Depth24PlusStencil8
        };
        Self { depth, ..Self::new(samples) }
    }

    /// Whether the depth format has a stencil.
    #[must_use]
    pub fn has_stencil(&self) -> bool {
        self.depth.has_stencil_aspect()
    }

    /// The file that replaces a placeholder in shaders that read the fill:
    /// `common/fill_depth.wgsl`, `common/fill_object.wgsl` or `common/glass_depth.wgsl`.
    fn shader_file(&self, placeholder: &str) -> Option<&'static str> {
        match (placeholder, self.samples > 1) {
            ("common/fill_depth.wgsl", true) => Some("common/fill_depth_of_samples.wgsl"),
            ("common/glass_depth.wgsl", true) => Some("common/glass_depth_of_samples.wgsl"),
            ("common/fill_object.wgsl", _) if !self.has_stencil() => {
                Some("common/fill_object_of_none.wgsl")
            }
            ("common/fill_object.wgsl", true) => Some("common/fill_object_of_samples.wgsl"),
            _ => None,
        }
    }

    /// The module of an embedded shader that reads the fill of targets of these formats.
    pub(crate) fn shader_module(
        &self,
        device: &wgpu::Device,
        root: &str,
    ) -> Result<wgpu::ShaderModule, ShaderError> {
        let source = ShaderSource::embedded_with(root, &|path| self.shader_file(path))?;
        Ok(shader_module(device, &source, root))
    }
}
