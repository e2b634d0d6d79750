//! The variables of `simple_render`.

use super::blend::Blend;
use super::programs::{self, ProgramNames};
use super::reader::Reader;
use super::render_target::RenderTarget;

/// A pass that draws the surfaces of the scene.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SimpleRender {
    /// Where it draws.
    pub(crate) target: RenderTarget,
    /// Whether the target is cleared first.
    pub(crate) is_cleared: bool,
    /// The color of the background: red, green, blue, alpha, 0 to 1, not premultiplied.
    pub(crate) clear_color: [f32; 4],
    /// Whether the colors of vertices are drawn.
    pub(crate) has_vertex_colors: bool,
    /// Its programs.
    pub(crate) programs: ProgramNames,
    /// How it blends with the target.
    pub(crate) blend: Blend,
}

impl SimpleRender {
    pub(super) fn read(reader: &mut Reader) -> Self {
        Self {
            target: RenderTarget::read(reader),
            is_cleared: reader.bool("clear"),
            clear_color: reader.rgba("clear_color"),
            has_vertex_colors: reader.bool("vertex_colors"),
            programs: ProgramNames {
                vertex: reader.optional_string(programs::VERTEX),
                fragment: reader.optional_string(programs::FRAGMENT),
                background: reader.optional_string(programs::BACKGROUND),
            },
            blend: reader.word(Blend::VARIABLE),
        }
    }
}
