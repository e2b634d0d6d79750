//! The stroke graph: the edges that a view draws, linked into chains on the GPU in
//! every frame, and the strokes along them.
//!
//! The paper draws every edge by itself, and says what that costs: gaps between the
//! caps of creases (Figure 5), textures that break at every edge (Figure 8). Its
//! vertex programs saw nothing but their own edge; here compute shaders link them.
//!
//! ```text
//!   live edges --link_elements--> nodes, each with its successor
//!        nodes --link_chains----> chains: elements in order, with arc lengths
//!   chains --path_joints---> corners, and how many points each element gives
//!          --path_points---> points, 4 px apart, visible or not
//!          --path_strokes--> strokes: from where to where
//!          --path_ribbons--> ribbons: segments with width, brush and joins
//!   ribbons --coverage-----> each pixel once, laid over the picture
//! ```

pub mod buffers;
pub mod coverage;
pub(crate) mod link;
pub mod link_table;
pub mod path;
pub mod path_style;

use crate::graph::coverage::CoveragePipeline;
use crate::graph::link::LinkPipeline;
use crate::graph::path::PathPipeline;
use crate::mesh_buffers::Layout;
use crate::shader::ShaderError;
use crate::stroke_layouts::StrokeLayouts;
use crate::targets::TargetFormats;

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
