//! Placement of strokes, and of brushes along them.

/// The placement of a stroke on its spine. WGSL twins: the constants of these names.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(u32)]
pub enum Placement {
    /// Half of the width on each side (Equation 2).
    Centered = 0,
    /// All of the width outside (Equation 3).
    Outside = 1,
    /// All of the width inside.
    Inside = 2,
    /// Outside for contours, centered for everything else.
    #[default]
    Automatic = 3,
}

/// The parameterization of brushes along strokes (section 4). WGSL twins: `OBJECT_SPACE` and
/// `SCREEN_SPACE`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(u32)]
pub enum Parameterization {
    /// From a random start along each edge: coherent in animation, broken at every vertex.
    #[default]
    ObjectSpace = 0,
    /// By position on the screen: unbroken in a still picture on any mesh.
    ScreenSpace = 1,
}
