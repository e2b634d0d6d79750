//! Typed views of the core components: the variables that the Rust code of a component
//! reads, one struct per component.
//!
//! ```text
//!   Pass: values by name --CoreView::of--> SimpleRender, Strokes, ...: typed fields
//!                               |
//!                               '--> mistakes: unknown words, texts that do not parse
//! ```
//!
//! Only this folder reads values of a pass by name. Names and words are also in the
//! descriptors (`techniques/components/core.toml`); `tests.rs` compares both.

mod blend;
mod copy_to_texture;
mod curve;
mod lines;
pub(super) mod programs;
mod reader;
pub(super) mod render_target;
mod run_mode;
mod screen;
mod simple_render;
mod strokes;
#[cfg(test)]
mod tests;

pub(crate) use self::blend::Blend;
pub(crate) use self::copy_to_texture::CopyToTexture;
pub(crate) use self::lines::{LineSelection, Visibility, classes_text};
pub(crate) use self::programs::ProgramNames;
use self::reader::Reader;
pub(crate) use self::render_target::RenderTarget;
pub(crate) use self::run_mode::RunMode;
pub(crate) use self::screen::{Composite, GenerateTexture, PingPong, ProcessTexture};
pub(crate) use self::simple_render::SimpleRender;
pub(crate) use self::strokes::{StrokeEnds, StrokeKind, StrokeWidth, Strokes};
use super::core::CoreComponent;
use super::mistake::Mistakes;
use super::pass::Pass;

/// The variables of a pass, by its core component.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum CoreView {
    /// Of `simple_render`.
    SimpleRender(SimpleRender),
    /// Of `strokes`.
    Strokes(Box<Strokes>),
    /// Of `process_texture`.
    ProcessTexture(ProcessTexture),
    /// Of `copy_to_texture`.
    CopyToTexture(CopyToTexture),
    /// Of `generate_texture`.
    GenerateTexture(GenerateTexture),
    /// Of `ping_pong`.
    PingPong(PingPong),
    /// Of `composite`.
    Composite(Composite),
}

impl CoreView {
    /// Reads the variables of a pass. Mistakes are added to `mistakes`, with placeholders
    /// for what they are about.
    #[must_use]
    pub(super) fn read(pass: &Pass, mistakes: &mut Mistakes) -> Self {
        Self::read_from(pass.component.core, &mut Reader::new(pass, mistakes))
    }

    fn read_from(core: CoreComponent, reader: &mut Reader) -> Self {
        match core {
            CoreComponent::SimpleRender => Self::SimpleRender(SimpleRender::read(reader)),
            CoreComponent::Strokes => Self::Strokes(Box::new(Strokes::read(reader))),
            CoreComponent::ProcessTexture => Self::ProcessTexture(ProcessTexture::read(reader)),
            CoreComponent::CopyToTexture => Self::CopyToTexture(CopyToTexture::read(reader)),
            CoreComponent::GenerateTexture => Self::GenerateTexture(GenerateTexture::read(reader)),
            CoreComponent::PingPong => Self::PingPong(PingPong::read(reader)),
            CoreComponent::Composite => Self::Composite(Composite::read(reader)),
        }
    }

    /// The programs of the pass.
    #[must_use]
    pub(crate) fn programs(&self) -> ProgramNames {
        match self {
            Self::SimpleRender(view) => view.programs.clone(),
            Self::ProcessTexture(view) => view.programs.clone(),
            Self::GenerateTexture(view) => view.programs.clone(),
            Self::PingPong(view) => view.programs.clone(),
            Self::Composite(view) => view.programs.clone(),
            Self::Strokes(_) | Self::CopyToTexture(_) => ProgramNames::default(),
        }
    }

    /// How the pass blends with its target.
    #[must_use]
    pub(crate) const fn blend(&self) -> Blend {
        match self {
            Self::SimpleRender(view) => view.blend,
            Self::ProcessTexture(view) => view.blend,
            Self::PingPong(view) => view.blend,
            Self::Composite(view) => view.blend,
            Self::Strokes(_) | Self::CopyToTexture(_) | Self::GenerateTexture(_) => Blend::Replace,
        }
    }
}

impl Strokes {
    /// Reads the variables of a pass of strokes.
    ///
    /// # Errors
    /// All mistakes, also if it is a pass of another component.
    pub(crate) fn of(pass: &Pass) -> Result<Self, Mistakes> {
        let mut mistakes = Mistakes::default();
        let view = Self::read(&mut Reader::new(pass, &mut mistakes));
        mistakes.or(view).map(|(view, _)| view)
    }
}

impl SimpleRender {
    /// Reads the variables of a pass that draws the surfaces of the scene.
    ///
    /// # Errors
    /// All mistakes, also if it is a pass of another component.
    pub(crate) fn of(pass: &Pass) -> Result<Self, Mistakes> {
        let mut mistakes = Mistakes::default();
        let view = Self::read(&mut Reader::new(pass, &mut mistakes));
        mistakes.or(view).map(|(view, _)| view)
    }
}

impl RunMode {
    /// Reads the variable `run` of a pass.
    #[must_use]
    pub(super) fn read(pass: &Pass, mistakes: &mut Mistakes) -> Self {
        Reader::new(pass, mistakes).word(Self::VARIABLE)
    }
}
