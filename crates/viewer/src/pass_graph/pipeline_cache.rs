//! Pipelines built before, so that changed values, another order of passes, or a technique
//! used before build none again.

use std::sync::Arc;

use edgemesh_shaders::ShaderSource;
use strokes::{Gpu, Recent};

use super::pipeline::{Geometry, GraphLayouts, PassPipeline, PipelineTarget, Programs};
use crate::error::Error;
use crate::technique::plan::TextureRead;
use crate::technique::program::Program;

/// The number of pipelines in the cache: more than all built-in techniques have together.
const CAPACITY: usize = 256;

/// The pipelines of passes.
#[derive(Debug)]
pub(crate) struct PipelineCache {
    known: Recent<Key, PassPipeline>,
}

/// What a pipeline depends on.
#[derive(Debug)]
struct Key {
    vertex: ProgramKey,
    fragment: ProgramKey,
    reads: Vec<TextureRead>,
    geometry: Geometry,
    target: PipelineTarget,
}

/// The text of a program and its function.
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
        Self { known: Recent::new(CAPACITY) }
    }
}

impl PipelineCache {
    /// The pipeline of `programs`, built if it is not known.
    pub(crate) fn pipeline(
        &mut self,
        gpu: &Gpu,
        layouts: GraphLayouts,
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
            let pipeline = PassPipeline::new(gpu, layouts, programs, geometry, target)?;
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
