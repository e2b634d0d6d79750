//! The shared input of all passes: the adapter, the graph's input, and the pipelines.

use std::cell::RefCell;

use strokes::{Gpu, TargetFormats};

use super::pipeline::{DepthUse, Geometry, GraphLayouts, PassPipeline, PipelineTarget, Programs};
use super::pipeline_cache::PipelineCache;
use super::textures::wgpu_format;
use super::{GraphInput, blend};
use crate::error::Error;
use crate::technique::plan::{PassPlan, Target};

/// Builds steps.
pub(super) struct Builder<'a> {
    pub(super) gpu: &'a Gpu,
    pub(super) input: &'a GraphInput<'a>,
    pub(super) formats: TargetFormats,
    /// The layout of `@group(0)`.
    pub(super) frame: &'a wgpu::BindGroupLayout,
    pub(super) pipelines: RefCell<PipelineCache>,
}

impl Builder<'_> {
    /// A pipeline, built if it is not in the cache.
    pub(super) fn pipeline(
        &self,
        layouts: GraphLayouts,
        programs: Programs,
        geometry: Geometry,
        target: &PipelineTarget,
    ) -> Result<PassPipeline, Error> {
        let mut pipelines = self.pipelines.borrow_mut();
        pipelines.pipeline(self.gpu, layouts, programs, geometry, target)
    }

    /// Formats and blending of the target of a pass.
    pub(super) fn target(&self, plan: &PassPlan) -> PipelineTarget {
        let blend = blend::blend_state(plan.core.blend());
        let clips = self.input.options.clips;
        let format = |&at: &usize| wgpu_format(self.input.plan.textures[at].format);
        match &plan.target {
            Target::Framebuffer => PipelineTarget::framebuffer(&self.formats, blend, clips),
            Target::Textures { colors, depth } => PipelineTarget {
                colors: colors.iter().map(format).collect(),
                depth: depth.as_ref().map(format),
                samples: 1,
                blend,
                is_pushed: false,
                writes_depth: false,
                clips,
                depth_use: DepthUse::Nearest,
            },
        }
    }
}
