//! Linking: every drawn edge becomes a node with a successor, and the nodes become chains
//! (`shaders/graph/link_*.wgsl`).
//!
//! Nothing is read back: the first dispatch writes the sizes of the others. There are as many
//! rounds as the longest chain could need; a round that changes nothing costs next to nothing.

use edgemesh::index::to_u32;
use edgemesh_shaders::ShaderError;

use crate::gpu::bind::{
    bind_buffers, bind_layout, compute_pipeline, compute_read, compute_uniform, compute_write,
    uniform_buffer,
};
use crate::gpu::shader::embedded_module;
use crate::graph::buffers::arguments::{CHUNK_GROUPS, NODE_GROUPS, NODE_SUM_GROUPS};
use crate::graph::buffers::{GraphBuffers, Groups, MAX_LINK_ROUNDS};
use crate::mesh::buffers::ChunkBuffers;
use crate::mesh::geometry::{ChunkGeometry, EdgeGeometry};
use crate::mesh::layout::Layout;
use crate::view::live_lists::{ChunkLists, ObjectRuns};

/// The compute pipelines of one layout.
#[derive(Debug)]
pub(crate) struct LinkPipeline {
    layouts: Layouts,
    bases: wgpu::ComputePipeline,
    elements: wgpu::ComputePipeline,
    resolve: wgpu::ComputePipeline,
    jump: wgpu::ComputePipeline,
    /// After the rounds, with the sizes of their dispatches.
    chains: Vec<(wgpu::ComputePipeline, Groups)>,
    rounds: Vec<wgpu::BindGroup>,
}

#[derive(Debug)]
struct Layouts {
    graph: wgpu::BindGroupLayout,
    bases: wgpu::BindGroupLayout,
    edges: wgpu::BindGroupLayout,
    elements: wgpu::BindGroupLayout,
    chains: wgpu::BindGroupLayout,
}

/// The bind groups for the linking of one object.
#[derive(Debug)]
pub(crate) struct LinkBindings {
    bases: wgpu::BindGroup,
    /// Edges and lists of each chunk.
    chunks: Vec<[wgpu::BindGroup; 2]>,
    /// Reading one state and writing the other, in both directions.
    chains: [wgpu::BindGroup; 2],
    rounds: usize,
}

/// A chunk whose edges are linked.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LinkedChunk<'a> {
    pub(crate) buffers: &'a ChunkBuffers,
    pub(crate) geometry: &'a ChunkGeometry,
    pub(crate) lists: &'a ChunkLists,
}

impl LinkPipeline {
    pub(crate) fn new(
        device: &wgpu::Device,
        frame: &wgpu::BindGroupLayout,
        layout: Layout,
    ) -> Result<Self, ShaderError> {
        let layouts = Layouts::new(device, layout);
        let pipeline = |module: &wgpu::ShaderModule, entry: &str, groups: [_; 4]| {
            compute_pipeline(device, module, entry, &groups, &[])
        };
        let module = embedded_module(device, "graph/link_bases.wgsl")?;
        let groups = [Some(frame), Some(&layouts.graph), None, Some(&layouts.bases)];
        let bases = pipeline(&module, "link_bases", groups);
        let module = layout.shader_module(device, "graph/link_elements.wgsl")?;
        let edges = Some(&layouts.edges);
        let groups = [Some(frame), Some(&layouts.graph), edges, Some(&layouts.elements)];
        let elements = pipeline(&module, "link_elements", groups);
        let module = embedded_module(device, "graph/link_chains.wgsl")?;
        let groups = [Some(frame), Some(&layouts.graph), None, Some(&layouts.chains)];
        let chain = |entry: &str| pipeline(&module, entry, groups);
        let (nodes, sums) = (Groups::By(NODE_GROUPS), Groups::By(NODE_SUM_GROUPS));
        let steps = [
            ("sum_chains", sums),
            ("scan_chains", Groups::One),
            ("place_chains", sums),
            ("place_elements", nodes),
            ("sum_arcs", sums),
            ("scan_arcs", Groups::One),
            ("write_arcs", sums),
        ];
        let round = |number: u32| {
            let uniform = uniform_buffer(device, "round", &[number, 0, 0, 0]);
            bind_buffers(device, "round", &layouts.graph, &[(0, &uniform)])
        };
        Ok(Self {
            bases,
            elements,
            resolve: chain("resolve_links"),
            jump: chain("jump_chains"),
            chains: steps.map(|(entry, groups)| (chain(entry), groups)).into(),
            rounds: (0..to_u32(MAX_LINK_ROUNDS)).map(round).collect(),
            layouts,
        })
    }

    /// The layout of `@group(1)`: the graph's uniform.
    pub(crate) const fn graph_layout(&self) -> &wgpu::BindGroupLayout {
        &self.layouts.graph
    }

    /// The bindings of an object with the uniform `object`; `None` if its mesh was uploaded
    /// without links.
    pub(crate) fn bind(
        &self,
        device: &wgpu::Device,
        object: &wgpu::Buffer,
        runs: &ObjectRuns,
        chunks: &[LinkedChunk],
        graph: &GraphBuffers,
    ) -> Option<LinkBindings> {
        let bases =
            [(0, &graph.header), (1, &runs.tallies), (2, &graph.bases), (3, &graph.arguments)];
        let chunk = |LinkedChunk { buffers, geometry, lists }: &LinkedChunk| {
            let mut edges = vec![(0, object), (1, &buffers.uniform)];
            match &geometry.edges {
                EdgeGeometry::Indexed { records, positions, .. } => {
                    edges.extend([(2, records), (3, positions)]);
                }
                EdgeGeometry::Replicated { vertices } => edges.push((2, vertices)),
            }
            let lists = [
                (0, &lists.live),
                (1, &runs.runs),
                (2, buffers.links.as_ref()?),
                (3, &runs.tallies),
                (4, &graph.bases),
                (5, &graph.nodes),
            ];
            Some([
                bind_buffers(device, "link edges", &self.layouts.edges, &edges),
                bind_buffers(device, "link elements", &self.layouts.elements, &lists),
            ])
        };
        let chains = |[from, to]: [usize; 2]| {
            let buffers = [
                (0, &graph.header),
                (1, &graph.nodes),
                (2, &graph.elements),
                (3, &graph.previous),
                (4, &graph.sums),
                (5, &graph.states[from]),
                (6, &graph.states[to]),
                (7, &graph.chains),
            ];
            bind_buffers(device, "chains", &self.layouts.chains, &buffers)
        };
        Some(LinkBindings {
            bases: bind_buffers(device, "link bases", &self.layouts.bases, &bases),
            chunks: chunks.iter().map(chunk).collect::<Option<_>>()?,
            chains: [[0, 1], [1, 0]].map(chains),
            rounds: graph.size.rounds(),
        })
    }

    /// Clears the links of the last view; call it before [`Self::record`], outside of a pass.
    pub(crate) fn clear(encoder: &mut wgpu::CommandEncoder, graph: &GraphBuffers) {
        encoder.clear_buffer(&graph.previous, 0, None);
    }

    /// Records the linking of one object; `@group(0)` must be the frame, `@group(1)`
    /// the graph's uniform.
    pub(crate) fn record(
        &self,
        pass: &mut wgpu::ComputePass,
        graph: &GraphBuffers,
        bindings: &LinkBindings,
    ) {
        pass.set_pipeline(&self.bases);
        pass.set_bind_group(3, &bindings.bases, &[]);
        pass.dispatch_workgroups(1, 1, 1);
        pass.set_pipeline(&self.elements);
        for (chunk, [edges, lists]) in (0..).zip(&bindings.chunks) {
            pass.set_bind_group(2, edges, &[]);
            pass.set_bind_group(3, lists, &[]);
            graph.dispatch(pass, CHUNK_GROUPS + 3 * chunk);
        }
        pass.set_bind_group(1, &self.rounds[0], &[]);
        pass.set_bind_group(3, &bindings.chains[0], &[]);
        pass.set_pipeline(&self.resolve);
        graph.dispatch(pass, NODE_GROUPS);
        pass.set_pipeline(&self.jump);
        for (round, number) in self.rounds[..bindings.rounds].iter().enumerate() {
            pass.set_bind_group(1, number, &[]);
            pass.set_bind_group(3, &bindings.chains[round % 2], &[]);
            graph.dispatch(pass, NODE_GROUPS);
        }
        pass.set_bind_group(3, &bindings.chains[bindings.rounds % 2], &[]);
        for (pipeline, groups) in &self.chains {
            pass.set_pipeline(pipeline);
            match groups {
                Groups::One => pass.dispatch_workgroups(1, 1, 1),
                Groups::By(at) => graph.dispatch(pass, *at),
            }
        }
    }
}

impl Layouts {
    fn new(device: &wgpu::Device, layout: Layout) -> Self {
        let (uniform, read, write) = (compute_uniform, compute_read, compute_write);
        let make = |label: &str, entries: &[wgpu::BindGroupLayoutEntry]| {
            bind_layout(device, label, entries)
        };
        let mut edges = vec![uniform(0), uniform(1), read(2)];
        if layout == Layout::Indexed {
            edges.push(read(3));
        }
        let elements = [read(0), read(1), read(2), write(3), read(4), write(5)];
        Self {
            graph: make("graph", &[uniform(0)]),
            bases: make("link bases", &[0, 1, 2, 3].map(write)),
            edges: make("link edges", &edges),
            elements: make("link elements", &elements),
            chains: make("chains", &[0, 1, 2, 3, 4, 5, 6, 7].map(write)),
        }
    }
}
