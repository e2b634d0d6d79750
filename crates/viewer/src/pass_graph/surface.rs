//! The surfaces of a scene: materials with their textures, and region ids.
//!
//! Vertices and triangles are those of the mesh instances, sorted into material ranges. A
//! range is one draw; its number comes as a vertex attribute that does not advance, so the
//! instance index stays free. Colors of vertices come from a storage buffer, because one of a
//! single white vertex then stands for all of a model without colors, and for those that a pass
//! does not draw. Region ids are whole numbers from 1, different for each object,
//! for each material and for each group of an object.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use edgemesh::edge_mesh::EdgeMesh;
use edgemesh::index::{NONE, to_u32};
use edgemesh::model::Material;
use strokes::{Gpu, MaterialRange, MeshInstance, ViewState, upload_levels};
use wgpu::util::DeviceExt as _;

use super::material::{MaterialUniform, is_transparent};
use super::textures::{Images, averaged_levels, decode_image};
use crate::error::ImageError;
use crate::scene::models::Scene;

/// The vertex buffers of surfaces: positions, normals, texture coordinates, and the number of
/// the material range, which is the same for all vertices of a draw.
pub(crate) const VERTEX_BUFFERS: [Option<wgpu::VertexBufferLayout<'static>>; 4] = [
    vertex_buffer(12, &wgpu::vertex_attr_array![0 => Float32x3]),
    vertex_buffer(12, &wgpu::vertex_attr_array![1 => Float32x3]),
    vertex_buffer(8, &wgpu::vertex_attr_array![2 => Float32x2]),
    Some(wgpu::VertexBufferLayout {
        array_stride: 0,
        step_mode: wgpu::VertexStepMode::Instance,
        attributes: &wgpu::vertex_attr_array![3 => Uint32],
    }),
];

const fn vertex_buffer(
    array_stride: u64,
    attributes: &[wgpu::VertexAttribute],
) -> Option<wgpu::VertexBufferLayout<'_>> {
    let step_mode = wgpu::VertexStepMode::Vertex;
    Some(wgpu::VertexBufferLayout { array_stride, step_mode, attributes })
}

/// The uniform of a material range. WGSL twin: `SurfaceRange` in
/// `shaders/common/surface.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct SurfaceRange {
    /// Index of its material; under vertex colors another one (`MaterialUniform::of_colored`).
    pub material: u32,
    /// Region id of its object.
    pub object_region: u32,
    /// Region id of its material.
    pub material_region: u32,
    /// Region id of its group.
    pub group_region: u32,
    /// 1 if the model has texture coordinates here.
    pub has_texcoords: u32,
    /// Unused.
    pub padding: [u32; 3],
}

/// The materials of one model.
#[derive(Debug)]
struct ModelMaterials {
    /// One for each of `textures`, then, if the model has colors, one under them for each.
    uniforms: wgpu::Buffer,
    /// The texture of each material.
    textures: Vec<wgpu::TextureView>,
    /// Whether each material of the model is transparent.
    is_transparent: Vec<bool>,
    group_count: u32,
}

/// The surface of one instance.
#[derive(Debug)]
pub(crate) struct Surface {
    /// `@group(2)`, one per material.
    groups: Vec<wgpu::BindGroup>,
    /// As `groups`, with the colors of vertices; empty if the model has none.
    colored: Vec<wgpu::BindGroup>,
    /// The numbers of the material ranges.
    range_numbers: wgpu::Buffer,
    /// Whether each range is transparent.
    is_transparent: Vec<bool>,
}

/// The ranges of a surface that are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ranges {
    All,
    Opaque,
    Transparent,
}

/// The surfaces of a scene.
#[derive(Debug)]
pub(crate) struct Surfaces {
    pub(crate) layout: wgpu::BindGroupLayout,
    surfaces: Vec<Surface>,
}

/// The input of [`Surfaces::new`].
#[derive(Debug, Clone, Copy)]
pub(crate) struct SurfaceInput<'a> {
    pub(crate) gpu: &'a Gpu,
    pub(crate) scene: &'a Scene,
    pub(crate) instances: &'a [MeshInstance],
    pub(crate) view: &'a ViewState,
    /// How base textures are sampled.
    pub(crate) sampler: &'a wgpu::Sampler,
}

/// The first region ids of an object.
#[derive(Debug, Clone, Copy)]
struct FirstRegions {
    object: u32,
    material: u32,
    group: u32,
}

impl Surfaces {
    /// `input.instances` must have been uploaded with their surfaces.
    pub(crate) fn new(input: &SurfaceInput, images: &mut Images) -> Self {
        let layout = object_layout(&input.gpu.device);
        let white = storage(&input.gpu.device, "no vertex colors", &[u8::MAX; 4]);
        let mut models = Vec::new();
        // Material ids are counted over the models, group ids over the objects.
        let (mut material_regions, mut material) = (Vec::new(), 1);
        for model in &input.scene.models {
            let materials = Arc::new(ModelMaterials::new(input.gpu, &model.mesh, images));
            material_regions.push(material);
            material += to_u32(materials.textures.len());
            models.push(materials);
        }
        let mut surfaces = Vec::new();
        let mut group = 1;
        for (at, placed) in input.scene.objects.iter().enumerate() {
            let materials = &models[placed.model];
            let material = material_regions[placed.model];
            let regions = FirstRegions { object: to_u32(at) + 1, material, group };
            group += materials.group_count + 1;
            surfaces.push(Surface::new(input, at, materials, regions, (&layout, &white)));
        }
        Self { layout, surfaces }
    }

    /// Whether any surface is transparent.
    pub(crate) fn has_glass(&self) -> bool {
        self.surfaces.iter().any(|surface| surface.is_transparent.contains(&true))
    }

    /// Draws ranges of the surface of instance `at`, with the colors of its vertices if
    /// `has_colors`; everything but `@group(2)` must be set.
    pub(crate) fn draw(
        &self,
        pass: &mut wgpu::RenderPass,
        instances: &[MeshInstance],
        at: usize,
        has_colors: bool,
        ranges: Ranges,
    ) {
        if let (Some(surface), Some(instance)) = (self.surfaces.get(at), instances.get(at)) {
            surface.draw(pass, instance, has_colors, ranges);
        }
    }
}

fn storage(device: &wgpu::Device, label: &str, contents: &[u8]) -> wgpu::Buffer {
    let (label, usage) = (Some(label), wgpu::BufferUsages::STORAGE);
    device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label, contents, usage })
}

/// `@group(2)` of programs that draw the scene.
fn object_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
        ty,
        count: None,
    };
    let buffer =
        |ty| wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    let storage = wgpu::BufferBindingType::Storage { read_only: true };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("surface"),
        entries: &[
            entry(0, buffer(wgpu::BufferBindingType::Uniform)),
            entry(1, buffer(storage)),
            entry(2, buffer(storage)),
            entry(
                3,
                wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Float { filterable: true },
                    view_dimension: wgpu::TextureViewDimension::D2,
                    multisampled: false,
                },
            ),
            entry(4, wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering)),
            entry(5, buffer(storage)),
        ],
    })
}

impl ModelMaterials {
    fn new(gpu: &Gpu, mesh: &EdgeMesh, images: &mut Images) -> Self {
        let mut uniforms: Vec<MaterialUniform> =
            mesh.fill.materials.iter().map(MaterialUniform::of).collect();
        let mut textures = Vec::new();
        for material in &mesh.fill.materials {
            textures.push(match material.diffuse_texture.as_ref().map(base_texture) {
                Some(Ok(levels)) => upload_levels(gpu, &material.name, &levels),
                Some(Err(what)) => {
                    log::error!(
                        "the texture of the material '{}' was left out: {what}",
                        material.name
                    );
                    images.white(gpu)
                }
                None => images.white(gpu),
            });
        }
        // Triangles without a material use the last one.
        uniforms.push(MaterialUniform::default());
        textures.push(images.white(gpu));
        if !mesh.fill.colors.is_empty() {
            uniforms.extend(mesh.fill.materials.iter().map(MaterialUniform::of_colored));
            uniforms.push(MaterialUniform::of_colored(&Material::default()));
        }
        Self {
            uniforms: storage(&gpu.device, "materials", bytemuck::cast_slice(&uniforms)),
            textures,
            is_transparent: mesh.fill.materials.iter().map(is_transparent).collect(),
            group_count: to_u32(mesh.fill.groups.len()),
        }
    }
}

impl ModelMaterials {
    fn is_transparent(&self, range: &MaterialRange) -> bool {
        self.is_transparent.get(range.material as usize).copied().unwrap_or(false)
    }
}

/// The levels of a material's texture.
fn base_texture(texture: &edgemesh::model::Texture) -> Result<Vec<image::RgbaImage>, ImageError> {
    let bytes = texture.source.encoded()?;
    decode_image(&bytes).map(averaged_levels)
}

impl Surface {
    fn new(
        input: &SurfaceInput,
        at: usize,
        materials: &ModelMaterials,
        regions: FirstRegions,
        (layout, white): (&wgpu::BindGroupLayout, &wgpu::Buffer),
    ) -> Self {
        let device = &input.gpu.device;
        let last = to_u32(materials.textures.len()) - 1;
        let of_range = |range: &MaterialRange| {
            let material = range.material.min(last);
            SurfaceRange {
                material,
                object_region: regions.object,
                material_region: regions.material + material,
                group_region: regions.group + if range.group == NONE { 0 } else { range.group + 1 },
                has_texcoords: u32::from(range.has_texcoords),
                padding: [0; 3],
            }
        };
        let surface = input.instances[at].mesh().surface();
        let ranges = surface.map_or(&[][..], |surface| &surface.ranges);
        let uniforms: Vec<SurfaceRange> = ranges.iter().map(of_range).collect();
        let object = input.view.objects()[at].uniform();
        let groups = |uniforms: &[SurfaceRange], colors: &wgpu::Buffer| {
            let uniforms = storage(device, "surface ranges", bytemuck::cast_slice(uniforms));
            let group = |texture: &wgpu::TextureView| {
                let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
                device.create_bind_group(&wgpu::BindGroupDescriptor {
                    label: Some("surface"),
                    layout,
                    entries: &[
                        entry(0, object.as_entire_binding()),
                        entry(1, uniforms.as_entire_binding()),
                        entry(2, materials.uniforms.as_entire_binding()),
                        entry(3, wgpu::BindingResource::TextureView(texture)),
                        entry(4, wgpu::BindingResource::Sampler(input.sampler)),
                        entry(5, colors.as_entire_binding()),
                    ],
                })
            };
            materials.textures.iter().map(group).collect()
        };
        let colored = surface.and_then(|surface| surface.colors.as_ref()).map(|colors| {
            let under_colors = |range: &SurfaceRange| SurfaceRange {
                material: range.material + last + 1,
                ..*range
            };
            groups(&uniforms.iter().map(under_colors).collect::<Vec<_>>(), colors)
        });
        let numbers: Vec<u32> = (0..to_u32(ranges.len()).max(1)).collect();
        Self {
            groups: groups(&uniforms, white),
            colored: colored.unwrap_or_default(),
            is_transparent: ranges.iter().map(|range| materials.is_transparent(range)).collect(),
            range_numbers: device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("range numbers"),
                contents: bytemuck::cast_slice(&numbers),
                usage: wgpu::BufferUsages::VERTEX,
            }),
        }
    }

    fn draw(
        &self,
        pass: &mut wgpu::RenderPass,
        instance: &MeshInstance,
        has_colors: bool,
        ranges: Ranges,
    ) {
        let is_colored = has_colors && !self.colored.is_empty();
        let groups = if is_colored { &self.colored } else { &self.groups };
        let surface = instance.mesh().surface().zip(instance.surface_geometry());
        let Some((buffers, geometry)) = surface else { return };
        pass.set_vertex_buffer(0, geometry.positions.slice(..));
        pass.set_vertex_buffer(1, geometry.normals.slice(..));
        pass.set_vertex_buffer(2, buffers.texcoords.slice(..));
        pass.set_index_buffer(buffers.indices.slice(..), wgpu::IndexFormat::Uint32);
        let mut bound = None;
        for ((number, range), is_transparent) in
            (0_u64..).zip(&buffers.ranges).zip(&self.is_transparent)
        {
            let is_drawn = match ranges {
                Ranges::All => true,
                Ranges::Opaque => !is_transparent,
                Ranges::Transparent => *is_transparent,
            };
            if !is_drawn || range.indices.is_empty() {
                continue;
            }
            let material = (range.material as usize).min(groups.len() - 1);
            if bound != Some(material) {
                pass.set_bind_group(2, &groups[material], &[]);
                bound = Some(material);
            }
            pass.set_vertex_buffer(3, self.range_numbers.slice(4 * number..));
            pass.draw_indexed(range.indices.clone(), 0, 0..1);
        }
    }
}
