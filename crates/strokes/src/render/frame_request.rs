//! What a frame is drawn from, and what it is drawn over.

use std::sync::Arc;

use crate::draw::targets::Targets;
use crate::gpu::timer::TimedPasses;
use crate::mesh::instance::MeshInstance;
use crate::render::prepared_style::PreparedStyle;
use crate::view::view_state::ViewState;

/// The passes of a frame, in order, as [`GpuTimer`](crate::gpu::timer::GpuTimer) numbers them.
pub const PASS_NAMES: [&str; 7] =
    ["detect", "link", "expand", "fill", "paths", "coverage", "strokes"];

/// What is done about the surface before strokes are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fill {
    /// The picture is cleared to a premultiplied color, and objects are filled.
    Clear([f64; 4]),
    /// The picture stays; its depth is made anew.
    Depth,
    /// Picture and depth are there, drawn with [`crate::draw::fill::push_away`]; the stencil
    /// is written if it is needed.
    Done,
}

/// A frame to be encoded.
#[derive(Debug, Clone, Copy)]
pub struct FrameRequest<'a> {
    /// What is drawn into.
    pub targets: &'a Targets,
    /// What is drawn.
    pub instances: &'a [MeshInstance],
    /// The style of each instance.
    pub styles: &'a [Arc<PreparedStyle>],
    /// The eye, set for these instances by [`ViewState::set`].
    pub view: &'a ViewState,
    /// What is under the strokes.
    pub fill: Fill,
    /// The whole picture, smaller, if a tile of it is drawn: its depth decides where linked
    /// strokes are visible, so that they begin and end alike in all tiles.
    pub overview: Option<&'a Targets>,
    /// Whether the samples are averaged to the picture at the end.
    pub resolves: bool,
    /// [`PASS_NAMES`] passes of a timer.
    pub timer: Option<TimedPasses<'a>>,
}
