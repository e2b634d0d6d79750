//! The layouts of edge records that a file can hold.

/// A layout of the edge records in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Layout {
    /// Indexed edge records, 20 bytes an edge; every file has them.
    Indexed,
    /// The edge vertices of the paper, in 32-bit floats: 4 × 80 bytes an edge.
    ReplicatedF32,
    /// The edge vertices of the paper, in 16 bits: 4 × 40 bytes an edge.
    ReplicatedI16,
}

impl Layout {
    /// All layouts.
    pub const ALL: [Self; 3] = [Self::Indexed, Self::ReplicatedF32, Self::ReplicatedI16];

    /// The name of the layout on the command line.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Indexed => "indexed",
            Self::ReplicatedF32 => "replicated-f32",
            Self::ReplicatedI16 => "replicated-i16",
        }
    }
}
