//! One edge mesh on the GPU, in one of four layouts, in chunks that the adapter can bind.
//!
//! | buffer | bytes | in the layouts |
//! |---|---|---|
//! | edge records | 20 per edge | indexed |
//! | positions, vertex normals | 12 per vertex each | indexed |
//! | triangles | 12 per face | indexed |
//! | face planes | 32 per face | indexed |
//! | cones around 32 faces | 1 per face | indexed |
//! | edge vertices | 320, 160 or 192 per edge | replicated, at 16 bits, face normals |
//! | cones around 64 edges | 0.5 per edge | all |
//! | links | 12 per edge | all, with [`MeshOptions::links`] |
//! | positions and triangles of the fill | 12 per vertex, 12 per face | replicated, or in chunks |
//!
//! In the indexed layout the fill and the strokes share positions and triangles. The lists that
//! a view makes of a chunk are in `view/live_lists.rs`.

use std::cell::Cell;
use std::sync::Arc;

use bytemuck::Pod;
use edgemesh::edge_mesh::{
    Bounds, EdgeMesh, EdgeVertex, EdgeVertex16, FacePlane, FinVertex, NormalCone, Quantization,
    fins, replicate, replicate_16,
};
use edgemesh::index::{MAX_INDEX, NONE, to_u32};
use glam::Vec3;
use rayon::prelude::*;
use thiserror::Error;
use wgpu::BufferUsages;
use wgpu::util::DeviceExt as _;

use crate::gpu::bind::uniform_buffer;
use crate::mesh::capacity::{node_capacity, stroke_capacity};
use crate::mesh::chunk::{Chunk, ChunkLimits, chunks};
use crate::mesh::geometry::{ChunkGeometry, EdgeGeometry, Geometry, SurfaceGeometry};
use crate::mesh::layout::{ChunkUniform, EDGES_PER_RUN, FACES_PER_WORD, Layout, PackedRecord};
use crate::mesh::link_table::LinkTable;
use crate::mesh::surface::{SurfaceArrays, SurfaceBuffers};

/// Bytes of `RunState` in `view/live_lists.rs`.
pub(crate) const RUN_STATE_BYTES: usize = 40;

/// The mesh does not fit the device.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
#[error(
    "the mesh is too large for this adapter: its {what} need {need} bytes in one buffer, the \
     adapter takes {limit}"
)]
pub struct MeshTooLarge {
    /// Contents of the buffer, in the plural.
    pub what: &'static str,
    /// Bytes needed.
    pub need: u64,
    /// The most bytes of a buffer.
    pub limit: u64,
}

/// How a mesh is uploaded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct MeshOptions {
    /// How edges lie in memory.
    pub layout: Layout,
    /// Whether edges can be linked into strokes: 12 bytes more per edge.
    pub links: bool,
    /// Whether the surface can be shaded: 32 bytes per corner with distinct attributes, and 4
    /// for its color if the mesh has any.
    pub surface: bool,
    /// How many objects of meshes with several objects are drawn at once: the more, the less room
    /// each has for the strokes of a view. 0 counts as 1, as for a mesh with one object.
    pub objects: u32,
}

impl From<Layout> for MeshOptions {
    /// Edges drawn one by one, without a surface.
    fn from(layout: Layout) -> Self {
        Self { layout, ..Self::default() }
    }
}

/// The buffers of a chunk that are the same in all poses.
#[derive(Debug)]
pub(crate) struct ChunkBuffers {
    pub(crate) size: ChunkUniform,
    pub(crate) uniform: wgpu::Buffer,
    /// With [`MeshOptions::links`].
    pub(crate) links: Option<wgpu::Buffer>,
}

/// Triangles that hide strokes.
#[derive(Debug)]
pub(crate) struct FillTriangles {
    pub(crate) triangles: wgpu::Buffer,
    pub(crate) index_count: u32,
}

/// An edge mesh on the GPU.
#[derive(Debug)]
pub struct MeshBuffers {
    options: MeshOptions,
    pub(crate) chunks: Vec<ChunkBuffers>,
    /// One per buffer of [`Geometry::fill`].
    pub(crate) fill: Vec<FillTriangles>,
    surface: Option<SurfaceBuffers>,
    rest: Arc<Geometry>,
    bounds: Bounds,
    byte_count: u64,
}

impl MeshBuffers {
    /// Uploads `mesh`.
    ///
    /// # Errors
    /// [`MeshTooLarge`], before anything is uploaded, if the adapter cannot bind a run of 64
    /// edges with its faces, or cannot hold the surface.
    ///
    /// # Panics
    /// If an index of `mesh` is out of range; meshes that `edgemesh` builds or reads have none.
    pub fn new(
        device: &wgpu::Device,
        mesh: &EdgeMesh,
        options: impl Into<MeshOptions>,
    ) -> Result<Self, MeshTooLarge> {
        let options = options.into();
        let layout = options.layout;
        let limits = chunk_limits(device, layout, mesh.records.len())?;
        let surface = options.surface.then(|| surface_arrays(device, mesh, layout)).transpose()?;
        let links = options.links.then(|| LinkTable::of(mesh));
        let chunks = chunks(mesh, &limits);
        let upload = Upload {
            device,
            layout,
            objects: options.objects,
            mesh,
            quantization: Quantization::of(&mesh.bounds),
            replicated: replicated_words(mesh, layout),
            shared_positions: surface
                .as_ref()
                .map(|arrays| &arrays.positions[..])
                .filter(|positions| chunks.len() == 1 && fits_binding(device, positions)),
            byte_count: Cell::new(0),
        };
        let mut geometry = Geometry { chunks: Vec::new(), fill: Vec::new(), surface: None };
        let mut chunk_buffers = Vec::new();
        for (index, chunk) in chunks.iter().enumerate() {
            let (buffers, of_chunk) = upload.chunk(index, chunk, links.as_ref());
            chunk_buffers.push(buffers);
            geometry.chunks.push(of_chunk);
        }
        // One chunk in the indexed layout shares its positions with the fill and the surface.
        let shared = match &geometry.chunks[..] {
            [ChunkGeometry { edges: EdgeGeometry::Indexed { positions, triangles, .. }, .. }] => {
                Some((positions.clone(), triangles.clone()))
            }
            _ => None,
        };
        let fill = match &shared {
            Some((positions, triangles)) => {
                geometry.fill.push(positions.clone());
                let (triangles, index_count) =
                    (triangles.clone(), to_u32(3 * mesh.triangles.len()));
                vec![FillTriangles { triangles, index_count }]
            }
            None => upload.fill(&mut geometry.fill),
        };
        let surface = surface.as_ref().map(|arrays| {
            let is_shared = upload.shared_positions.is_some();
            let positions = shared.map(|(positions, _)| positions).filter(|_| is_shared);
            let (buffers, of_surface) = upload.surface(arrays, positions);
            geometry.surface = Some(of_surface);
            buffers
        });
        Ok(Self {
            options,
            chunks: chunk_buffers,
            fill,
            surface,
            rest: Arc::new(geometry),
            bounds: mesh.bounds,
            byte_count: upload.byte_count.get(),
        })
    }

    /// The options of the upload.
    #[must_use]
    pub const fn options(&self) -> MeshOptions {
        self.options
    }

    /// The box around the mesh.
    #[must_use]
    pub const fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// The geometry without a pose.
    pub(crate) const fn rest(&self) -> &Arc<Geometry> {
        &self.rest
    }

    /// The triangles of the surface; `None` without [`MeshOptions::surface`].
    #[must_use]
    pub const fn surface(&self) -> Option<&SurfaceBuffers> {
        self.surface.as_ref()
    }

    /// Bytes of all buffers of the mesh.
    #[must_use]
    pub const fn byte_count(&self) -> u64 {
        self.byte_count
    }

    /// Number of chunks.
    #[must_use]
    pub const fn chunk_count(&self) -> usize {
        self.chunks.len()
    }
}

/// How much of a mesh the device can bind at once.
fn chunk_limits(
    device: &wgpu::Device,
    layout: Layout,
    edge_count: usize,
) -> Result<ChunkLimits, MeshTooLarge> {
    let limits = device.limits();
    let limit = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
    let bytes_per_edge = match layout {
        Layout::Indexed => 20,
        Layout::Replicated => 4 * size_of::<EdgeVertex>(),
        Layout::Replicated16 => 4 * size_of::<EdgeVertex16>(),
        Layout::FaceNormals => 4 * size_of::<FinVertex>(),
    };
    let bytes = usize::try_from(limit).unwrap_or(usize::MAX);
    // The least chunk is a run of edges with its faces.
    let run = EDGES_PER_RUN as usize;
    let needs = [
        ("edges", run * bytes_per_edge),
        ("face planes", 2 * run * size_of::<FacePlane>()),
        // All of them are one buffer.
        ("run states", edge_count.div_ceil(run).max(1) * RUN_STATE_BYTES),
    ];
    for (what, need) in needs {
        if need > bytes {
            return Err(MeshTooLarge { what, need: need as u64, limit });
        }
    }
    // Three bits of each entry of the live list are flags.
    let edges = (bytes / bytes_per_edge).min(MAX_INDEX / 2);
    Ok(ChunkLimits { edges, faces: bytes / size_of::<FacePlane>(), vertices: bytes / 12 })
}

fn fits_binding(device: &wgpu::Device, positions: &[[f32; 3]]) -> bool {
    size_of_val(positions) as u64 <= device.limits().max_storage_buffer_binding_size
}

/// The words of all edge vertices of a replicated layout; none in the indexed layout.
fn replicated_words(mesh: &EdgeMesh, layout: Layout) -> Vec<u32> {
    match layout {
        Layout::Indexed => Vec::new(),
        Layout::Replicated => bytemuck::pod_collect_to_vec(&replicate(mesh)),
        Layout::Replicated16 => bytemuck::pod_collect_to_vec::<_, u32>(&replicate_16(mesh)),
        Layout::FaceNormals => bytemuck::pod_collect_to_vec(&fins(mesh)),
    }
}

/// The surface of `mesh`, with the positions of `layout`.
fn surface_arrays(
    device: &wgpu::Device,
    mesh: &EdgeMesh,
    layout: Layout,
) -> Result<SurfaceArrays, MeshTooLarge> {
    let mut arrays = SurfaceArrays::of(mesh);
    let limits = device.limits();
    let (buffer, binding) = (limits.max_buffer_size, limits.max_storage_buffer_binding_size);
    for (what, need, limit) in [
        ("surface vertices", size_of_val(&*arrays.positions) as u64, buffer),
        ("surface triangles", size_of_val(&*arrays.indices) as u64, buffer),
        ("vertex colors", size_of_val(&*arrays.colors) as u64, buffer.min(binding)),
    ] {
        if need > limit {
            return Err(MeshTooLarge { what, need, limit });
        }
    }
    if layout == Layout::Replicated16 {
        let steps = Quantization::of(&mesh.bounds);
        for position in &mut arrays.positions {
            *position = steps.dequantize(steps.quantize(*position));
        }
    }
    Ok(arrays)
}

struct Upload<'a> {
    device: &'a wgpu::Device,
    layout: Layout,
    /// As in [`MeshOptions`].
    objects: u32,
    mesh: &'a EdgeMesh,
    quantization: Quantization,
    /// See [`replicated_words`].
    replicated: Vec<u32>,
    /// Positions of the surface, which begin with those of the mesh, if the only chunk can
    /// bind them.
    shared_positions: Option<&'a [[f32; 3]]>,
    byte_count: Cell<u64>,
}

impl Upload<'_> {
    fn items<T: Pod>(&self, label: &str, items: &[T], usage: BufferUsages) -> wgpu::Buffer {
        // A binding must not be empty, nor smaller than one element.
        let blank = [T::zeroed(); 2];
        let items = if items.is_empty() { &blank } else { items };
        let contents = bytemuck::cast_slice(items);
        self.byte_count.set(self.byte_count.get() + contents.len() as u64);
        let label = Some(label);
        self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label, contents, usage })
    }

    fn chunk(
        &self,
        index: usize,
        chunk: &Chunk,
        links: Option<&LinkTable>,
    ) -> (ChunkBuffers, ChunkGeometry) {
        let edge_count = chunk.records.len();
        let size = ChunkUniform {
            face_count: to_u32(chunk.triangles.len()),
            edge_count: to_u32(edge_count),
            run_count: to_u32(edge_count).div_ceil(EDGES_PER_RUN),
            capacity: stroke_capacity(self.device, edge_count, self.objects),
            first_run: to_u32(chunk.edges.start) / EDGES_PER_RUN,
            chunk_index: to_u32(index),
            node_capacity: node_capacity(
                self.device,
                edge_count,
                self.mesh.records.len(),
                self.objects,
            ),
            padding: 0,
        };
        let storage = BufferUsages::STORAGE;
        let cones = match self.layout {
            Layout::Replicated16 => run_cones(chunk, &rounded_planes(chunk, &self.quantization)),
            _ => run_cones(chunk, &chunk.planes),
        };
        let geometry = ChunkGeometry {
            edges: self.edges(chunk),
            run_cones: self.items("run cones", &cones, storage),
        };
        let buffers = ChunkBuffers {
            size,
            uniform: uniform_buffer(self.device, "chunk", &size),
            links: links.map(|links| self.items("links", &links.chunk(&chunk.edges), storage)),
        };
        (buffers, geometry)
    }

    fn edges(&self, chunk: &Chunk) -> EdgeGeometry {
        let storage = BufferUsages::STORAGE;
        if self.layout != Layout::Indexed {
            let words_per_edge = self.replicated.len() / self.mesh.records.len().max(1);
            let range = chunk.edges.start * words_per_edge..chunk.edges.end * words_per_edge;
            let usage = storage | BufferUsages::VERTEX;
            let vertices = self.items("edge vertices", &self.replicated[range], usage);
            return EdgeGeometry::Replicated { vertices };
        }
        let cones: Vec<NormalCone> = chunk
            .planes
            .par_chunks(FACES_PER_WORD)
            .map(|planes| NormalCone::of(planes.iter()))
            .collect();
        let positions = self.shared_positions.unwrap_or(&chunk.positions);
        EdgeGeometry::Indexed {
            records: self.items("edge records", &chunk.records, storage),
            triangles: self.items("triangles", &chunk.triangles, storage | BufferUsages::INDEX),
            positions: self.items("positions", positions, storage | BufferUsages::VERTEX),
            normals: self.items("vertex normals", &chunk.normals, storage),
            planes: self.items("face planes", &chunk.planes, storage),
            face_cones: self.items("face cones", &cones, storage),
        }
    }

    /// Triangles for the fill alone, in parts that fit a buffer; pushes their positions to
    /// `positions`.
    fn fill(&self, positions: &mut Vec<wgpu::Buffer>) -> Vec<FillTriangles> {
        let mesh = self.mesh;
        let (layout, steps) = (self.layout, &self.quantization);
        let position = |position: [f32; 3]| match layout {
            Layout::Replicated16 => steps.dequantize(steps.quantize(position)),
            _ => position,
        };
        let most = usize::try_from(self.device.limits().max_buffer_size).unwrap_or(usize::MAX) / 12;
        let mut buffers = |corners: &[[f32; 3]], triangles: &[[u32; 3]]| {
            positions.push(self.items("fill positions", corners, BufferUsages::VERTEX));
            FillTriangles {
                triangles: self.items("fill triangles", triangles, BufferUsages::INDEX),
                index_count: to_u32(3 * triangles.len()),
            }
        };
        if mesh.positions.len() <= most && mesh.triangles.len() <= most {
            let corners: Vec<[f32; 3]> = mesh.positions.par_iter().map(|&p| position(p)).collect();
            return vec![buffers(&corners, &mesh.triangles)];
        }
        // Triangles share no corners, so no part has more than it can hold.
        let mut part = |triangles: &[[u32; 3]]| {
            let corners: Vec<[f32; 3]> = triangles
                .iter()
                .flatten()
                .map(|&vertex| position(mesh.positions[vertex as usize]))
                .collect();
            let triangles: Vec<[u32; 3]> = (0..to_u32(triangles.len()))
                .map(|face| [3 * face, 3 * face + 1, 3 * face + 2])
                .collect();
            buffers(&corners, &triangles)
        };
        mesh.triangles.chunks((most / 3).max(1)).map(&mut part).collect()
    }

    /// The surface, with `positions` if they are on the GPU already.
    fn surface(
        &self,
        arrays: &SurfaceArrays,
        positions: Option<wgpu::Buffer>,
    ) -> (SurfaceBuffers, SurfaceGeometry) {
        let vertex = BufferUsages::VERTEX;
        let own = || self.items("surface positions", &arrays.positions, vertex);
        let geometry = SurfaceGeometry {
            positions: positions.unwrap_or_else(own),
            normals: self.items("surface normals", &arrays.normals, vertex),
        };
        let buffers = SurfaceBuffers {
            texcoords: self.items("texture coordinates", &arrays.texcoords, vertex),
            colors: (!arrays.colors.is_empty())
                .then(|| self.items("vertex colors", &arrays.colors, BufferUsages::STORAGE)),
            indices: self.items("surface triangles", &arrays.indices, BufferUsages::INDEX),
            ranges: arrays.ranges.clone(),
        };
        (buffers, geometry)
    }
}

/// The cones around the faces of each run of edges.
fn run_cones(chunk: &Chunk, planes: &[FacePlane]) -> Vec<NormalCone> {
    let of_run = |run: &[PackedRecord]| {
        let faces = run.iter().flat_map(|record| [record.face_a, record.face_b]);
        NormalCone::of(faces.filter(|&face| face != NONE).map(|face| &planes[face as usize]))
    };
    chunk.records.par_chunks(EDGES_PER_RUN as usize).map(of_run).collect()
}

/// The planes of a chunk's faces at 16 bits. A face whose rounded corners have no area, or turn
/// it over, gets no normal, so that no cone stands for it: the edge vertices give it its
/// neighbor's plane.
fn rounded_planes(chunk: &Chunk, quantization: &Quantization) -> Vec<FacePlane> {
    let plane = |(triangle, plane): (&[u32; 3], &FacePlane)| {
        let corners = triangle.map(|vertex| {
            let steps = quantization.quantize(chunk.positions[vertex as usize]);
            Vec3::from(quantization.dequantize(steps)).as_dvec3()
        });
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a).normalize_or_zero().as_vec3();
        let is_kept = normal.dot(Vec3::from_slice(&plane.normal)) > 0.0;
        let normal = if is_kept { normal } else { Vec3::ZERO };
        FacePlane { normal: normal.extend(0.0).into(), point: a.as_vec3().extend(1.0).into() }
    };
    chunk.triangles.par_iter().zip(&chunk.planes[..]).map(plane).collect()
}
