//! Detection: one facing bit a face, then the live edges in order.
//!
//! Four small dispatches: `detect_faces` packs 32 facing bits an invocation;
//! `count_runs`, `scan_runs` and `write_runs` list the edges to draw without any
//! race, so that the same view always gives the same list.
//!
//! Rejected: the paper's own way, sending every edge through the vertex shader
//! and moving what is no feature behind the near plane; it runs the whole vertex
//! program for edges of which 95 in 100 are thrown away. Appending with one
//! atomic counter, which is as fast but gives another order every time.

use wgpu::ShaderStages;

use crate::frame::{storage_entry, uniform_entry};
use crate::mesh_buffers::{MeshBuffers, Tally};
use crate::shader::{ShaderError, ShaderSource};

/// Invocations a workgroup, as in the shaders.
const WORKGROUP: u32 = 64;

/// Faces an invocation of `detect_faces`.
const FACES_PER_WORD: u32 = 32;

/// The four compute pipelines.
#[derive(Debug)]
pub struct DetectPipeline {
    faces_layout: wgpu::BindGroupLayout,
    edges_layout: wgpu::BindGroupLayout,
    detect_faces: wgpu::ComputePipeline,
    count_runs: wgpu::ComputePipeline,
    scan_runs: wgpu::ComputePipeline,
    write_runs: wgpu::ComputePipeline,
}

/// What detection needs of one mesh.
#[derive(Debug)]
pub struct DetectDraw {
    faces: wgpu::BindGroup,
    edges: wgpu::BindGroup,
    face_groups: u32,
    run_groups: u32,
}

impl DetectPipeline {
    /// Builds the pipelines.
    ///
    /// # Errors
    /// Where a shader cannot be put together.
    pub fn new(
        device: &wgpu::Device,
        frame_layout: &wgpu::BindGroupLayout,
    ) -> Result<Self, ShaderError> {
        let compute = ShaderStages::COMPUTE;
        let layout = |label: &str, entries: &[wgpu::BindGroupLayoutEntry]| {
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some(label),
                entries,
            })
        };
        let faces_layout = layout(
            "detect faces",
            &[
                uniform_entry(0, compute),
                storage_entry(1, compute, true),
                storage_entry(2, compute, false),
            ],
        );
        let edges_layout = layout(
            "detect edges",
            &[
                uniform_entry(0, compute),
                storage_entry(1, compute, true),
                storage_entry(2, compute, true),
                storage_entry(3, compute, false),
                storage_entry(4, compute, false),
                storage_entry(5, compute, false),
            ],
        );
        let faces = ShaderSource::embedded("detect_faces.wgsl")?.module(device, "detect faces");
        let edges = ShaderSource::embedded("detect_edges.wgsl")?.module(device, "detect edges");
        let pipeline = |module: &wgpu::ShaderModule, layout, entry| {
            compute_pipeline(device, frame_layout, layout, module, entry)
        };
        Ok(Self {
            detect_faces: pipeline(&faces, &faces_layout, "detect_faces"),
            count_runs: pipeline(&edges, &edges_layout, "count_runs"),
            scan_runs: pipeline(&edges, &edges_layout, "scan_runs"),
            write_runs: pipeline(&edges, &edges_layout, "write_runs"),
            faces_layout,
            edges_layout,
        })
    }

    /// Prepares one mesh.
    #[must_use]
    pub fn draw(&self, device: &wgpu::Device, mesh: &MeshBuffers) -> DetectDraw {
        let faces = [&mesh.uniform, &mesh.planes, &mesh.facing];
        let edges =
            [&mesh.uniform, &mesh.records, &mesh.facing, &mesh.runs, &mesh.live, &mesh.tally];
        DetectDraw {
            faces: bind_buffers(device, "detect faces", &self.faces_layout, &faces),
            edges: bind_buffers(device, "detect edges", &self.edges_layout, &edges),
            face_groups: mesh.size.face_count.div_ceil(FACES_PER_WORD * WORKGROUP),
            run_groups: mesh.size.run_count.div_ceil(WORKGROUP),
        }
    }

    /// Forgets the last view's counts; before [`Self::record`], outside of a pass.
    pub fn clear(encoder: &mut wgpu::CommandEncoder, mesh: &MeshBuffers) {
        encoder.clear_buffer(&mesh.tally, 0, Some(size_of::<Tally>() as u64));
    }

    /// Records the detection of one mesh; `@group(0)` must be the frame.
    pub fn record(&self, pass: &mut wgpu::ComputePass, draw: &DetectDraw) {
        pass.set_bind_group(2, &draw.faces, &[]);
        pass.set_pipeline(&self.detect_faces);
        pass.dispatch_workgroups(draw.face_groups, 1, 1);
        pass.set_bind_group(2, &draw.edges, &[]);
        for (pipeline, groups) in [
            (&self.count_runs, draw.run_groups),
            (&self.scan_runs, 1),
            (&self.write_runs, draw.run_groups),
        ] {
            pass.set_pipeline(pipeline);
            pass.dispatch_workgroups(groups, 1, 1);
        }
    }
}

fn compute_pipeline(
    device: &wgpu::Device,
    frame_layout: &wgpu::BindGroupLayout,
    layout: &wgpu::BindGroupLayout,
    module: &wgpu::ShaderModule,
    entry: &str,
) -> wgpu::ComputePipeline {
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(entry),
        bind_group_layouts: &[Some(frame_layout), None, Some(layout)],
        immediate_size: 0,
    });
    device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(entry),
        layout: Some(&layout),
        module,
        entry_point: Some(entry),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    })
}

/// Binds whole buffers in order.
pub(crate) fn bind_buffers(
    device: &wgpu::Device,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    buffers: &[&wgpu::Buffer],
) -> wgpu::BindGroup {
    let entries: Vec<wgpu::BindGroupEntry> = (0..)
        .zip(buffers)
        .map(|(binding, buffer)| wgpu::BindGroupEntry {
            binding,
            resource: buffer.as_entire_binding(),
        })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(label),
        layout,
        entries: &entries,
    })
}
