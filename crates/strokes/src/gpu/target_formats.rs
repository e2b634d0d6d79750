//! The formats that pipelines and targets must agree on.

use edgemesh_shaders::{ShaderError, ShaderSource};

use crate::gpu::shader::shader_module;

/// The format of coverage.
pub(crate) const COVERAGE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// The format of pictures.
pub const COLOR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// The formats and the samples that pipelines and targets must agree on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TargetFormats {
    /// Of the picture: [`COLOR_FORMAT`], or floats where a picture is to be
    /// worked on further.
    pub color: wgpu::TextureFormat,
    /// Of the depth: reversed, 1 near, 0 far.
    pub depth: wgpu::TextureFormat,
    /// Samples a pixel, 1 or 4.
    pub samples: u32,
}

impl TargetFormats {
    /// The formats for looks without silhouettes.
    #[must_use]
    pub const fn new(samples: u32) -> Self {
        Self { color: COLOR_FORMAT, depth: wgpu::TextureFormat::Depth32Float, samples }
    }

    /// The formats for looks with silhouettes, which need a stencil. Devices
    /// without one beside 32 bits of depth have 24.
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

    /// Whether there is a stencil beside the depth.
    #[must_use]
    pub fn has_stencil(&self) -> bool {
        self.depth.has_stencil_aspect()
    }

    /// The file that stands for a placeholder where shaders read what was filled:
    /// `common/fill_depth.wgsl` or `common/fill_object.wgsl`.
    fn shader_file(&self, placeholder: &str) -> Option<&'static str> {
        match (placeholder, self.samples > 1) {
            ("common/fill_depth.wgsl", true) => Some("common/fill_depth_of_samples.wgsl"),
            ("common/fill_object.wgsl", _) if !self.has_stencil() => {
                Some("common/fill_object_of_none.wgsl")
            }
            ("common/fill_object.wgsl", true) => Some("common/fill_object_of_samples.wgsl"),
            _ => None,
        }
    }

    /// The module of an embedded shader that reads what was filled in pictures of these
    /// formats.
    pub(crate) fn shader_module(
        &self,
        device: &wgpu::Device,
        root: &str,
    ) -> Result<wgpu::ShaderModule, ShaderError> {
        let source = ShaderSource::embedded_with(root, &|path| self.shader_file(path))?;
        Ok(shader_module(device, &source, root))
    }
}
