//! A drawing style with its pipelines, uniforms and textures.

use std::sync::Arc;

use edgemesh::line::{ClassTable, LineClass, LineKind};

use crate::draw::expand::ExpandPipeline;
use crate::draw::fill::FillKind;
use crate::draw::stroke_indices::IndexKey;
use crate::graph::buffers::LinkedSet;
use crate::render::options::RendererOptions;
use crate::style::drawing_style::{MAX_STROKE_SETS, Visibility};

/// A drawing style with its pipelines, uniforms and textures. Instances can share one.
#[derive(Debug)]
pub struct PreparedStyle {
    /// Those of the renderer that prepared the style.
    pub(crate) options: RendererOptions,
    pub(crate) classes: ClassTable,
    pub(crate) layer_count: u32,
    /// In the order of drawing.
    pub(crate) sets: Vec<PreparedStrokes>,
    /// `@group(1)` of detection.
    pub(crate) detect_pass: wgpu::BindGroup,
    /// `@group(1)` of the fill.
    pub(crate) fill_pass: wgpu::BindGroup,
    pub(crate) fill_kind: FillKind,
    /// `@group(1)` of paths, if any strokes are linked.
    pub(crate) link_pass: Option<wgpu::BindGroup>,
}

/// The strokes of one set, ready to be drawn.
#[derive(Debug)]
pub(crate) struct PreparedStrokes {
    pub(crate) layer: u32,
    pub(crate) kind: LineKind,
    pub(crate) visibility: Visibility,
    pub(crate) lies_over_surface: bool,
    /// Whether its fragments read the fill, or transparent surfaces.
    pub(crate) reads_fill: bool,
    pub(crate) is_linked: bool,
    /// Premultiplied.
    pub(crate) color: [f32; 4],
    /// The most pixels between ink and its line; `None` if the width is in units of the world.
    pub(crate) reach_px: Option<f32>,
    pub(crate) is_textured: bool,
    /// `@group(1)` of strokes.
    pub(crate) style: wgpu::BindGroup,
    pub(crate) vertices: StrokeVertices,
}

/// The source of a stroke set's vertices, with the pipelines that draw them.
#[derive(Debug)]
pub(crate) enum StrokeVertices {
    Lists {
        /// `None` if no stroke is expanded.
        expanded: Option<(Arc<ExpandPipeline>, wgpu::RenderPipeline)>,
        listed: wgpu::RenderPipeline,
    },
    All(wgpu::RenderPipeline),
    Attributes(wgpu::RenderPipeline),
}

/// The sizes that the lists of a view depend on: styles of the same shape share lists.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct ListShape {
    pub(crate) layer_count: u32,
    /// The kind of line of each stroke set whose strokes are expanded.
    pub(crate) expanded: Vec<Option<LineKind>>,
    /// The most linked stroke sets of one layer; 0 if no strokes are linked.
    pub(crate) linked_sets_per_layer: u32,
}

impl PreparedStyle {
    /// Whether any strokes are linked. Meshes then need [`MeshOptions::links`].
    ///
    /// [`MeshOptions::links`]: crate::MeshOptions::links
    #[must_use]
    pub fn is_linked(&self) -> bool {
        self.sets.iter().any(|set| set.is_linked)
    }

    pub(crate) const fn draws_contours(&self) -> bool {
        self.classes.drawn & LineClass::Contour.bit() != 0
    }

    pub(crate) fn has_silhouette(&self) -> bool {
        self.sets.iter().any(|set| set.visibility == Visibility::Silhouette)
    }

    pub(crate) fn list_shape(&self) -> ListShape {
        let linked_of =
            |layer| self.sets.iter().filter(move |set| set.is_linked && set.layer == layer);
        let most = (0..self.layer_count).map(|layer| linked_of(layer).count()).max();
        ListShape {
            layer_count: self.layer_count,
            expanded: self
                .sets
                .iter()
                .map(|set| (!set.lies_over_surface && !set.is_linked).then_some(set.kind))
                .collect(),
            linked_sets_per_layer: edgemesh::index::to_u32(most.unwrap_or(0)),
        }
    }

    pub(crate) fn linked_sets(&self) -> [LinkedSet; MAX_STROKE_SETS] {
        let mut linked = [LinkedSet { layer: 0, is_linked: 0, padding: [0; 2] }; MAX_STROKE_SETS];
        for (linked, set) in linked.iter_mut().zip(&self.sets) {
            (linked.layer, linked.is_linked) = (set.layer, u32::from(set.is_linked));
        }
        linked
    }
}

impl PreparedStrokes {
    /// The index buffers that the set is drawn with.
    pub(crate) fn index_keys(&self) -> Vec<IndexKey> {
        match &self.vertices {
            StrokeVertices::Lists { expanded: Some(_), .. } => vec![IndexKey::Expanded(self.kind)],
            StrokeVertices::Lists { expanded: None, .. } | StrokeVertices::All(_) => Vec::new(),
            StrokeVertices::Attributes(_) => {
                vec![IndexKey::Lines, IndexKey::Quads, IndexKey::Ends]
            }
        }
    }
}
