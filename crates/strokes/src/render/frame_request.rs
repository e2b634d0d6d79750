//! The parts of a frame: instances, styles, view and targets.

use std::sync::Arc;

use crate::draw::targets::Targets;
use crate::gpu::timer::TimedPasses;
use crate::mesh::instance::MeshInstance;
use crate::render::prepared_style::PreparedStyle;
use crate::view::view_state::ViewState;

/// The passes of a frame, in the order of [`GpuTimer`](crate::GpuTimer).
pub const PASS_NAMES: [&str; 7] =
    ["detect", "link", "expand", "fill", "paths", "coverage", "strokes"];

/// How surfaces are drawn under the strokes.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Fill {
    /// The picture is cleared to a premultiplied color (RGBA, 0 to 1), and objects are filled.
    Clear([f64; 4]),
    /// The picture stays, the depth is cleared, and objects are filled.
    Depth,
    /// Picture and depth stay, with surfaces that were drawn with
    /// [`push_away`](crate::push_away); the stencil is written if a style needs it.
    Done,
}

/// A frame to be encoded.
#[derive(Debug, Clone, Copy)]
pub struct FrameRequest<'a> {
    /// The textures to draw into.
    pub targets: &'a Targets,
    /// The meshes to draw.
    pub instances: &'a [MeshInstance],
    /// The style of each instance.
    pub styles: &'a [Arc<PreparedStyle>],
    /// The eye, set for these instances by [`ViewState::set`].
    pub view: &'a ViewState,
    /// How surfaces are drawn under the strokes.
    pub fill: Fill,
    /// The depth of the nearest transparent surfaces, which are in neither `fill` nor the depth of
    /// `targets`, if there are any: strokes behind them are fainter. Of the size and sample count
    /// of the targets, drawn with [`push_away`](crate::push_away).
    pub glass_depth: Option<&'a wgpu::TextureView>,
    /// The whole picture at a smaller size, if a tile is drawn: its depth decides where linked
    /// strokes are visible, so that they begin and end alike in all tiles.
    pub overview: Option<&'a Targets>,
    /// Whether samples are averaged to the picture at the end.
    pub resolves: bool,
    /// As many passes of a timer as there are [`PASS_NAMES`].
    pub timer: Option<TimedPasses<'a>>,
}
