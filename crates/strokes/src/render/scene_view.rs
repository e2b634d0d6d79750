//! A scene as one eye sees it, for programs that draw nothing but strokes.

use std::sync::Arc;

use crate::gpu::device::Gpu;
use crate::mesh::instance::MeshInstance;
use crate::render::drawing::Drawing;
use crate::render::prepared_style::PreparedStyle;
use crate::view::view_state::ViewState;

/// A scene as one eye sees it: instances in their styles, and all that the GPU keeps for them.
#[derive(Debug)]
pub struct SceneView {
    /// What is drawn.
    pub instances: Vec<MeshInstance>,
    /// The style of each instance.
    pub styles: Vec<Arc<PreparedStyle>>,
    /// The eye.
    pub view: ViewState,
    /// What the last view made of the instances.
    pub drawing: Drawing,
}

impl SceneView {
    /// `instances`, each in its style.
    #[must_use]
    pub fn new(gpu: &Gpu, instances: Vec<MeshInstance>, styles: Vec<Arc<PreparedStyle>>) -> Self {
        Self { instances, styles, view: ViewState::new(&gpu.device), drawing: Drawing::new() }
    }
}
