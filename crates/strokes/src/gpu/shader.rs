//! Shader modules from the files of `shaders/`.

use edgemesh_shaders::{ShaderError, ShaderSource};

/// Compiles a shader with its imports; `label` is its name in wgpu's messages.
#[must_use]
pub fn shader_module(
    device: &wgpu::Device,
    source: &ShaderSource,
    label: &str,
) -> wgpu::ShaderModule {
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Wgsl(source.text.as_str().into()),
    })
}

/// The module of an embedded shader that imports no placeholder.
pub(crate) fn embedded_module(
    device: &wgpu::Device,
    root: &str,
) -> Result<wgpu::ShaderModule, ShaderError> {
    Ok(shader_module(device, &ShaderSource::embedded(root)?, root))
}
