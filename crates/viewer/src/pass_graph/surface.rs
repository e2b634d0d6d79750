//! The surfaces of a scene on the GPU: vertices with normals and texture coordinates,
//! materials, and the parts that differ in material or group.
//!
//! Triangles are sorted by part, so that a mesh is one draw a part; the number of the
//! instance is that of the part. Region ids are whole numbers from 1, different for
//! each object, for each material and for each group of an object.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use edgemesh::edge_mesh::replicate::Quantization;
use edgemesh::edge_mesh::{EdgeMesh, FillVertex};
use edgemesh::index::{NONE, to_u32};
use glam::DMat4;
use strokes::gpu::device::Gpu;
use strokes::mesh::buffers::MeshTooLarge;
use strokes::mesh::layout::Layout;
use wgpu::util::DeviceExt as _;

use super::material::MaterialUniform;
use super::textures::{Images, averaged_levels, decode_image, upload};
use crate::error::{Error, ImageError};
use crate::scene::models::Scene;

/// The vertices of surfaces: position, normal, texture coordinate.
pub(crate) const VERTEX_ATTRIBUTES: [wgpu::VertexAttribute; 3] =
    wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x2];

/// What a part of a surface is. WGSL twin: `SurfacePart` in
/// `shaders/common/surface.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct SurfacePart {
    /// Index of its material.
    pub material: u32,
    /// Region id of its object.
    pub object_region: u32,
    /// Region id of its material.
    pub material_region: u32,
    /// Region id of its group.
    pub group_region: u32,
    /// 1 where it has texture coordinates of its own.
    pub has_texcoords: u32,
    /// Unused.
    pub padding: [u32; 3],
}

/// Triangles of one part.
#[derive(Debug, Clone, PartialEq, Eq)]
struct PartDraw {
    /// Of the index buffer.
    indices: std::ops::Range<u32>,
    material: u32,
    group: u32,
    has_texcoords: bool,
}

/// A mesh to be drawn as a surface.
#[derive(Debug)]
pub(crate) struct SurfaceMesh {
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    parts: Vec<PartDraw>,
    materials: wgpu::Buffer,
    /// The texture of each material.
    textures: Vec<wgpu::TextureView>,
    group_count: u32,
}

/// A mesh in its place.
#[derive(Debug)]
pub(crate) struct SurfaceObject {
    pub(crate) mesh: Arc<SurfaceMesh>,
    pub(crate) world_from_object: DMat4,
    pub(crate) uniform: wgpu::Buffer,
    pub(crate) bounds: edgemesh::edge_mesh::Bounds,
    /// `@group(2)`, one a material.
    groups: Vec<wgpu::BindGroup>,
    /// False where the transform flattens the object to nothing.
    pub(crate) is_placed: bool,
}

/// The surfaces of a scene.
#[derive(Debug)]
pub(crate) struct Surfaces {
    pub(crate) objects: Vec<SurfaceObject>,
    pub(crate) layout: wgpu::BindGroupLayout,
}

impl Surfaces {
    /// Uploads the surfaces of `scene`; their positions are those of `layout`.
    pub(crate) fn new(
        gpu: &Gpu,
        scene: &Scene,
        layout: Layout,
        images: &mut Images,
        sampler: &wgpu::Sampler,
    ) -> Result<Self, Error> {
        let group_layout = object_layout(&gpu.device);
        let mut meshes = Vec::new();
        // Ids of materials go by the model, those of groups by the object.
        let (mut material_regions, mut material_region) = (Vec::new(), 1);
        for model in &scene.models {
            let failed = |reason| Error::MeshTooLarge { model: model.name.clone(), reason };
            let mesh = SurfaceMesh::new(gpu, &model.mesh, layout, images).map_err(failed)?;
            material_regions.push(material_region);
            material_region += to_u32(mesh.textures.len());
            meshes.push(Arc::new(mesh));
        }
        let mut objects = Vec::new();
        let mut group_region = 1;
        for (at, placed) in scene.objects.iter().enumerate() {
            let mesh = meshes[placed.model].clone();
            let regions = [to_u32(at) + 1, material_regions[placed.model], group_region];
            group_region += mesh.group_count + 1;
            let bounds = scene.models[placed.model].mesh.bounds;
            objects.push(SurfaceObject::new(
                gpu,
                mesh,
                (placed.world_from_object, bounds),
                regions,
                &group_layout,
                sampler,
            ));
        }
        Ok(Self { objects, layout: group_layout })
    }
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
        ],
    })
}

impl SurfaceMesh {
    fn new(
        gpu: &Gpu,
        mesh: &EdgeMesh,
        layout: Layout,
        images: &mut Images,
    ) -> Result<Self, MeshTooLarge> {
        let (vertices, indices) = vertices_of(mesh, layout);
        let limit = gpu.device.limits().max_buffer_size;
        for (what, need) in [
            ("vertices", size_of_val(&*vertices) as u64),
            ("triangles", size_of_val(&*indices) as u64),
        ] {
            if need > limit {
                return Err(MeshTooLarge { what, need, limit });
            }
        }
        let (parts, indices) = sorted_by_part(mesh, indices);
        let buffer = |label, contents: &[u8], usage| {
            // A buffer must not be empty.
            let contents = if contents.is_empty() { &[0; 64] } else { contents };
            let descriptor =
                wgpu::util::BufferInitDescriptor { label: Some(label), contents, usage };
            gpu.device.create_buffer_init(&descriptor)
        };
        let mut materials: Vec<MaterialUniform> =
            mesh.fill.materials.iter().map(MaterialUniform::of).collect();
        let mut textures = Vec::new();
        for material in &mesh.fill.materials {
            textures.push(match material.diffuse_texture.as_ref().map(base_texture) {
                Some(Ok(levels)) => upload(gpu, &material.name, &levels),
                Some(Err(what)) => {
                    log::warn!("the texture of the material '{}' {what}", material.name);
                    images.white(gpu)
                }
                None => images.white(gpu),
            });
        }
        // What has no material has the last one.
        materials.push(MaterialUniform::default());
        textures.push(images.white(gpu));
        Ok(Self {
            vertices: buffer(
                "surface",
                bytemuck::cast_slice(&vertices),
                wgpu::BufferUsages::VERTEX,
            ),
            indices: buffer(
                "surface triangles",
                bytemuck::cast_slice(&indices),
                wgpu::BufferUsages::INDEX,
            ),
            materials: buffer(
                "materials",
                bytemuck::cast_slice(&materials),
                wgpu::BufferUsages::STORAGE,
            ),
            parts,
            textures,
            group_count: to_u32(mesh.fill.groups.len()),
        })
    }
}

/// The levels of a material's texture.
fn base_texture(texture: &edgemesh::model::Texture) -> Result<Vec<image::RgbaImage>, ImageError> {
    let bytes = texture.source.encoded()?;
    decode_image(&bytes).map(averaged_levels)
}

/// The vertices and indices of a mesh. One without a fill is shaded smoothly.
fn vertices_of(mesh: &EdgeMesh, layout: Layout) -> (Vec<FillVertex>, Vec<u32>) {
    let (mut vertices, indices) = if mesh.fill.indices.is_empty() {
        let vertex = |(position, normal): (&[f32; 3], &[f32; 3])| FillVertex {
            position: *position,
            normal: *normal,
            texcoord: [0.0; 2],
        };
        let vertices = mesh.positions.iter().zip(&mesh.vertex_normals).map(vertex).collect();
        (vertices, mesh.triangles.iter().flatten().copied().collect())
    } else {
        (mesh.fill.vertices.clone(), mesh.fill.indices.clone())
    };
    if layout == Layout::Replicated16 {
        let steps = Quantization::of(&mesh.bounds);
        for vertex in &mut vertices {
            vertex.position = steps.dequantize(steps.quantize(vertex.position));
        }
    }
    (vertices, indices)
}

/// The parts of a mesh, and its indices in their order.
fn sorted_by_part(mesh: &EdgeMesh, indices: Vec<u32>) -> (Vec<PartDraw>, Vec<u32>) {
    let runs = &mesh.fill.runs;
    let triangle_count = to_u32(indices.len() / 3);
    let part = |range: std::ops::Range<u32>, material, group, has_texcoords| PartDraw {
        indices: 3 * range.start..3 * range.end,
        material,
        group,
        has_texcoords,
    };
    let [run] = runs.as_slice() else {
        if runs.is_empty() {
            return (vec![part(0..triangle_count, NONE, NONE, false)], indices);
        }
        // A stable sort keeps the order of the file within a part.
        let mut order: Vec<usize> = (0..runs.len()).collect();
        let key = |run: usize| (runs[run].material, runs[run].group, runs[run].has_texcoords);
        order.sort_by_key(|&run| key(run));
        let (mut parts, mut sorted) = (Vec::<PartDraw>::new(), Vec::with_capacity(indices.len()));
        for run in order {
            let end = runs.get(run + 1).map_or(triangle_count, |next| next.first_triangle);
            let start = to_u32(sorted.len());
            let range = 3 * runs[run].first_triangle as usize..3 * end as usize;
            sorted.extend_from_slice(&indices[range]);
            let (material, group, has_texcoords) = key(run);
            let is_same = |last: &PartDraw| {
                (last.material, last.group, u32::from(last.has_texcoords)) == key(run)
            };
            let end = to_u32(sorted.len());
            match parts.last_mut().filter(|last| is_same(last)) {
                Some(last) => last.indices.end = end,
                None => parts.push(PartDraw {
                    indices: start..end,
                    material,
                    group,
                    has_texcoords: has_texcoords == 1,
                }),
            }
        }
        return (parts, sorted);
    };
    let one = part(0..triangle_count, run.material, run.group, run.has_texcoords == 1);
    (vec![one], indices)
}

impl SurfaceObject {
    fn new(
        gpu: &Gpu,
        mesh: Arc<SurfaceMesh>,
        (world_from_object, bounds): (DMat4, edgemesh::edge_mesh::Bounds),
        [object_region, material_region, group_region]: [u32; 3],
        layout: &wgpu::BindGroupLayout,
        sampler: &wgpu::Sampler,
    ) -> Self {
        let last = to_u32(mesh.textures.len()) - 1;
        let part = |draw: &PartDraw| {
            let material = draw.material.min(last);
            SurfacePart {
                material,
                object_region,
                material_region: material_region + material,
                group_region: group_region + if draw.group == NONE { 0 } else { draw.group + 1 },
                has_texcoords: u32::from(draw.has_texcoords),
                padding: [0; 3],
            }
        };
        let parts: Vec<SurfacePart> = mesh.parts.iter().map(part).collect();
        let device = &gpu.device;
        let parts = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("surface parts"),
            contents: bytemuck::cast_slice(&parts),
            usage: wgpu::BufferUsages::STORAGE,
        });
        let uniform = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("surface object"),
            size: size_of::<strokes::view::frame::ObjectUniform>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let group = |texture: &wgpu::TextureView| {
            let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("surface"),
                layout,
                entries: &[
                    entry(0, uniform.as_entire_binding()),
                    entry(1, parts.as_entire_binding()),
                    entry(2, mesh.materials.as_entire_binding()),
                    entry(3, wgpu::BindingResource::TextureView(texture)),
                    entry(4, wgpu::BindingResource::Sampler(sampler)),
                ],
            })
        };
        let groups = mesh.textures.iter().map(group).collect();
        Self { mesh, world_from_object, uniform, bounds, groups, is_placed: true }
    }

    /// Draws the mesh; everything but `@group(2)` must be set.
    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass) {
        pass.set_vertex_buffer(0, self.mesh.vertices.slice(..));
        pass.set_index_buffer(self.mesh.indices.slice(..), wgpu::IndexFormat::Uint32);
        let mut bound = None;
        for (index, part) in self.mesh.parts.iter().enumerate() {
            if part.indices.is_empty() {
                continue;
            }
            let material = (part.material as usize).min(self.groups.len() - 1);
            if bound != Some(material) {
                pass.set_bind_group(2, &self.groups[material], &[]);
                bound = Some(material);
            }
            let part_index = to_u32(index);
            pass.draw_indexed(part.indices.clone(), 0, part_index..part_index + 1);
        }
    }
}
