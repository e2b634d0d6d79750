//! The variables of `copy_to_texture`.

use super::reader::Reader;
use super::render_target::TEXTURE;

/// A pass that copies the current picture, or its depth.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct CopyToTexture {
    /// `x` for the texture `<generated>:x`.
    pub(crate) texture: String,
    /// Whether the depth is copied instead of the color.
    pub(crate) is_depth: bool,
}

impl CopyToTexture {
    pub(super) fn read(reader: &mut Reader) -> Self {
        let texture = reader.string(TEXTURE).to_owned();
        Self { texture, is_depth: reader.bool("depth") }
    }
}
