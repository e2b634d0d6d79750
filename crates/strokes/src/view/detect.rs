//! Detection: one facing bit a face, then the live edges by layer, in order.
//!
//! Small dispatches: `detect_faces` packs 32 facing bits an invocation, most of
//! them by one look at a cone of normals; `count_runs`, `scan_runs` and
//! `write_runs` list the edges to draw without any race, so that the same view
//! always gives the same list. `mark_static` goes before them when the classes
//! change, and works out what no view does.
//!
//! Rejected: appending with one atomic counter, which is as fast but gives another
//! order every time. The paper's own way, every edge through the vertex shader,
//! is in [`crate::draw::stroke`], to compare with.

use bytemuck::{Pod, Zeroable};
use edgemesh_shaders::ShaderError;
use wgpu::ShaderStages;

use crate::gpu::bind::{
    bind_buffers, bind_layout, compute_pipeline, storage_entry, uniform_buffer, uniform_entry,
};
use crate::gpu::shader::embedded_module;
use crate::mesh::buffers::{ChunkBuffers, EdgeSource};
use crate::mesh::layout::{FACES_PER_WORD, Layout};
use crate::style::drawing_style::{Look, MAX_DRAWS};
use crate::view::live_lists::{ObjectBuffers, Tally, ViewBuffers};

/// Invocations a workgroup, as in the shaders.
const WORKGROUP: u32 = 64;

/// What detection must know of a look. WGSL twin: `shaders/detect_edges.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct DetectUniform {
    /// The fields of a [`edgemesh::line::class::ClassTable`].
    pub layers: u32,
    /// As there.
    pub drawn: u32,
    /// As there.
    pub ridge_steps: u32,
    /// As there.
    pub valley_steps: u32,
    /// As there.
    pub keeps_hidden: u32,
    /// Layers of the look.
    pub layer_count: u32,
    /// Draws of the look.
    pub draw_count: u32,
    /// Unused.
    pub padding: u32,
    /// Layer and indices an edge of each draw, 1 where none of its strokes is
    /// expanded, 1 where they are linked.
    pub draws: [[u32; 4]; MAX_DRAWS],
}

impl DetectUniform {
    /// The uniform of a look.
    #[must_use]
    pub fn new(look: &Look) -> Self {
        let table = look.class_table();
        let mut draws = [[0; 4]; MAX_DRAWS];
        let styled = look.draws();
        for (draw, styled) in draws.iter_mut().zip(&styled) {
            let index_count = edgemesh::index::to_u32(styled.style.kind.indices().len());
            let is_linked = styled.style.is_linked();
            let is_listed = styled.lies_over_surface() || is_linked;
            *draw = [styled.layer, index_count, u32::from(is_listed), u32::from(is_linked)];
        }
        Self {
            layers: table.layers,
            drawn: table.drawn,
            ridge_steps: table.ridge_steps,
            valley_steps: table.valley_steps,
            keeps_hidden: table.keeps_hidden,
            layer_count: edgemesh::index::to_u32(look.layers.len()).max(1),
            draw_count: edgemesh::index::to_u32(styled.len()),
            padding: 0,
            draws,
        }
    }
}

/// The compute pipelines of one layout.
#[derive(Debug)]
pub(crate) struct DetectPipeline {
    layouts: Layouts,
    faces: Option<wgpu::ComputePipeline>,
    mark_static: wgpu::ComputePipeline,
    count_runs: wgpu::ComputePipeline,
    scan_runs: wgpu::ComputePipeline,
    write_runs: wgpu::ComputePipeline,
}

#[derive(Debug)]
struct Layouts {
    pass: wgpu::BindGroupLayout,
    faces_draw: wgpu::BindGroupLayout,
    faces_view: wgpu::BindGroupLayout,
    edges_draw: wgpu::BindGroupLayout,
    edges_view: wgpu::BindGroupLayout,
}

/// What detection needs of one chunk of one object.
#[derive(Debug)]
pub(crate) struct DetectDraw {
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
                [Some(frame_layout), None, Some(&layouts.faces_draw), Some(&layouts.faces_view)];
            Some(pipeline(&module, "detect_faces", &groups))
        } else {
            None
        };
        let module = layout.shader_module(device, "detect_edges.wgsl")?;
        let groups = [
            Some(frame_layout),
            Some(&layouts.pass),
            Some(&layouts.edges_draw),
            Some(&layouts.edges_view),
        ];
        Ok(Self {
            faces,
            mark_static: pipeline(&module, "mark_static", &groups),
            count_runs: pipeline(&module, "count_runs", &groups),
            scan_runs: pipeline(&module, "scan_runs", &groups),
            write_runs: pipeline(&module, "write_runs", &groups),
            layouts,
        })
    }

    /// The group of a look.
    pub(crate) fn pass(&self, device: &wgpu::Device, look: &Look) -> wgpu::BindGroup {
        let uniform = uniform_buffer(device, "detect", &DetectUniform::new(look));
        bind_buffers(device, "detect", &self.layouts.pass, &[(0, &uniform)])
    }

    pub(crate) fn draw(
        &self,
        device: &wgpu::Device,
        object: &wgpu::Buffer,
        chunk: &ChunkBuffers,
        whole: &ObjectBuffers,
        view: &ViewBuffers,
    ) -> DetectDraw {
        let bind = |label, layout, buffers: &[(u32, &wgpu::Buffer)]| {
            bind_buffers(device, label, layout, buffers)
        };
        let uniform = &chunk.uniform;
        let (faces, edges) = match &chunk.source {
            EdgeSource::Indexed { planes, face_cones, records, .. } => {
                let draw = [(0, object), (1, uniform), (2, planes), (3, face_cones)];
                let draw = bind("detect faces", &self.layouts.faces_draw, &draw);
                let view = [(0, &view.facing)];
                let view = bind("detect faces", &self.layouts.faces_view, &view);
                (Some([draw, view]), records)
            }
            EdgeSource::Replicated { vertices } => (None, vertices),
        };
        let draw = [(0, object), (1, uniform), (2, edges), (6, &chunk.run_cones)];
        let mut lists = vec![
            (1, &whole.runs),
            (2, &view.counts),
            (3, &view.live),
            (4, &whole.tallies),
            (5, &view.draws),
        ];
        if faces.is_some() {
            lists.push((0, &view.facing));
        }
        DetectDraw {
            faces,
            edges: [
                bind("detect edges", &self.layouts.edges_draw, &draw),
                bind("detect edges", &self.layouts.edges_view, &lists),
            ],
            face_groups: groups(chunk.size.face_count as usize, FACES_PER_WORD),
            run_groups: groups(chunk.size.run_count as usize, 1),
        }
    }

    /// Forgets the last view's counts, and with `is_stale` what the classes gave;
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

    /// Records the detection of one chunk; `@group(0)` must be the frame and
    /// `@group(1)` the look.
    pub(crate) fn record(&self, pass: &mut wgpu::ComputePass, draw: &DetectDraw, is_stale: bool) {
        if let (Some(pipeline), Some([faces, view])) = (&self.faces, &draw.faces) {
            pass.set_pipeline(pipeline);
            pass.set_bind_group(2, faces, &[]);
            pass.set_bind_group(3, view, &[]);
            pass.dispatch_workgroups(draw.face_groups, 1, 1);
        }
        for (group, edges) in (2..).zip(&draw.edges) {
            pass.set_bind_group(group, edges, &[]);
        }
        let steps = [
            (&self.mark_static, if is_stale { draw.run_groups } else { 0 }),
            (&self.count_runs, draw.run_groups),
            (&self.scan_runs, 1),
            (&self.write_runs, draw.run_groups),
        ];
        for (pipeline, groups) in steps.into_iter().filter(|step| step.1 > 0) {
            pass.set_pipeline(pipeline);
            pass.dispatch_workgroups(groups, 1, 1);
        }
    }
}

impl Layouts {
    fn new(device: &wgpu::Device, layout: Layout) -> Self {
        let compute = ShaderStages::COMPUTE;
        let uniform = |binding| uniform_entry(binding, compute);
        let read = |binding| storage_entry(binding, compute, true);
        let write = |binding| storage_entry(binding, compute, false);
        let make = |label: &str, entries: &[wgpu::BindGroupLayoutEntry]| {
            bind_layout(device, label, entries)
        };
        let mut lists = vec![write(1), write(2), write(3), write(4), write(5)];
        if layout == Layout::Indexed {
            lists.push(read(0));
        }
        Self {
            pass: make("detect", &[uniform(0)]),
            faces_draw: make("detect faces", &[uniform(0), uniform(1), read(2), read(3)]),
            faces_view: make("detect faces", &[write(0)]),
            edges_draw: make("detect edges", &[uniform(0), uniform(1), read(2), read(6)]),
            edges_view: make("detect edges", &lists),
        }
    }
}

/// Workgroups for `count` items, so many an invocation.
fn groups(count: usize, per_invocation: usize) -> u32 {
    edgemesh::index::to_u32(count.div_ceil(per_invocation)).div_ceil(WORKGROUP)
}
