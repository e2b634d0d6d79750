//! Detection: one facing bit a face, then the live edges by layer, in order.
//!
//! `detect_faces` packs 32 facing bits per invocation, most of them after one test of a cone of
//! normals. `count_runs`, `scan_runs` and `write_runs` list the edges to draw without races, so
//! that the same view always gives the same list. `find_static` runs before them when the
//! classes change, and finds the edges that are drawn in every view.
//!
//! Rejected: appending with one atomic counter, which is as fast but gives another order every
//! time. The paper's way, every edge through the vertex shader, is in `draw/stroke.rs`, to
//! compare with.

use bytemuck::{Pod, Zeroable};
use edgemesh::index::to_u32;
use edgemesh::line::ClassTable;
use edgemesh_shaders::ShaderError;

use crate::gpu::bind::{
    bind_buffers, bind_layout, compute_pipeline, compute_read, compute_uniform, compute_write,
    uniform_buffer,
};
use crate::gpu::shader::embedded_module;
use crate::mesh::buffers::ChunkBuffers;
use crate::mesh::geometry::{ChunkGeometry, EdgeGeometry};
use crate::mesh::layout::{FACES_PER_WORD, Layout};
use crate::style::drawing_style::{DrawingStyle, MAX_STROKE_SETS};
use crate::view::live_lists::{ChunkLists, ObjectRuns, Tally};

/// Invocations per workgroup, as in the shaders.
const WORKGROUP: u32 = 64;

/// A drawing style as detection reads it. WGSL twin: `shaders/detect_edges.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct DetectUniform {
    /// Which classes are drawn, in which layer.
    pub classes: ClassTable,
    /// At least 1.
    pub layer_count: u32,
    /// How many of `sets` are in use.
    pub set_count: u32,
    /// Unused.
    pub padding: [u32; 2],
    /// The stroke sets in the order of drawing.
    pub sets: [DetectedSet; MAX_STROKE_SETS],
}

/// A stroke set as detection reads it. WGSL twin: the struct of this name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct DetectedSet {
    /// The layer whose edges are drawn.
    pub layer: u32,
    /// Indices per edge.
    pub indices_per_edge: u32,
    /// 1 if none of its strokes is expanded.
    pub is_listed: u32,
    /// 1 if its strokes are linked.
    pub is_linked: u32,
}

impl DetectUniform {
    fn new(style: &DrawingStyle) -> Self {
        let mut sets = [DetectedSet::zeroed(); MAX_STROKE_SETS];
        let stroke_sets = style.stroke_sets();
        for (detected, set) in sets.iter_mut().zip(&stroke_sets) {
            let is_linked = set.style.is_linked();
            *detected = DetectedSet {
                layer: set.layer,
                indices_per_edge: to_u32(set.style.kind.indices().len()),
                is_listed: u32::from(set.lies_over_surface() || is_linked),
                is_linked: u32::from(is_linked),
            };
        }
        Self {
            classes: style.class_table(),
            layer_count: to_u32(style.layers.len()).max(1),
            set_count: to_u32(stroke_sets.len()),
            padding: [0; 2],
            sets,
        }
    }
}

/// The compute pipelines of one layout.
#[derive(Debug)]
pub(crate) struct DetectPipeline {
    layouts: Layouts,
    faces: Option<wgpu::ComputePipeline>,
    find_static: wgpu::ComputePipeline,
    count_runs: wgpu::ComputePipeline,
    scan_runs: wgpu::ComputePipeline,
    write_runs: wgpu::ComputePipeline,
}

#[derive(Debug)]
struct Layouts {
    pass: wgpu::BindGroupLayout,
    faces_chunk: wgpu::BindGroupLayout,
    faces_view: wgpu::BindGroupLayout,
    edges_chunk: wgpu::BindGroupLayout,
    edges_view: wgpu::BindGroupLayout,
}

/// The bind groups and sizes for the detection of one chunk of an object.
#[derive(Debug)]
pub(crate) struct DetectBindings {
    faces: Option<[wgpu::BindGroup; 2]>,
    edges: [wgpu::BindGroup; 2],
    face_groups: u32,
    run_groups: u32,
}

impl DetectPipeline {
    pub(crate) fn new(
        device: &wgpu::Device,
        frame_layout: &wgpu::BindGroupLayout,
        layout: Layout,
    ) -> Result<Self, ShaderError> {
        let layouts = Layouts::new(device, layout);
        let pipeline =
            |module: &wgpu::ShaderModule, entry, groups: &[Option<&wgpu::BindGroupLayout>]| {
                compute_pipeline(device, module, entry, groups, &[])
            };
        let faces = if layout == Layout::Indexed {
            let module = embedded_module(device, "detect_faces.wgsl")?;
            let groups =
                [Some(frame_layout), None, Some(&layouts.faces_chunk), Some(&layouts.faces_view)];
            Some(pipeline(&module, "detect_faces", &groups))
        } else {
            None
        };
        let module = layout.shader_module(device, "detect_edges.wgsl")?;
        let groups = [
            Some(frame_layout),
            Some(&layouts.pass),
            Some(&layouts.edges_chunk),
            Some(&layouts.edges_view),
        ];
        Ok(Self {
            faces,
            find_static: pipeline(&module, "find_static", &groups),
            count_runs: pipeline(&module, "count_runs", &groups),
            scan_runs: pipeline(&module, "scan_runs", &groups),
            write_runs: pipeline(&module, "write_runs", &groups),
            layouts,
        })
    }

    /// `@group(1)` of a style.
    pub(crate) fn pass(&self, device: &wgpu::Device, style: &DrawingStyle) -> wgpu::BindGroup {
        let uniform = uniform_buffer(device, "detect", &DetectUniform::new(style));
        bind_buffers(device, "detect", &self.layouts.pass, &[(0, &uniform)])
    }

    /// The bindings of one chunk of an object with the uniform `object`.
    pub(crate) fn bind(
        &self,
        device: &wgpu::Device,
        object: &wgpu::Buffer,
        chunk: &ChunkBuffers,
        geometry: &ChunkGeometry,
        runs: &ObjectRuns,
        lists: &ChunkLists,
    ) -> DetectBindings {
        let bind = |label, layout, buffers: &[(u32, &wgpu::Buffer)]| {
            bind_buffers(device, label, layout, buffers)
        };
        let uniform = &chunk.uniform;
        let (faces, edges) = match &geometry.edges {
            EdgeGeometry::Indexed { planes, face_cones, records, .. } => {
                let chunk = [(0, object), (1, uniform), (2, planes), (3, face_cones)];
                let chunk = bind("detect faces", &self.layouts.faces_chunk, &chunk);
                let view = [(0, &lists.facing)];
                let view = bind("detect faces", &self.layouts.faces_view, &view);
                (Some([chunk, view]), records)
            }
            EdgeGeometry::Replicated { vertices } => (None, vertices),
        };
        let chunk_edges = [(0, object), (1, uniform), (2, edges), (6, &geometry.run_cones)];
        let mut view = vec![
            (1, &runs.runs),
            (2, &lists.counts),
            (3, &lists.live),
            (4, &runs.tallies),
            (5, &lists.arguments),
        ];
        if faces.is_some() {
            view.push((0, &lists.facing));
        }
        DetectBindings {
            faces,
            edges: [
                bind("detect edges", &self.layouts.edges_chunk, &chunk_edges),
                bind("detect edges", &self.layouts.edges_view, &view),
            ],
            face_groups: groups(chunk.size.face_count as usize, FACES_PER_WORD),
            run_groups: groups(chunk.size.run_count as usize, 1),
        }
    }

    /// Clears the counts of the last view, and with `is_stale` those of static edges; call it
    /// before [`Self::record`], outside of a pass.
    pub(crate) fn clear(
        encoder: &mut wgpu::CommandEncoder,
        tallies: &wgpu::Buffer,
        chunk_count: usize,
        is_stale: bool,
    ) {
        let whole = size_of::<Tally>() as u64;
        let bytes = if is_stale { whole } else { Tally::VIEW_BYTES };
        for chunk in 0..chunk_count as u64 {
            encoder.clear_buffer(tallies, chunk * whole, Some(bytes));
        }
    }

    /// Records the detection of one chunk; `@group(0)` must be the frame and `@group(1)` the
    /// style.
    pub(crate) fn record(
        &self,
        pass: &mut wgpu::ComputePass,
        bindings: &DetectBindings,
        is_stale: bool,
    ) {
        if let (Some(pipeline), Some([faces, view])) = (&self.faces, &bindings.faces) {
            pass.set_pipeline(pipeline);
            pass.set_bind_group(2, faces, &[]);
            pass.set_bind_group(3, view, &[]);
            pass.dispatch_workgroups(bindings.face_groups, 1, 1);
        }
        for (group, edges) in (2..).zip(&bindings.edges) {
            pass.set_bind_group(group, edges, &[]);
        }
        let steps = [
            (&self.find_static, if is_stale { bindings.run_groups } else { 0 }),
            (&self.count_runs, bindings.run_groups),
            (&self.scan_runs, 1),
            (&self.write_runs, bindings.run_groups),
        ];
        for (pipeline, groups) in steps.into_iter().filter(|step| step.1 > 0) {
            pass.set_pipeline(pipeline);
            pass.dispatch_workgroups(groups, 1, 1);
        }
    }
}

impl Layouts {
    fn new(device: &wgpu::Device, layout: Layout) -> Self {
        let (uniform, read, write) = (compute_uniform, compute_read, compute_write);
        let make = |label: &str, entries: &[wgpu::BindGroupLayoutEntry]| {
            bind_layout(device, label, entries)
        };
        let mut lists = vec![write(1), write(2), write(3), write(4), write(5)];
        if layout == Layout::Indexed {
            lists.push(read(0));
        }
        Self {
            pass: make("detect", &[uniform(0)]),
            faces_chunk: make("detect faces", &[uniform(0), uniform(1), read(2), read(3)]),
            faces_view: make("detect faces", &[write(0)]),
            edges_chunk: make("detect edges", &[uniform(0), uniform(1), read(2), read(6)]),
            edges_view: make("detect edges", &lists),
        }
    }
}

/// Workgroups for `count` items, `per_invocation` to each invocation.
fn groups(count: usize, per_invocation: usize) -> u32 {
    to_u32(count.div_ceil(per_invocation)).div_ceil(WORKGROUP)
}
