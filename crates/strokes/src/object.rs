//! An object of a scene: a mesh, where it stands, and how it looks.

use std::sync::Arc;

use edgemesh::camera::View;
use edgemesh::oracle::stroke_segment::LineKind;
use glam::{DMat4, Vec2};

use crate::detect::DetectDraw;
use crate::frame::{ObjectUniform, bind_buffers, uniform_buffer};
use crate::gpu::Gpu;
use crate::look::Visibility;
use crate::mesh_buffers::{ChunkBuffers, EdgeSource, MeshBuffers};
use crate::readback::{ReadbackError, read_buffer};
use crate::renderer::{DetectionPath, PreparedDraw, PreparedLook, Renderer};
use crate::stroke_layouts::StrokeLayouts;
use crate::view_buffers::{Tally, ViewBuffers};

/// An object of a scene.
#[derive(Debug)]
pub struct Object {
    /// Takes the positions of its mesh to the scene.
    pub world_from_object: DMat4,
    pub(crate) mesh: Arc<MeshBuffers>,
    pub(crate) look: Arc<PreparedLook>,
    pub(crate) fill_group: wgpu::BindGroup,
    pub(crate) parts: Vec<ObjectPart>,
    /// Whether what no view changes is still to be worked out.
    pub(crate) is_stale: bool,
    /// False where the transform flattens the object to nothing.
    pub(crate) is_placed: bool,
    uniform: wgpu::Buffer,
}

/// What one chunk of the object needs.
#[derive(Debug)]
pub(crate) struct ObjectPart {
    /// `@group(2)` of its edges.
    pub(crate) edges: wgpu::BindGroup,
    /// `@group(3)` where every edge is drawn by its index.
    pub(crate) planes: Option<wgpu::BindGroup>,
    /// Where detection runs in compute shaders.
    pub(crate) lists: Option<PartLists>,
}

/// The lists of a view, and how they are bound.
#[derive(Debug)]
pub(crate) struct PartLists {
    pub(crate) view: ViewBuffers,
    pub(crate) detect: DetectDraw,
    /// `@group(3)` of the expansion, one a draw.
    pub(crate) expand: Vec<Option<wgpu::BindGroup>>,
    /// `@group(3)` of strokes from the list.
    pub(crate) listed: wgpu::BindGroup,
}

impl Object {
    pub(crate) fn new(
        gpu: &Gpu,
        renderer: &Renderer,
        mesh: Arc<MeshBuffers>,
        look: Arc<PreparedLook>,
    ) -> Self {
        let device = &gpu.device;
        let empty: ObjectUniform = bytemuck::Zeroable::zeroed();
        let uniform = uniform_buffer(device, "object", &empty);
        let expanded = |draw: &PreparedDraw| (!draw.lies_over_surface).then_some(draw.kind);
        let expanded: Vec<Option<LineKind>> = look.draws.iter().map(expanded).collect();
        let part = |chunk: &ChunkBuffers| {
            let lists = (renderer.options.path == DetectionPath::Compute)
                .then(|| lists(device, renderer, &uniform, chunk, look.layer_count, &expanded));
            ObjectPart {
                edges: edges_group(device, renderer, &uniform, chunk),
                planes: planes_group(device, &renderer.layouts, chunk),
                lists,
            }
        };
        Self {
            world_from_object: DMat4::IDENTITY,
            fill_group: renderer.fill.draw(device, &uniform),
            parts: mesh.chunks.iter().map(part).collect(),
            mesh,
            look,
            is_stale: true,
            is_placed: true,
            uniform,
        }
    }

    /// Sets what the next submission sees of the object.
    pub(crate) fn look_from(&mut self, gpu: &Gpu, view: &View, viewport_px: Vec2) {
        let uniform =
            ObjectUniform::new(view, viewport_px, self.world_from_object, &self.mesh.bounds);
        self.is_placed = uniform.is_some();
        if let Some(uniform) = uniform {
            gpu.queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&uniform));
        }
    }

    /// The mesh.
    #[must_use]
    pub fn mesh(&self) -> &MeshBuffers {
        &self.mesh
    }

    pub(crate) fn has_silhouette(&self) -> bool {
        self.look.draws.iter().any(|draw| draw.visibility == Visibility::Silhouette)
    }

    /// The counts of the last view, or nothing where vertex shaders detect.
    ///
    /// # Errors
    /// Where the device is lost.
    pub fn read_tally(&self, gpu: &Gpu) -> Result<Tally, ReadbackError> {
        let mut sum = Tally::default();
        for lists in self.parts.iter().filter_map(|part| part.lists.as_ref()) {
            for tally in read_buffer::<Tally>(gpu, &lists.view.tally, 1)? {
                sum = sum.plus(&tally);
            }
        }
        Ok(sum)
    }

    /// The live list of one chunk in the last view: each entry is the index of a
    /// record of the chunk, with the first three of `LineBits` above it.
    ///
    /// # Errors
    /// Where the device is lost.
    pub fn read_live(&self, gpu: &Gpu, chunk: usize) -> Result<Vec<u32>, ReadbackError> {
        let lists = self.parts.get(chunk).and_then(|part| part.lists.as_ref());
        let Some(lists) = lists else { return Ok(Vec::new()) };
        let tallies: Vec<Tally> = read_buffer(gpu, &lists.view.tally, 1)?;
        let count = tallies.first().map_or(0, |tally| tally.stroke_count);
        read_buffer(gpu, &lists.view.live, count as usize)
    }

    /// The facing bits of one chunk in the last view, 32 faces a word; of the
    /// indexed layout.
    ///
    /// # Errors
    /// Where the device is lost.
    pub fn read_facing(&self, gpu: &Gpu, chunk: usize) -> Result<Vec<u32>, ReadbackError> {
        let lists = self.parts.get(chunk).and_then(|part| part.lists.as_ref());
        let Some(lists) = lists else { return Ok(Vec::new()) };
        let words = self.mesh.chunks[chunk].size.face_count.div_ceil(32);
        read_buffer(gpu, &lists.view.facing, words as usize)
    }
}

fn lists(
    device: &wgpu::Device,
    renderer: &Renderer,
    uniform: &wgpu::Buffer,
    chunk: &ChunkBuffers,
    layer_count: u32,
    expanded: &[Option<LineKind>],
) -> PartLists {
    let layouts = &renderer.layouts;
    let view = ViewBuffers::new(device, &chunk.size, layer_count, expanded);
    let read = [(0, &view.live), (1, &view.draws)];
    let expand = view.vertices.iter().map(|vertices| {
        let buffers = [(0, &view.live), (1, &view.draws), (2, vertices.as_ref()?)];
        Some(bind_buffers(device, "expand strokes", &layouts.expand, &buffers))
    });
    PartLists {
        detect: renderer.detect.draw(device, uniform, chunk, &view),
        expand: expand.collect(),
        listed: bind_buffers(device, "listed strokes", &layouts.listed, &read),
        view,
    }
}

fn edges_group(
    device: &wgpu::Device,
    renderer: &Renderer,
    uniform: &wgpu::Buffer,
    chunk: &ChunkBuffers,
) -> wgpu::BindGroup {
    let layouts = &renderer.layouts;
    let object = [(0, uniform), (1, &chunk.uniform)];
    match &chunk.source {
        EdgeSource::Indexed { records, positions, normals, triangles, .. } => {
            let edges = [(2, records), (3, positions), (4, normals), (5, triangles)];
            let buffers = [&object[..], &edges].concat();
            bind_buffers(device, "edges", &layouts.edges, &buffers)
        }
        EdgeSource::Replicated { .. } if renderer.options.path == DetectionPath::Vertex => {
            bind_buffers(device, "object", &layouts.object, &object)
        }
        EdgeSource::Replicated { vertices } => {
            let buffers = [&object[..], &[(2, vertices)]].concat();
            bind_buffers(device, "edges", &layouts.edges, &buffers)
        }
    }
}

fn planes_group(
    device: &wgpu::Device,
    layouts: &StrokeLayouts,
    chunk: &ChunkBuffers,
) -> Option<wgpu::BindGroup> {
    let EdgeSource::Indexed { planes, .. } = &chunk.source else { return None };
    Some(bind_buffers(device, "planes", &layouts.planes, &[(0, planes)]))
}
