//! CPU twins of the detectors of image-space edges: their measures at a texel, by the formulas of
//! their papers.
//!
//! | here | `shaders/` | paper |
//! |---|---|---|
//! | [`normals`] | `common/edges.wgsl`, `programs/edge_normals.wgsl` | NPRView thesis, Equations 3.7 and 3.8; Card and Mitchell, Listing 9 |
//! | [`depth`] | `common/edges.wgsl`, `programs/edge_depth*.wgsl` | thesis, Equations 3.11 to 3.13; Card and Mitchell, Listing 10 |
//! | [`planes`] | `common/edges.wgsl` | a distance from planes (not from a paper) |
//! | [`regions`] | `common/edges.wgsl` | thesis, section 3.3.3 |
//! | [`gradient`] | `programs/sobel.wgsl` | thesis, Equations 3.1 to 3.3 |
//! | [`second_derivative`] | `programs/laplacian_of_gaussian.wgsl`, `programs/zero_crossings.wgsl` | thesis, Equation 3.6 |
//! | [`chiang`] | `programs/edge_chiang.wgsl` | Chiang et al., section III.C |
//!
//! All but the last are written to be read: a measure at a texel of an [`Image`]. The detector of
//! Chiang et al. is written to be fast, for a fair comparison with the GPU in their Table I.

pub mod chiang;
pub mod depth;
pub mod gradient;
mod image;
pub mod normals;
pub mod planes;
pub mod regions;
pub mod second_derivative;

pub use image::{Image, Texel};

/// The cross of the thesis (Figure 3.5): left, right, below, above. WGSL twin:
/// `common/taps.wgsl`.
const CROSS: [Texel; 4] = [[-1, 0], [1, 0], [0, 1], [0, -1]];

/// Card and Mitchell's diagonal taps (Listings 9 and 10). WGSL twin: `common/taps.wgsl`.
const DIAGONALS: [Texel; 4] = [[1, 1], [-1, 1], [-1, -1], [1, -1]];

/// The weights of the color channels in the intensity (thesis, Equation 4.5).
const INTENSITY: glam::Vec3 = glam::Vec3::new(0.3, 0.6, 0.1);
