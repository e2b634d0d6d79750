//! A scene as one eye sees it, for programs that draw only strokes.

use std::sync::Arc;

use crate::gpu::device::Gpu;
use crate::mesh::instance::MeshInstance;
use crate::render::drawing::Drawing;
use crate::render::prepared_style::PreparedStyle;
use crate::view::view_state::ViewState;

/// A scene as one eye sees it: instances in their styles, with their buffers.
#[derive(Debug)]
pub struct SceneView {
    /// The meshes to draw.
    pub instances: Vec<MeshInstance>,
    /// The style of each instance.
    pub styles: Vec<Arc<PreparedStyle>>,
    /// The uniforms of the eye.
    pub view: ViewState,
    /// The lists and stroke graphs of the last frame.
    pub drawing: Drawing,
}

impl SceneView {
    /// A scene of `instances`, each with its style.
    #[must_use]
    pub fn new(gpu: &Gpu, instances: Vec<MeshInstance>, styles: Vec<Arc<PreparedStyle>>) -> Self {
        Self { instances, styles, view: ViewState::new(&gpu.device), drawing: Drawing::new() }
    }
}
