//! The variables of the components that run a program over a whole target:
//! `process_texture`, `generate_texture`, `ping_pong` and `composite`.

use super::blend::Blend;
use super::programs::ProgramNames;
use super::reader::Reader;
use super::render_target::{self, RenderTarget};
use crate::technique::texture_format::{TextureFormat, TextureSize};

/// A pass that runs a program over textures.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ProcessTexture {
    /// Where it draws.
    pub(crate) target: RenderTarget,
    /// Its programs.
    pub(crate) programs: ProgramNames,
    /// How it blends with the target.
    pub(crate) blend: Blend,
}

impl ProcessTexture {
    pub(super) fn read(reader: &mut Reader) -> Self {
        Self {
            target: RenderTarget::read(reader),
            programs: ProgramNames::read_fragment(reader),
            blend: reader.word(Blend::VARIABLE),
        }
    }
}

/// A pass that computes a texture from nothing but its variables.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct GenerateTexture {
    /// `x` for the texture `<generated>:x`.
    pub(crate) texture: String,
    /// The size of the texture.
    pub(crate) size: TextureSize,
    /// The format of the texture.
    pub(crate) format: TextureFormat,
    /// Its programs.
    pub(crate) programs: ProgramNames,
}

impl GenerateTexture {
    pub(super) fn read(reader: &mut Reader) -> Self {
        Self {
            texture: reader.string(render_target::TEXTURE).to_owned(),
            size: render_target::read_size(reader),
            format: render_target::read_formats(reader)[0],
            programs: ProgramNames::read_fragment(reader),
        }
    }
}

/// A pass that runs a program over a texture, and again over its own output.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PingPong {
    /// Where the last run draws.
    pub(crate) target: RenderTarget,
    /// The number of runs; for 0 the input is copied to the target.
    pub(crate) run_count: usize,
    /// Its programs.
    pub(crate) programs: ProgramNames,
    /// How the last run blends with the target.
    pub(crate) blend: Blend,
}

impl PingPong {
    /// The texture variable that every run but the first reads the previous output as.
    pub(crate) const INPUT: &str = render_target::TEXTURE;

    pub(super) fn read(reader: &mut Reader) -> Self {
        Self {
            target: RenderTarget::read(reader),
            run_count: usize::from(reader.integer::<u16>("pass_count")),
            programs: ProgramNames::read_fragment(reader),
            blend: reader.word(Blend::VARIABLE),
        }
    }
}

/// A pass that draws a texture over its target.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Composite {
    /// Where it draws.
    pub(crate) target: RenderTarget,
    /// Its programs.
    pub(crate) programs: ProgramNames,
    /// How it blends with the target.
    pub(crate) blend: Blend,
}

impl Composite {
    pub(super) fn read(reader: &mut Reader) -> Self {
        Self {
            target: RenderTarget::read(reader),
            programs: ProgramNames::read_fragment(reader),
            blend: reader.word(Blend::VARIABLE),
        }
    }
}
