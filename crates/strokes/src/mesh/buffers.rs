//! One edge mesh on the GPU, in one of three layouts, in chunks that the adapter
//! can bind.
//!
//! | buffer | bytes | in the layouts |
//! |---|---|---|
//! | edge records | 20 an edge | indexed |
//! | positions, vertex normals | 12 a vertex each | indexed |
//! | triangles | 12 a face | indexed |
//! | face planes | 32 a face | indexed |
//! | cones around 32 faces | 1 a face | indexed |
//! | edge vertices | 320, 160 or 192 an edge | replicated, at 16 bits, face normals |
//! | cones around 64 edges | 0.5 an edge | all |
//! | links | 12 an edge | all, where strokes are to be linked |
//! | positions and triangles of the fill | 12 a vertex, 12 a face | replicated, or in chunks |
//!
//! In the indexed layout the fill and the strokes share positions and triangles.
//! What a view makes of a chunk is in [`crate::view::live_lists`].

use std::ops::Range;

use bytemuck::Pod;
use edgemesh::edge_mesh::edge_word::edge_words;
use edgemesh::edge_mesh::normal_cone::NormalCone;
use edgemesh::edge_mesh::record::{EdgeVertex, EdgeVertex16, FinVertex};
use edgemesh::edge_mesh::replicate::{Quantization, fins, replicate, replicate_16};
use edgemesh::edge_mesh::{Bounds, EdgeMesh, FacePlane};
use edgemesh::index::{MAX_INDEX, NONE, to_u32};
use glam::Vec3;
use rayon::prelude::*;
use thiserror::Error;
use wgpu::BufferUsages;
use wgpu::util::DeviceExt as _;

use crate::gpu::bind::uniform_buffer;
use crate::graph::buffers::BYTES_PER_NODE;
use crate::mesh::chunk::{Chunk, ChunkLimits, chunks};
use crate::mesh::layout::{ChunkUniform, EDGES_PER_RUN, FACES_PER_WORD, Layout};
use crate::mesh::link_table::LinkTable;
use crate::view::live_lists::{MAX_EXPANDED_BYTES, RunState};

/// Of this many edges one has room between expansion and drawing; small meshes
/// have room for all. What finds none is drawn straight from the list.
const EDGES_PER_EXPANDED: usize = 16;
const MIN_EXPANDED: usize = 1 << 14;

/// Of this many edges one can be linked into strokes; of small meshes all.
const EDGES_PER_NODE: usize = 8;
const MIN_NODES: usize = 1 << 16;

/// The mesh does not fit the device.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "the mesh is too large for this adapter: its {what} need {need} bytes in one buffer, the \
     adapter takes {limit}"
)]
pub struct MeshTooLarge {
    /// Which buffer.
    pub what: &'static str,
    /// Bytes needed.
    pub need: u64,
    /// Bytes that the device takes at most.
    pub limit: u64,
}

/// The edges of a chunk.
#[derive(Debug)]
pub(crate) enum EdgeSource {
    Indexed {
        records: wgpu::Buffer,
        positions: wgpu::Buffer,
        normals: wgpu::Buffer,
        triangles: wgpu::Buffer,
        planes: wgpu::Buffer,
        face_cones: wgpu::Buffer,
    },
    Replicated {
        vertices: wgpu::Buffer,
    },
}

/// A chunk.
#[derive(Debug)]
pub(crate) struct ChunkBuffers {
    pub(crate) size: ChunkUniform,
    pub(crate) uniform: wgpu::Buffer,
    pub(crate) source: EdgeSource,
    pub(crate) run_cones: wgpu::Buffer,
    /// Which edge follows which, where strokes can be linked.
    pub(crate) links: Option<wgpu::Buffer>,
}

/// Triangles to fill.
#[derive(Debug)]
pub(crate) struct FillBuffers {
    pub(crate) positions: wgpu::Buffer,
    pub(crate) triangles: wgpu::Buffer,
    pub(crate) index_count: u32,
}

/// The buffers of one mesh.
#[derive(Debug)]
pub struct MeshBuffers {
    pub(crate) layout: Layout,
    pub(crate) chunks: Vec<ChunkBuffers>,
    pub(crate) fill: Vec<FillBuffers>,
    pub(crate) bounds: Bounds,
    byte_count: u64,
}

impl MeshBuffers {
    /// Uploads `mesh`, to draw each edge by itself.
    ///
    /// # Errors
    /// [`MeshTooLarge`], before anything is uploaded: where the adapter cannot
    /// bind even what a run of edges needs.
    pub fn new(
        device: &wgpu::Device,
        mesh: &EdgeMesh,
        layout: Layout,
    ) -> Result<Self, MeshTooLarge> {
        Self::upload(device, mesh, layout, None)
    }

    /// Uploads `mesh`, to draw it in linked strokes too: 12 bytes an edge more.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_links(
        device: &wgpu::Device,
        mesh: &EdgeMesh,
        layout: Layout,
    ) -> Result<Self, MeshTooLarge> {
        Self::upload(device, mesh, layout, Some(LinkTable::of(mesh)))
    }

    fn upload(
        device: &wgpu::Device,
        mesh: &EdgeMesh,
        layout: Layout,
        links: Option<LinkTable>,
    ) -> Result<Self, MeshTooLarge> {
        let limits = chunk_limits(device, layout, mesh.records.len())?;
        let words = edge_words(mesh);
        let parts = chunks(mesh, &words, &limits);
        let byte_count = std::cell::Cell::new(0);
        let upload = Upload { device, edge_count: mesh.records.len(), byte_count };
        let quantization = Quantization::of(&mesh.bounds);
        let replicated = match layout {
            Layout::Indexed => Vec::new(),
            Layout::Replicated => bytemuck::pod_collect_to_vec(&replicate(mesh)),
            Layout::Replicated16 => bytemuck::pod_collect_to_vec::<_, u32>(&replicate_16(mesh)),
            Layout::FaceNormals => bytemuck::pod_collect_to_vec(&fins(mesh)),
        };
        let words_per_edge = replicated.len() / mesh.records.len().max(1);
        let chunk_buffers = |(index, part): (usize, &Chunk)| {
            let words = |edges: &Range<usize>| {
                &replicated[edges.start * words_per_edge..edges.end * words_per_edge]
            };
            let source = match layout {
                Layout::Indexed => upload.indexed(part),
                _ => EdgeSource::Replicated {
                    vertices: upload.items(
                        "edge vertices",
                        words(&part.edges),
                        BufferUsages::STORAGE | BufferUsages::VERTEX,
                    ),
                },
            };
            let cones = match layout {
                Layout::Replicated16 => run_cones(part, &rounded_planes(part, &quantization)),
                _ => run_cones(part, &part.planes),
            };
            upload.chunk(index, part, source, &cones, links.as_ref())
        };
        let chunks: Vec<ChunkBuffers> = parts.iter().enumerate().map(chunk_buffers).collect();
        let fill = match &chunks[..] {
            [ChunkBuffers { source: EdgeSource::Indexed { positions, triangles, .. }, .. }] => {
                vec![FillBuffers {
                    positions: positions.clone(),
                    triangles: triangles.clone(),
                    index_count: to_u32(3 * mesh.triangles.len()),
                }]
            }
            _ => upload.fill(mesh, layout, &quantization),
        };
        let byte_count = upload.byte_count.get();
        Ok(Self { layout, chunks, fill, bounds: mesh.bounds, byte_count })
    }

    /// Bytes of all buffers that no view changes.
    #[must_use]
    pub const fn byte_count(&self) -> u64 {
        self.byte_count
    }

    /// Whether its edges can be linked into strokes.
    #[must_use]
    pub fn has_links(&self) -> bool {
        self.chunks.iter().all(|chunk| chunk.links.is_some())
    }

    /// How many chunks the mesh is in.
    #[must_use]
    pub const fn chunk_count(&self) -> usize {
        self.chunks.len()
    }
}

/// What the device can bind of a mesh at once.
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
    // A run of edges and its faces are the least that can be worked on.
    let run = EDGES_PER_RUN as usize;
    let needs = [
        ("edges", run * bytes_per_edge),
        ("face planes", 2 * run * size_of::<FacePlane>()),
        // All of them are one buffer.
        ("run states", edge_count.div_ceil(run).max(1) * size_of::<RunState>()),
    ];
    for (what, need) in needs {
        if need > bytes {
            return Err(MeshTooLarge { what, need: need as u64, limit });
        }
    }
    // The live list has three bits of each entry for other things.
    let edges = (bytes / bytes_per_edge).min(MAX_INDEX / 2);
    Ok(ChunkLimits { edges, faces: bytes / size_of::<FacePlane>(), vertices: bytes / 12 })
}

/// Edges of a chunk that can be linked into strokes: of small meshes all, and its share
/// of what one binding can hold of the whole mesh.
fn node_capacity(device: &wgpu::Device, edge_count: usize, of_mesh: usize) -> u32 {
    let limit = device.limits().max_storage_buffer_binding_size / BYTES_PER_NODE;
    let most = u128::from(limit) * edge_count as u128 / of_mesh.max(1) as u128;
    let most = usize::try_from(most).unwrap_or(usize::MAX);
    to_u32(edge_count.min(MIN_NODES.max(edge_count / EDGES_PER_NODE)).min(most))
}

struct Upload<'a> {
    device: &'a wgpu::Device,
    /// Of the whole mesh.
    edge_count: usize,
    byte_count: std::cell::Cell<u64>,
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

    fn indexed(&self, part: &Chunk) -> EdgeSource {
        let storage = BufferUsages::STORAGE;
        let cones: Vec<NormalCone> = part
            .planes
            .par_chunks(FACES_PER_WORD)
            .map(|planes| NormalCone::of(planes.iter()))
            .collect();
        EdgeSource::Indexed {
            records: self.items("edge records", &part.records, storage),
            positions: self.items("positions", &part.positions, storage | BufferUsages::VERTEX),
            normals: self.items("vertex normals", &part.normals, storage),
            triangles: self.items("triangles", &part.triangles, storage | BufferUsages::INDEX),
            planes: self.items("face planes", &part.planes, storage),
            face_cones: self.items("face cones", &cones, storage),
        }
    }

    fn chunk(
        &self,
        index: usize,
        part: &Chunk,
        source: EdgeSource,
        cones: &[NormalCone],
        links: Option<&LinkTable>,
    ) -> ChunkBuffers {
        let edge_count = part.records.len();
        let most = MAX_EXPANDED_BYTES.min(self.device.limits().max_storage_buffer_binding_size);
        let most = most / u64::from(crate::draw::expand::BYTES_PER_STROKE);
        let most = usize::try_from(most).unwrap_or(usize::MAX);
        let size = ChunkUniform {
            face_count: to_u32(part.triangles.len()),
            edge_count: to_u32(edge_count),
            run_count: to_u32(edge_count).div_ceil(EDGES_PER_RUN),
            capacity: to_u32(
                edge_count.min(MIN_EXPANDED.max(edge_count / EDGES_PER_EXPANDED)).min(most),
            ),
            first_run: to_u32(part.edges.start) / EDGES_PER_RUN,
            chunk_index: to_u32(index),
            node_capacity: node_capacity(self.device, edge_count, self.edge_count),
            padding: 0,
        };
        ChunkBuffers {
            size,
            uniform: uniform_buffer(self.device, "chunk", &size),
            source,
            run_cones: self.items("run cones", cones, BufferUsages::STORAGE),
            links: links
                .map(|links| self.items("links", &links.chunk(&part.edges), BufferUsages::STORAGE)),
        }
    }

    /// Triangles for the fill alone, in parts that fit a buffer.
    fn fill(
        &self,
        mesh: &EdgeMesh,
        layout: Layout,
        quantization: &Quantization,
    ) -> Vec<FillBuffers> {
        let position = |position: [f32; 3]| match layout {
            Layout::Replicated16 => quantization.dequantize(quantization.quantize(position)),
            _ => position,
        };
        let most = usize::try_from(self.device.limits().max_buffer_size).unwrap_or(usize::MAX) / 12;
        let buffers = |positions: &[[f32; 3]], triangles: &[[u32; 3]]| FillBuffers {
            positions: self.items("fill positions", positions, BufferUsages::VERTEX),
            triangles: self.items("fill triangles", triangles, BufferUsages::INDEX),
            index_count: to_u32(3 * triangles.len()),
        };
        if mesh.positions.len() <= most && mesh.triangles.len() <= most {
            let positions: Vec<[f32; 3]> =
                mesh.positions.par_iter().map(|&p| position(p)).collect();
            return vec![buffers(&positions, &mesh.triangles)];
        }
        // Each triangle with corners of its own: no part has more than it can hold.
        let corners = |part: &[[u32; 3]]| {
            let positions: Vec<[f32; 3]> = part
                .iter()
                .flatten()
                .map(|&vertex| position(mesh.positions[vertex as usize]))
                .collect();
            let triangles: Vec<[u32; 3]> = (0..to_u32(part.len()))
                .map(|face| [3 * face, 3 * face + 1, 3 * face + 2])
                .collect();
            buffers(&positions, &triangles)
        };
        mesh.triangles.chunks((most / 3).max(1)).map(corners).collect()
    }
}

/// The cones around the faces of each run of edges.
fn run_cones(part: &Chunk, planes: &[FacePlane]) -> Vec<NormalCone> {
    let of_run = |run: &[[u32; 5]]| {
        let faces = run.iter().flat_map(|&[_, _, face_a, face_b, _]| [face_a, face_b]);
        NormalCone::of(faces.filter(|&face| face != NONE).map(|face| &planes[face as usize]))
    };
    part.records.par_chunks(EDGES_PER_RUN as usize).map(of_run).collect()
}

/// The planes of a chunk's faces as they are at 16 bits. A face whose rounded
/// corners say nothing of where it looks has none, and no cluster answers for it:
/// one without area, which stands in its neighbour's plane in the vertices.
fn rounded_planes(part: &Chunk, quantization: &Quantization) -> Vec<FacePlane> {
    let plane = |(triangle, plane): (&[u32; 3], &FacePlane)| {
        let corners = triangle.map(|vertex| {
            let steps = quantization.quantize(part.positions[vertex as usize]);
            Vec3::from(quantization.dequantize(steps)).as_dvec3()
        });
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a).normalize_or_zero().as_vec3();
        let is_told = normal.dot(Vec3::from_slice(&plane.normal)) > 0.0;
        let normal = if is_told { normal } else { Vec3::ZERO };
        FacePlane { normal: normal.extend(0.0).into(), point: a.as_vec3().extend(1.0).into() }
    };
    part.triangles.par_iter().zip(&part.planes[..]).map(plane).collect()
}
