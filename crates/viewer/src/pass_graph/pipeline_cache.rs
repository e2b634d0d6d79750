//! Pipelines that were built before: when a value or the order of passes changes, or a
//! technique comes back, none is built again.

use std::sync::Arc;

use edgemesh_shaders::ShaderSource;
use strokes::gpu::device::Gpu;
use strokes::gpu::recent::Recent;

use super::pipeline::{Geometry, PassPipeline, PipelineTarget, Programs};
use crate::error::Error;
use crate::technique::plan::Read;
use crate::technique::program::Program;

/// So many pipelines are kept: more than all techniques that ship have together.
const MOST_KEPT: usize = 256;

/// The pipelines of passes.
#[derive(Debug)]
pub(crate) struct PipelineCache {
    known: Recent<Key, PassPipeline>,
}

/// Everything that a pipeline depends on.
#[derive(Debug)]
struct Key {
    vertex: ProgramKey,
    fragment: ProgramKey,
    reads: Vec<Read>,
    geometry: Geometry,
    target: PipelineTarget,
}

/// A program's text and its function.
#[derive(Debug)]
struct ProgramKey {
    source: Arc<ShaderSource>,
    function: String,
}

impl ProgramKey {
    fn of(program: &Program) -> Self {
        Self { source: program.source.clone(), function: program.function.clone() }
    }

    fn is_of(&self, program: &Program) -> bool {
        self.function == program.function && self.source.text == program.source.text
    }
}

impl Default for PipelineCache {
    fn default() -> Self {
        Self { known: Recent::new(MOST_KEPT) }
    }
}

impl PipelineCache {
    /// The pipeline of `programs`, built where it is not known; layouts as in
    /// [`PassPipeline::new`].
    pub(crate) fn pipeline(
        &mut self,
        gpu: &Gpu,
        (frame, surface): (&wgpu::BindGroupLayout, &wgpu::BindGroupLayout),
        programs: Programs,
        geometry: Geometry,
        target: &PipelineTarget,
    ) -> Result<PassPipeline, Error> {
        let is_it = |key: &Key| {
            (key.geometry, &key.target) == (geometry, target)
                && key.reads == programs.reads
                && key.vertex.is_of(programs.vertex)
                && key.fragment.is_of(programs.fragment)
        };
        self.known.get(is_it, || {
            let pipeline = PassPipeline::new(gpu, frame, surface, programs, geometry, target)?;
            let key = Key {
                vertex: ProgramKey::of(programs.vertex),
                fragment: ProgramKey::of(programs.fragment),
                reads: programs.reads.to_vec(),
                geometry,
                target: target.clone(),
            };
            Ok((key, pipeline))
        })
    }
}
