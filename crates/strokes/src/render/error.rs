//! Why a scene cannot be drawn.

use edgemesh_shaders::ShaderError;
use thiserror::Error;

use crate::mesh::layout::Layout;

/// Styles, meshes and targets do not fit together.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum RenderError {
    /// A shader that ships is wrong: a fault of this crate.
    #[error(transparent)]
    Shader(#[from] ShaderError),
    /// A style has a silhouette and the renderer's targets have no stencil.
    #[error(
        "a style has a silhouette, which needs a stencil: make the targets with \
         TargetFormats::with_stencil"
    )]
    NoStencil,
    /// A mesh was uploaded in another layout than the renderer's.
    #[error("a mesh is in the layout {mesh:?}, the renderer draws the layout {renderer:?}")]
    Layout {
        /// The mesh's layout.
        mesh: Layout,
        /// The renderer's layout.
        renderer: Layout,
    },
    /// A style links strokes and its mesh was uploaded without links.
    #[error("a style links strokes, and its mesh was uploaded without links (MeshOptions::links)")]
    NoLinks,
    /// There is not one style per instance.
    #[error("{styles} styles for {instances} instances: each instance needs one")]
    StyleCount {
        /// Number of styles.
        styles: usize,
        /// Number of instances.
        instances: usize,
    },
    /// The view state was set for another number of instances.
    #[error("the view state is of {view} instances, the scene of {instances}: call ViewState::set")]
    ViewState {
        /// Instances in the view state.
        view: usize,
        /// Instances in the scene.
        instances: usize,
    },
}
