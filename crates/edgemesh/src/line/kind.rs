//! Kinds of lines: the shape along an edge and at its ends.

/// Triangles of a half disk. WGSL twin: the constant of this name.
pub const DISK_STEPS: u32 = 8;

/// Vertices of a cap, besides those of the quad.
pub const CAP_VERTICES: u32 = 3;

/// Vertices of a half disk.
pub const DISK_VERTICES: u32 = DISK_STEPS + 2;

/// Kinds of lines and of their ends. WGSL twins: the constants of these names.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
#[repr(u32)]
pub enum LineKind {
    /// A line of one pixel (section 3.2).
    Thin = 0,
    /// A quad that ends with its edge.
    Quad = 1,
    /// A quad with the paper's caps (Equations 4 and 5).
    #[default]
    QuadAndCaps = 2,
    /// A quad with half disks (section 6).
    QuadAndDisks = 3,
    /// A quad along the vertex normals at the edge (Card and Mitchell, Listing 1).
    Fin = 4,
}

impl LineKind {
    /// The number of vertices for each edge.
    #[must_use]
    pub const fn vertex_count(self) -> u32 {
        match self {
            Self::Thin => 2,
            Self::Quad | Self::Fin => 4,
            Self::QuadAndCaps => 4 + 2 * CAP_VERTICES,
            Self::QuadAndDisks => 4 + 2 * DISK_VERTICES,
        }
    }

    /// Indices of the vertices of an edge: triangles, or one line for [`Self::Thin`].
    #[must_use]
    pub fn indices(self) -> Vec<u32> {
        let mut indices = match self {
            Self::Thin => return vec![0, 1],
            _ => vec![0, 1, 2, 0, 2, 3],
        };
        match self {
            Self::QuadAndCaps => indices.extend(4..10),
            Self::QuadAndDisks => {
                for middle in [4, 4 + DISK_VERTICES] {
                    indices.extend(
                        (1..=DISK_STEPS).flat_map(|k| [middle, middle + k, middle + k + 1]),
                    );
                }
            }
            _ => {}
        }
        indices
    }
}
