//! Bind groups of passes: parameters, textures and samplers, found by reflection.

use strokes::Gpu;
use wgpu::util::DeviceExt as _;

use super::params::{Iteration, bytes_of};
use super::textures::{GeneratedTexture, Images};
use crate::error::Error;
use crate::technique::pass::Pass;
use crate::technique::plan::{ReadSource, TextureRead};
use crate::technique::program::{Interface, Params, Program, TextureKind};

/// The group of a pass's parameters and textures.
pub(crate) const PASS_GROUP: u32 = 1;
/// The group of parameters and textures of a vertex program in its own file.
pub(crate) const VERTEX_GROUP: u32 = 3;

/// The bindings of one group.
#[derive(Debug, Clone)]
pub(crate) struct GroupPlan {
    group: u32,
    params: Vec<Params>,
    textures: Vec<TextureBinding>,
    samplers: Vec<SamplerBinding>,
}

/// A texture of a group.
#[derive(Debug, Clone)]
struct TextureBinding {
    binding: u32,
    kind: TextureKind,
    /// The read in the plan of the pass.
    read: Option<TextureRead>,
}

/// A sampler of a group.
#[derive(Debug, Clone)]
struct SamplerBinding {
    binding: u32,
    /// The read of its texture in the plan of the pass.
    read: Option<TextureRead>,
}

/// A texture that is bound in place of that of a variable.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Replacement<'a> {
    pub(crate) variable: &'a str,
    pub(crate) view: &'a wgpu::TextureView,
}

impl GroupPlan {
    /// The bindings of `programs` in `group`, with the textures that the pass reads.
    pub(crate) fn new(group: u32, programs: &[&Program], reads: &[TextureRead]) -> Self {
        let mut plan =
            Self { group, params: Vec::new(), textures: Vec::new(), samplers: Vec::new() };
        for program in programs {
            plan.add(&program.interface, reads);
        }
        plan
    }

    fn add(&mut self, interface: &Interface, reads: &[TextureRead]) {
        let read = |name: &str| reads.iter().find(|read| read.variable == name).cloned();
        if let Some(params) = interface.params.iter().find(|params| params.group == self.group)
            && self.params.iter().all(|known| known.binding != params.binding)
        {
            self.params.push(params.clone());
        }
        for slot in interface.textures.iter().filter(|slot| slot.group == self.group) {
            if self.textures.iter().all(|known| known.binding != slot.binding) {
                let read = read(&slot.name);
                self.textures.push(TextureBinding { binding: slot.binding, kind: slot.kind, read });
            }
        }
        for slot in interface.samplers.iter().filter(|slot| slot.group == self.group) {
            if self.samplers.iter().all(|known| known.binding != slot.binding) {
                let read = read(&slot.texture);
                self.samplers.push(SamplerBinding { binding: slot.binding, read });
            }
        }
    }

    pub(crate) const fn is_empty(&self) -> bool {
        self.params.is_empty() && self.textures.is_empty() && self.samplers.is_empty()
    }

    pub(crate) fn layout(&self, device: &wgpu::Device) -> wgpu::BindGroupLayout {
        let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
            ty,
            count: None,
        };
        let is_filtered =
            |read: &Option<TextureRead>| read.as_ref().is_some_and(|read| read.is_filtered);
        let mut entries: Vec<wgpu::BindGroupLayoutEntry> = Vec::new();
        for params in &self.params {
            let ty = wgpu::BufferBindingType::Uniform;
            let ty =
                wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
            entries.push(entry(params.binding, ty));
        }
        for TextureBinding { binding, kind, read } in &self.textures {
            let sample_type = match kind {
                TextureKind::Float => {
                    wgpu::TextureSampleType::Float { filterable: is_filtered(read) }
                }
                TextureKind::Uint => wgpu::TextureSampleType::Uint,
                TextureKind::Depth => wgpu::TextureSampleType::Depth,
            };
            let view_dimension = wgpu::TextureViewDimension::D2;
            let ty =
                wgpu::BindingType::Texture { sample_type, view_dimension, multisampled: false };
            entries.push(entry(*binding, ty));
        }
        for SamplerBinding { binding, read } in &self.samplers {
            let ty = match is_filtered(read) {
                true => wgpu::SamplerBindingType::Filtering,
                false => wgpu::SamplerBindingType::NonFiltering,
            };
            entries.push(entry(*binding, wgpu::BindingType::Sampler(ty)));
        }
        device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("pass"),
            entries: &entries,
        })
    }

    /// Uniform buffers with the values of `pass`, one per uniform.
    pub(crate) fn buffers(
        &self,
        device: &wgpu::Device,
        pass: &Pass,
        iteration: Iteration,
    ) -> Vec<wgpu::Buffer> {
        let buffer = |params: &Params| {
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("params"),
                contents: &bytes_of(params, pass, iteration),
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            })
        };
        self.params.iter().map(buffer).collect()
    }

    /// Binds `buffers` and the current textures.
    pub(crate) fn group(
        &self,
        gpu: &Gpu,
        layout: &wgpu::BindGroupLayout,
        buffers: &[wgpu::Buffer],
        sources: &mut Sources,
        replacement: Option<Replacement>,
    ) -> Result<wgpu::BindGroup, Error> {
        let mut views = Vec::new();
        for TextureBinding { binding, read, .. } in &self.textures {
            let is_replaced = |replacement: &Replacement| {
                read.as_ref().is_some_and(|read| read.variable == replacement.variable)
            };
            let view = match replacement.filter(is_replaced) {
                Some(replacement) => replacement.view.clone(),
                None => sources.view(gpu, read.as_ref())?,
            };
            views.push((*binding, view));
        }
        let samplers: Vec<(u32, wgpu::Sampler)> = self
            .samplers
            .iter()
            .map(|sampler| (sampler.binding, sources.samplers.of(sampler.read.as_ref()).clone()))
            .collect();
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        let mut entries = Vec::new();
        for (params, buffer) in self.params.iter().zip(buffers) {
            entries.push(entry(params.binding, buffer.as_entire_binding()));
        }
        for (binding, view) in &views {
            entries.push(entry(*binding, wgpu::BindingResource::TextureView(view)));
        }
        for (binding, sampler) in &samplers {
            entries.push(entry(*binding, wgpu::BindingResource::Sampler(sampler)));
        }
        Ok(gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("pass"),
            layout,
            entries: &entries,
        }))
    }
}

/// The textures that passes read, with their samplers.
#[derive(Debug)]
pub(crate) struct Sources {
    pub(crate) generated: Vec<GeneratedTexture>,
    pub(crate) images: Images,
    pub(crate) samplers: Samplers,
}

impl Sources {
    fn view(&mut self, gpu: &Gpu, read: Option<&TextureRead>) -> Result<wgpu::TextureView, Error> {
        match read.map(|read| &read.source) {
            Some(ReadSource::Generated(texture)) => Ok(self.generated[*texture].read().clone()),
            Some(ReadSource::Image(file)) => self.images.view(gpu, file),
            Some(ReadSource::None) | None => Ok(self.images.white(gpu)),
        }
    }
}

/// The samplers of textures.
#[derive(Debug)]
pub(crate) struct Samplers {
    nearest: wgpu::Sampler,
    nearest_image: wgpu::Sampler,
    linear: wgpu::Sampler,
    pub(crate) linear_image: wgpu::Sampler,
}

impl Samplers {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let sampler = |filter, mipmap_filter, address_mode| {
            device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("textures"),
                address_mode_u: address_mode,
                address_mode_v: address_mode,
                mag_filter: filter,
                min_filter: filter,
                mipmap_filter,
                ..wgpu::SamplerDescriptor::default()
            })
        };
        let (nearest, linear) = (wgpu::FilterMode::Nearest, wgpu::FilterMode::Linear);
        let (one, between) = (wgpu::MipmapFilterMode::Nearest, wgpu::MipmapFilterMode::Linear);
        let (edge, repeat) = (wgpu::AddressMode::ClampToEdge, wgpu::AddressMode::Repeat);
        Self {
            nearest: sampler(nearest, one, edge),
            nearest_image: sampler(nearest, one, repeat),
            linear: sampler(linear, one, edge),
            linear_image: sampler(linear, between, repeat),
        }
    }

    /// The sampler of a texture: images repeat, generated textures are clamped.
    fn of(&self, read: Option<&TextureRead>) -> &wgpu::Sampler {
        let Some(read) = read else { return &self.nearest };
        let is_image = matches!(read.source, ReadSource::Image(_));
        match (read.is_filtered, is_image) {
            (false, false) => &self.nearest,
            (false, true) => &self.nearest_image,
            (true, false) => &self.linear,
            (true, true) => &self.linear_image,
        }
    }
}
