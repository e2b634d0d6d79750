//! Bind groups of passes: parameters, textures and samplers, by the names that
//! reflection found.

use strokes::gpu::device::Gpu;
use wgpu::util::DeviceExt as _;

use super::params::{Iteration, bytes_of};
use super::textures::{GeneratedTexture, Images};
use crate::error::Error;
use crate::technique::pass::Pass;
use crate::technique::plan::{Read, ReadSource};
use crate::technique::program::{Interface, Params, Program, TextureKind};

/// The group of a pass's parameters and textures.
pub(crate) const PASS_GROUP: u32 = 1;
/// The group of a vertex program's own ones.
pub(crate) const VERTEX_GROUP: u32 = 3;

/// What is bound to one group.
#[derive(Debug, Clone)]
pub(crate) struct GroupPlan {
    group: u32,
    params: Vec<Params>,
    /// Binding, and the read in the pass's plan.
    textures: Vec<(u32, TextureKind, Option<Read>)>,
    samplers: Vec<(u32, Option<Read>)>,
}

impl GroupPlan {
    /// What `programs` want in `group`, of what the pass reads.
    pub(crate) fn new(group: u32, programs: &[&Program], reads: &[Read]) -> Self {
        let mut plan =
            Self { group, params: Vec::new(), textures: Vec::new(), samplers: Vec::new() };
        for program in programs {
            plan.add(&program.interface, reads);
        }
        plan
    }

    fn add(&mut self, interface: &Interface, reads: &[Read]) {
        let read = |name: &str| reads.iter().find(|read| read.variable == name).cloned();
        if let Some(params) = interface.params.iter().find(|params| params.group == self.group)
            && self.params.iter().all(|known| known.binding != params.binding)
        {
            self.params.push(params.clone());
        }
        for slot in interface.textures.iter().filter(|slot| slot.group == self.group) {
            if self.textures.iter().all(|known| known.0 != slot.binding) {
                self.textures.push((slot.binding, slot.kind, read(&slot.name)));
            }
        }
        for slot in interface.samplers.iter().filter(|slot| slot.group == self.group) {
            if self.samplers.iter().all(|known| known.0 != slot.binding) {
                self.samplers.push((slot.binding, read(&slot.texture)));
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
        let is_filtered = |read: &Option<Read>| read.as_ref().is_some_and(|read| read.is_filtered);
        let mut entries: Vec<wgpu::BindGroupLayoutEntry> = Vec::new();
        for params in &self.params {
            let ty = wgpu::BufferBindingType::Uniform;
            let ty =
                wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
            entries.push(entry(params.binding, ty));
        }
        for (binding, kind, read) in &self.textures {
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
        for (binding, read) in &self.samplers {
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

    /// Uniform buffers with the values of `pass`, one for each uniform.
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

    /// Binds `buffers` and the textures as they are now; `replaced` stands for the
    /// texture variable of that name.
    pub(crate) fn group(
        &self,
        gpu: &Gpu,
        layout: &wgpu::BindGroupLayout,
        buffers: &[wgpu::Buffer],
        sources: &mut Sources,
        replaced: Option<(&str, &wgpu::TextureView)>,
    ) -> Result<wgpu::BindGroup, Error> {
        let mut views = Vec::new();
        for (binding, _, read) in &self.textures {
            let own = replaced
                .filter(|(name, _)| read.as_ref().is_some_and(|read| read.variable == *name));
            let view = match own {
                Some((_, view)) => view.clone(),
                None => sources.view(gpu, read.as_ref())?,
            };
            views.push((*binding, view));
        }
        let samplers: Vec<(u32, wgpu::Sampler)> = self
            .samplers
            .iter()
            .map(|(binding, read)| (*binding, sources.samplers.of(read.as_ref()).clone()))
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

/// Where passes read from.
#[derive(Debug)]
pub(crate) struct Sources {
    pub(crate) generated: Vec<GeneratedTexture>,
    pub(crate) images: Images,
    pub(crate) samplers: Samplers,
}

impl Sources {
    fn view(&mut self, gpu: &Gpu, read: Option<&Read>) -> Result<wgpu::TextureView, Error> {
        match read.map(|read| &read.source) {
            Some(ReadSource::Generated(texture)) => Ok(self.generated[*texture].read().clone()),
            Some(ReadSource::Image(file)) => self.images.view(gpu, file),
            Some(ReadSource::None) | None => Ok(self.images.white(gpu)),
        }
    }
}

/// The samplers that textures are read with.
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

    /// Images repeat, generated textures end at their rims.
    fn of(&self, read: Option<&Read>) -> &wgpu::Sampler {
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
