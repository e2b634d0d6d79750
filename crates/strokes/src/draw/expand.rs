//! Expansion: computes the vertices of each live stroke once.
//!
//! A stroke with caps has ten vertices in four triangles. Vertex shaders would fetch, clip and
//! project its edge ten times; the expansion does it once, and the vertex shader passes the
//! result on. Software drivers, which run vertex shaders on one thread and compute shaders on
//! all, gain most.
//!
//! There is room for a part of the edges (`mesh/capacity.rs`). A view with more strokes draws
//! the rest from the live list, after the others and with the same vertices, so no view costs
//! memory for the worst one.
//!
//! Rejected: room for every edge, 200 bytes each; reading the counts on the CPU, which would
//! wait for the GPU in every frame.

use edgemesh::line::LineKind;
use edgemesh_shaders::ShaderError;

use crate::draw::stroke_layouts::StrokeLayouts;
use crate::gpu::bind::compute_pipeline;
use crate::mesh::layout::Layout;
use crate::view::live_lists::{ChunkLists, DrawArguments, GROUPS_OFFSET};

/// The compute pipeline for one kind of line in one layout.
#[derive(Debug)]
pub(crate) struct ExpandPipeline(wgpu::ComputePipeline);

impl ExpandPipeline {
    pub(crate) fn new(
        device: &wgpu::Device,
        layouts: &StrokeLayouts,
        layout: Layout,
        kind: LineKind,
    ) -> Result<Self, ShaderError> {
        let module = layout.shader_module(device, "expand_strokes.wgsl")?;
        let groups = layouts.groups(Some(&layouts.edges), Some(&layouts.expand));
        let constants = [("VERTEX_COUNT", f64::from(kind.vertex_count()))];
        Ok(Self(compute_pipeline(device, &module, "expand_strokes", &groups, &constants)))
    }

    /// Records the expansion for the stroke set `set_index`; `@group(0)` must be the frame,
    /// `@group(1)` the style, `@group(2)` the edges.
    pub(crate) fn record(
        &self,
        pass: &mut wgpu::ComputePass,
        group: &wgpu::BindGroup,
        lists: &ChunkLists,
        set_index: usize,
    ) {
        pass.set_pipeline(&self.0);
        pass.set_bind_group(3, group, &[]);
        let offset = (set_index * size_of::<DrawArguments>()) as u64 + GROUPS_OFFSET;
        pass.dispatch_workgroups_indirect(&lists.arguments, offset);
    }
}
