//! The variables `render_target`, `render_target_width` and so on.

use super::reader::Reader;
use crate::technique::mistake::Mistake;
use crate::technique::texture_format::{TextureFormat, TextureSize};

/// The variable with the name of the target.
pub(in crate::technique) const TARGET: &str = "render_target";
/// The variable with the only texture of a component, which it reads or writes.
pub(in crate::technique) const TEXTURE: &str = "texture";
const WIDTH: &str = "render_target_width";
const HEIGHT: &str = "render_target_height";
/// The variable with the scale of the target.
pub(in crate::technique) const SCALE: &str = "render_target_scale";
/// The variable with the formats of the target.
pub(in crate::technique) const FORMAT: &str = "render_target_format";

/// Where a pass draws.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RenderTarget {
    /// `x` for the textures `<generated>:x_color` and so on; none for the picture.
    pub(crate) name: Option<String>,
    /// The size of the textures.
    pub(crate) size: TextureSize,
    /// The formats of the outputs, at least one; the last one is also that of all further
    /// outputs.
    pub(crate) formats: Vec<TextureFormat>,
}

impl RenderTarget {
    pub(super) fn read(reader: &mut Reader) -> Self {
        let name = reader.optional_string(TARGET);
        let size = read_size(reader);
        Self { name, size, formats: read_formats(reader) }
    }

    /// The format of an output.
    #[must_use]
    pub(crate) fn format(&self, output: usize) -> TextureFormat {
        let format = self.formats.get(output).or(self.formats.last());
        format.copied().unwrap_or(TextureFormat::PICTURE)
    }
}

/// The size of a target.
pub(super) fn read_size(reader: &mut Reader) -> TextureSize {
    TextureSize { sides: [reader.int(WIDTH), reader.int(HEIGHT)], scale: reader.number(SCALE) }
}

/// The formats of a target, separated by commas.
pub(super) fn read_formats(reader: &mut Reader) -> Vec<TextureFormat> {
    let words = reader.string(FORMAT).split(',').map(str::trim);
    let mut format_of = |word| {
        TextureFormat::of_word(word).unwrap_or_else(|| {
            let mistake = Mistake::error(reader.place(FORMAT), format!("unknown format '{word}'"));
            reader.add(mistake.names(word, TextureFormat::OUTPUTS.map(TextureFormat::word)));
            TextureFormat::PICTURE
        })
    };
    words.map(&mut format_of).collect()
}
