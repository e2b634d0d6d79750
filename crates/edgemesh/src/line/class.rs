//! Classes of lines, and the table that says which of them a drawing has.
//!
//! WGSL twin: `shaders/common/feature.wgsl`.

use bytemuck::{Pod, Zeroable};

/// The classes of edges, the strongest first: an edge of several is drawn as the
/// first of them that is drawn at all.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[repr(u32)]
pub enum LineClass {
    /// Between a face toward the eye and one away from it.
    Contour,
    /// Chosen by the artist.
    Marked,
    /// Of one face, or of more than two.
    Boundary,
    /// Between two materials.
    Material,
    /// Between two smoothing groups.
    Smoothing,
    /// A convex crease.
    Ridge,
    /// A concave crease.
    Valley,
}

impl LineClass {
    /// All classes, the strongest first.
    pub const ALL: [Self; 7] = [
        Self::Contour,
        Self::Marked,
        Self::Boundary,
        Self::Material,
        Self::Smoothing,
        Self::Ridge,
        Self::Valley,
    ];

    /// The word for it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Contour => "contour",
            Self::Marked => "marked",
            Self::Boundary => "boundary",
            Self::Material => "material",
            Self::Smoothing => "smoothing",
            Self::Ridge => "ridge",
            Self::Valley => "valley",
        }
    }
}

/// The layer of a class that is not drawn. WGSL twin: the constant of this name.
pub const NO_LAYER: u32 = 15;

/// Which classes are drawn, in which layer, and from which angle on an edge is a
/// crease. WGSL twin: `shaders/common/feature.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct ClassTable {
    /// Four bits a class, the strongest lowest: its layer, or [`NO_LAYER`].
    pub layers: u32,
    /// One bit a class that is drawn.
    pub drawn: u32,
    /// From this many steps on a convex edge is a ridge; 0 for as built.
    pub ridge_steps: u32,
    /// From this many steps on a concave edge is a valley; 0 for as built.
    pub valley_steps: u32,
    /// 1 where edges that their own solid hides are drawn too, as hidden lines.
    pub keeps_hidden: u32,
}

impl ClassTable {
    /// The table with each class in the layer that `layer_of` gives, from 0 to
    /// 14; classes without a layer are not drawn.
    #[must_use]
    pub fn new(layer_of: impl Fn(LineClass) -> Option<u32>) -> Self {
        let mut table = Self::zeroed();
        for class in LineClass::ALL {
            let layer = layer_of(class).unwrap_or(NO_LAYER);
            table.layers |= layer << (4 * class as u32);
            table.drawn |= u32::from(layer != NO_LAYER) << class as u32;
        }
        table
    }

    /// All classes in one layer, with the creases as built.
    #[must_use]
    pub fn all_in_one() -> Self {
        Self::new(|_| Some(0))
    }
}
