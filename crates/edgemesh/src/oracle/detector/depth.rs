//! Edges as discontinuities of depth (NPRView thesis, section 3.3.2; Card and
//! Mitchell, Listing 10).

use super::{CROSS, DIAGONALS, Image, Texel};

/// How distances from the eye along the direction of sight become depths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DepthMapping {
    /// At a distance d, clip z = x d + y and w = z d + w.
    pub projection: [f32; 4],
    /// The distances between which the scene's bounding sphere lies.
    pub range: [f32; 2],
}

/// The distance from the eye along the direction of sight (Equation 3.11, for any projection). The
/// background of a view without a far plane lies at the far end of the scene.
#[must_use]
pub fn distance_of(depth: f32, mapping: &DepthMapping) -> f32 {
    let [x, y, z, w] = mapping.projection;
    let divisor = depth * z - x;
    if divisor == 0.0 { mapping.range[1] } else { (y - depth * w) / divisor }
}

/// Equation 3.12: the largest difference to a neighbor. An edge is above a threshold.
#[must_use]
pub fn delta(distances: &Image<f32>, at: Texel) -> f32 {
    let deltas = distances.around(at, CROSS).map(|other| (distances.at(at) - other).abs());
    deltas.into_iter().fold(0.0, f32::max)
}

/// Equation 3.13: the absolute Laplacian. An edge is above a threshold.
#[must_use]
pub fn laplacian(distances: &Image<f32>, at: Texel) -> f32 {
    let sum: f32 = distances.around(at, CROSS).iter().sum();
    (sum - 4.0 * distances.at(at)).abs()
}

/// Listing 10: the sum of the differences to the four diagonal neighbors. An edge reaches a
/// threshold.
#[must_use]
pub fn five_taps(depths: &Image<f32>, at: Texel) -> f32 {
    depths.around(at, DIAGONALS).map(|other| (depths.at(at) - other).abs()).iter().sum()
}
