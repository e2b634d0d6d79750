//! Edges as discontinuities of normals (NPRView thesis, section 3.3.1; Card and Mitchell,
//! Listing 9).

use glam::Vec3;

use super::{CROSS, DIAGONALS, Image, Texel};

/// The normal of a color: channels from 0 to 1 are components from -1 to 1.
#[must_use]
pub fn normal_of_rgb(rgb: Vec3) -> Vec3 {
    2.0 * rgb - 1.0
}

/// Equations 3.7 and 3.8: the least dot product with the normals of the four neighbors, and the sum
/// of all four. An edge has the first below a threshold; without a threshold, 4 minus the second is
/// its strength.
#[must_use]
pub fn dot_products(normals: &Image<Vec3>, at: Texel) -> [f32; 2] {
    let products = normals.around(at, CROSS).map(|other| normals.at(at).dot(other));
    [products.into_iter().fold(f32::MAX, f32::min), products.iter().sum()]
}

/// Listing 9: the least dot product with the normals of the four diagonal neighbors. An edge is
/// below a threshold.
#[must_use]
pub fn five_taps(normals: &Image<Vec3>, at: Texel) -> f32 {
    let products = normals.around(at, DIAGONALS).map(|other| normals.at(at).dot(other));
    products.into_iter().fold(f32::MAX, f32::min)
}
