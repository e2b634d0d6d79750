//! The kind of meshes and targets that a renderer is built for.

use crate::gpu::target_formats::TargetFormats;
use crate::mesh::layout::Layout;

/// The stage of the pipeline that detects feature edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum DetectionStage {
    /// Compute shaders, which list the edges to draw.
    #[default]
    Compute,
    /// The vertex shader, as in the paper: every edge is drawn, and those that are no features
    /// lie behind the near plane. Strokes are neither linked nor counted.
    Vertex,
}

/// The kind of meshes and targets that a renderer is built for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RendererOptions {
    /// The layout of all meshes.
    pub layout: Layout,
    /// Meshes in [`Layout::FaceNormals`] are always detected in the vertex shader.
    pub stage: DetectionStage,
    /// The formats of all targets.
    pub formats: TargetFormats,
    /// Whether frames can have transparent surfaces
    /// ([`FrameRequest::glass_depth`](crate::FrameRequest::glass_depth)).
    pub has_glass: bool,
}

impl RendererOptions {
    /// Meshes in the indexed layout, detected in compute shaders.
    #[must_use]
    pub const fn new(formats: TargetFormats) -> Self {
        Self { layout: Layout::Indexed, stage: DetectionStage::Compute, formats, has_glass: false }
    }

    /// The options with unsupported combinations replaced.
    #[must_use]
    pub const fn supported(self) -> Self {
        match self.layout {
            Layout::FaceNormals => Self { stage: DetectionStage::Vertex, ..self },
            _ => self,
        }
    }
}
