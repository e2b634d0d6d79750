//! Why a scene is not drawn.

use edgemesh_shaders::ShaderError;
use thiserror::Error;

use crate::gpu::target_formats::TargetFormats;
use crate::mesh::layout::Layout;

/// Why a style is not prepared, or a scene not drawn.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum RenderError {
    /// A shader of this crate is wrong: an internal error.
    #[error(transparent)]
    Shader(#[from] ShaderError),
    /// A style has a silhouette, and the renderer's targets have no stencil.
    #[error(
        "a style has a silhouette, which needs a stencil: make the targets with \
         TargetFormats::with_stencil"
    )]
    NoStencil,
    /// A style has more layers than a list of edges can.
    #[error("a style has {layers} layers; it can have {limit}, one per line class")]
    TooManyLayers {
        /// Number of layers.
        layers: usize,
        /// The most that are drawn.
        limit: usize,
    },
    /// A style was prepared by a renderer with other options.
    #[error("a style was prepared for other meshes or targets: call Renderer::prepare")]
    OtherRenderer,
    /// Targets have other formats than the renderer's.
    #[error("the targets are of {targets:?}, the renderer draws into {renderer:?}")]
    Formats {
        /// The formats of the targets.
        targets: TargetFormats,
        /// The renderer's formats.
        renderer: TargetFormats,
    },
    /// A timer has too few passes for a frame.
    #[error("the timer has {passes} passes left; a frame has {needed} (PASS_NAMES)")]
    ShortTimer {
        /// Passes of the timer.
        passes: u32,
        /// Passes of a frame.
        needed: u32,
    },
    /// A mesh was uploaded in another layout than the renderer's.
    #[error("a mesh has the layout {mesh:?}, the renderer draws the layout {renderer:?}")]
    Layout {
        /// The mesh's layout.
        mesh: Layout,
        /// The renderer's layout.
        renderer: Layout,
    },
    /// A style links strokes, and its mesh was uploaded without links.
    #[error("a style links strokes, and its mesh has no links: upload it with MeshOptions::links")]
    NoLinks,
    /// The number of styles is not that of the instances.
    #[error("there are {styles} styles for {instances} instances: each instance needs one")]
    StyleCount {
        /// Number of styles.
        styles: usize,
        /// Number of instances.
        instances: usize,
    },
    /// The view state was set for another number of instances.
    #[error("the view state has {view} instances, the scene {instances}: call ViewState::set")]
    ViewState {
        /// Instances in the view state.
        view: usize,
        /// Instances in the scene.
        instances: usize,
    },
}
