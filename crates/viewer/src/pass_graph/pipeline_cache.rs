//! Pipelines that were built before: when a value or the order of passes changes, or a
//! technique comes back, none is built again.

use edgemesh::command::Failure;
use strokes::gpu::Gpu;

use super::pipeline::{Geometry, PassPipeline, PipelineTarget, Programs};
use crate::technique::plan::Read;

/// So many pipelines are kept; the one that was not used for the longest time goes first.
const MOST_KEPT: usize = 256;

/// The pipelines of passes, the one that was used last behind all others.
#[derive(Debug, Default)]
pub(crate) struct PipelineCache {
    known: Vec<(Key, PassPipeline)>,
}

/// Everything that a pipeline depends on.
#[derive(Debug, PartialEq)]
struct Key {
    /// Text and function of both programs.
    programs: [(String, String); 2],
    reads: Vec<Read>,
    geometry: Geometry,
    target: PipelineTarget,
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
    ) -> Result<PassPipeline, Failure> {
        let key = Key {
            programs: [programs.vertex, programs.fragment]
                .map(|program| (program.source.text.clone(), program.function.clone())),
            reads: programs.reads.to_vec(),
            geometry,
            target: target.clone(),
        };
        let pipeline = match self.known.iter().position(|(known, _)| *known == key) {
            Some(at) => self.known.remove(at).1,
            None => PassPipeline::new(gpu, frame, surface, programs, geometry, target)?,
        };
        if self.known.len() == MOST_KEPT {
            self.known.remove(0);
        }
        self.known.push((key, pipeline.clone()));
        Ok(pipeline)
    }
}
