//! All pipelines of the stroke graph, built when the first style links strokes.

use edgemesh_shaders::ShaderError;

use crate::draw::coverage::CoveragePipeline;
use crate::draw::stroke_layouts::StrokeLayouts;
use crate::gpu::target_formats::TargetFormats;
use crate::graph::link::LinkPipeline;
use crate::graph::path::PathPipeline;
use crate::mesh::layout::Layout;

/// All pipelines of the stroke graph.
#[derive(Debug)]
pub(crate) struct GraphPipelines {
    pub(crate) link: LinkPipeline,
    pub(crate) path: PathPipeline,
    pub(crate) coverage: CoveragePipeline,
}

impl GraphPipelines {
    pub(crate) fn new(
        device: &wgpu::Device,
        layouts: &StrokeLayouts,
        layout: Layout,
        formats: &TargetFormats,
    ) -> Result<Self, ShaderError> {
        Ok(Self {
            link: LinkPipeline::new(device, &layouts.frame, layout)?,
            path: PathPipeline::new(device, &layouts.frame_fill, formats)?,
            coverage: CoveragePipeline::new(device, layouts, formats)?,
        })
    }
}
