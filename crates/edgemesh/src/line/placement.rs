//! Where strokes lie, and how a brush lies along them.

/// Where a stroke lies on its spine. WGSL twins: the constants of these names.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(u32)]
pub enum Placement {
    /// Half of the width to each side (Equation 2).
    Centred = 0,
    /// All of the width outside (Equation 3).
    Outside = 1,
    /// All of the width inside.
    Inside = 2,
    /// Contours outside, everything else centred.
    #[default]
    Automatic = 3,
}

/// How a brush lies along strokes (section 4). WGSL twins: `OBJECT_SPACE` and
/// `SCREEN_SPACE`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(u32)]
pub enum Parameterization {
    /// From a random start along the edge: coherent in animation, broken at
    /// every vertex.
    #[default]
    ObjectSpace = 0,
    /// By the place on the screen: whole in a still picture, whatever the mesh.
    ScreenSpace = 1,
}
