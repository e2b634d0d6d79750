//! The core components.

/// A component that is implemented in Rust (NPRView thesis, section 2.3).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum CoreComponent {
    /// Draws the scene with a vertex and a fragment program.
    SimpleRender,
    /// Draws feature edges as strokes.
    Strokes,
    /// Runs a full-screen program over input textures.
    ProcessTexture,
    /// Copies the current picture, or its depth, to a texture.
    CopyToTexture,
    /// Computes a texture with a program.
    GenerateTexture,
    /// Runs a full-screen program over a texture, then over its own output.
    PingPong,
    /// Draws a texture over a target.
    Composite,
}

impl CoreComponent {
    /// All core components.
    pub(crate) const ALL: [Self; 7] = [
        Self::SimpleRender,
        Self::Strokes,
        Self::ProcessTexture,
        Self::CopyToTexture,
        Self::GenerateTexture,
        Self::PingPong,
        Self::Composite,
    ];

    /// The name that descriptors give as `core`.
    #[must_use]
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::SimpleRender => "simple_render",
            Self::Strokes => "strokes",
            Self::ProcessTexture => "process_texture",
            Self::CopyToTexture => "copy_to_texture",
            Self::GenerateTexture => "generate_texture",
            Self::PingPong => "ping_pong",
            Self::Composite => "composite",
        }
    }

    /// The core component of a name.
    #[must_use]
    pub(crate) fn of_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|core| core.name() == name)
    }
}
