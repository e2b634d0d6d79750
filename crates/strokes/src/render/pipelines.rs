//! All pipelines for one kind of meshes and targets, and what styles share.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::sync::Arc;

use edgemesh::index::to_u32;
use edgemesh::line::{ClassTable, LineKind};
use edgemesh_shaders::ShaderError;

use crate::draw::coverage::CoveragePipeline;
use crate::draw::expand::ExpandPipeline;
use crate::draw::fill::{FillKind, FillPipeline};
use crate::draw::stroke::{StrokeVariant, VertexSource, stroke_pipeline, style_group};
use crate::draw::stroke_indices::{IndexBuffer, IndexKey};
use crate::draw::stroke_layouts::StrokeLayouts;
use crate::gpu::device::Gpu;
use crate::graph::link::LinkPipeline;
use crate::graph::path::PathPipeline;
use crate::mesh::layout::Layout;
use crate::render::error::RenderError;
use crate::render::options::{DetectionStage, RendererOptions};
use crate::render::prepared_style::{PreparedStrokes, PreparedStyle, StrokeVertices};
use crate::style::brush::BrushTextures;
use crate::style::drawing_style::{DrawingStyle, MAX_LAYERS, StrokeSet};
use crate::view::detect::DetectPipeline;
use crate::view::frame::frame_layout;

/// All pipelines for one kind of meshes and targets.
#[derive(Debug)]
pub(crate) struct Pipelines {
    pub(crate) options: RendererOptions,
    pub(crate) layouts: StrokeLayouts,
    pub(crate) detect: DetectPipeline,
    pub(crate) fill: FillPipeline,
    /// Built when the first style links strokes.
    pub(crate) graph: Option<GraphPipelines>,
    expand: HashMap<LineKind, Arc<ExpandPipeline>>,
    strokes: HashMap<StrokeVariant, wgpu::RenderPipeline>,
    indices: HashMap<IndexKey, IndexBuffer>,
    brushes: BrushTextures,
}

/// The pipelines of the stroke graph.
#[derive(Debug)]
pub(crate) struct GraphPipelines {
    pub(crate) link: LinkPipeline,
    pub(crate) path: PathPipeline,
    pub(crate) coverage: CoveragePipeline,
}

impl Pipelines {
    /// Builds the pipelines that every style needs.
    pub(crate) fn new(gpu: &Gpu, options: RendererOptions) -> Result<Self, ShaderError> {
        let device = &gpu.device;
        let options = options.supported();
        let frame = frame_layout(device);
        Ok(Self {
            layouts: StrokeLayouts::new(device, &frame, options.layout, &options.formats),
            detect: DetectPipeline::new(device, &frame, options.layout)?,
            fill: FillPipeline::new(device, &frame, &options.formats)?,
            graph: None,
            options,
            expand: HashMap::new(),
            strokes: HashMap::new(),
            indices: HashMap::new(),
            brushes: BrushTextures::new(device),
        })
    }

    pub(crate) fn prepare(
        &mut self,
        gpu: &Gpu,
        style: &DrawingStyle,
    ) -> Result<PreparedStyle, RenderError> {
        if style.silhouette.is_some() && !self.options.formats.has_stencil() {
            return Err(RenderError::NoStencil);
        }
        if style.layers.len() > MAX_LAYERS {
            let layers = style.layers.len();
            return Err(RenderError::TooManyLayers { layers, limit: MAX_LAYERS });
        }
        let device = &gpu.device;
        let classes = style.class_table();
        if style.is_linked() {
            self.build_graph(device)?;
        }
        let mut sets = Vec::new();
        for (index, set) in style.stroke_sets().iter_mut().enumerate() {
            if self.options.layout == Layout::FaceNormals {
                set.style.kind = LineKind::Fin;
            }
            sets.push(self.prepare_strokes(gpu, set, index, &classes)?);
        }
        Ok(PreparedStyle {
            options: self.options,
            classes,
            layer_count: to_u32(style.layers.len()).max(1),
            sets,
            detect_pass: self.detect.pass(device, style),
            fill_pass: self.fill.pass(device, style.fill_color.unwrap_or_default()),
            fill_kind: if style.fill_color.is_some() { FillKind::Whole } else { FillKind::Clear },
            link_pass: self.graph.as_ref().map(|graph| graph.path.pass(device, style)),
        })
    }

    fn prepare_strokes(
        &mut self,
        gpu: &Gpu,
        set: &StrokeSet,
        index: usize,
        classes: &ClassTable,
    ) -> Result<PreparedStrokes, ShaderError> {
        let style = style_group(gpu, &self.layouts, &mut self.brushes, set, index, classes);
        let RendererOptions { stage, layout, has_glass, .. } = self.options;
        let variant = |source| StrokeVariant::new(source, set, has_glass);
        let mut pipeline = |source| self.stroke(gpu, variant(source));
        let kind = set.style.kind;
        let lies_over_surface = set.lies_over_surface();
        let vertices = match (stage, layout) {
            (DetectionStage::Compute, _) => {
                let listed = pipeline(VertexSource::Listed)?;
                let expanded = if lies_over_surface || set.style.is_linked() {
                    None
                } else {
                    let drawn = pipeline(VertexSource::Expanded)?;
                    Some((self.expansion(gpu, kind)?, drawn))
                };
                StrokeVertices::Lists { expanded, listed }
            }
            (DetectionStage::Vertex, Layout::Indexed) => {
                StrokeVertices::All(pipeline(VertexSource::All)?)
            }
            (DetectionStage::Vertex, _) => {
                StrokeVertices::Attributes(pipeline(VertexSource::Attributes)?)
            }
        };
        Ok(PreparedStrokes {
            layer: set.layer,
            kind,
            visibility: set.visibility,
            lies_over_surface,
            reads_fill: variant(VertexSource::Listed).reads_fill(),
            is_linked: set.style.is_linked() && stage == DetectionStage::Compute,
            color: set.style.color,
            reach_px: set.style.reach_px(),
            is_textured: set.style.brush.is_some(),
            style,
            vertices,
        })
    }

    /// Builds the pipelines of the stroke graph once, if compute shaders detect.
    pub(crate) fn build_graph(&mut self, device: &wgpu::Device) -> Result<(), ShaderError> {
        let RendererOptions { layout, stage, formats, has_glass } = &self.options;
        if *stage == DetectionStage::Compute && self.graph.is_none() {
            self.graph = Some(GraphPipelines {
                link: LinkPipeline::new(device, &self.layouts.frame, *layout)?,
                path: PathPipeline::new(device, &self.layouts.frame_fill, formats)?,
                coverage: CoveragePipeline::new(device, &self.layouts, formats, *has_glass)?,
            });
        }
        Ok(())
    }

    fn stroke(
        &mut self,
        gpu: &Gpu,
        variant: StrokeVariant,
    ) -> Result<wgpu::RenderPipeline, ShaderError> {
        Ok(match self.strokes.entry(variant) {
            Entry::Occupied(known) => known.get().clone(),
            Entry::Vacant(new) => {
                let RendererOptions { layout, formats, .. } = &self.options;
                let made = stroke_pipeline(&gpu.device, &self.layouts, *layout, formats, variant)?;
                new.insert(made).clone()
            }
        })
    }

    fn expansion(&mut self, gpu: &Gpu, kind: LineKind) -> Result<Arc<ExpandPipeline>, ShaderError> {
        Ok(match self.expand.entry(kind) {
            Entry::Occupied(known) => known.get().clone(),
            Entry::Vacant(new) => {
                let layout = self.options.layout;
                let made = ExpandPipeline::new(&gpu.device, &self.layouts, layout, kind)?;
                new.insert(Arc::new(made)).clone()
            }
        })
    }

    /// Makes an index buffer for `count` edges or more.
    pub(crate) fn grow_indices(&mut self, device: &wgpu::Device, key: IndexKey, count: u32) {
        if self.indices.get(&key).is_none_or(|known| known.count < count) {
            self.indices.insert(key, IndexBuffer::new(device, key, count));
        }
    }

    pub(crate) fn set_indices(&self, pass: &mut wgpu::RenderPass, key: IndexKey) {
        if let Some(indices) = self.indices.get(&key) {
            pass.set_index_buffer(indices.buffer.slice(..), wgpu::IndexFormat::Uint32);
        }
    }
}
