//! Edges as zero crossings of the second derivative: the Laplacian of the Gaussian, and the test
//! for zero crossings (NPRView thesis, section 3.2, Equation 3.6).

use std::f32::consts::PI;

use glam::Vec3;

use super::{CROSS, INTENSITY, Image, Texel};

/// Equation 3.6 at (`x`, `y`) texels from the middle; `sigma` is the standard deviation of the
/// Gaussian, in texels.
#[must_use]
fn weight(x: f32, y: f32, sigma: f32) -> f32 {
    let sigma_2 = sigma * sigma;
    let part = (x * x + y * y) / (2.0 * sigma_2);
    -(1.0 - part) * (-part).exp() / (PI * sigma_2 * sigma_2)
}

/// The Laplacian of the smoothed intensity; `sigma` is the standard deviation of the Gaussian, in
/// texels. The weights, sampled and cut off at four standard deviations, do not sum to 0, so their
/// mean is subtracted: a constant image must give 0.
#[must_use]
pub fn laplacian_of_gaussian(colors: &Image<Vec3>, sigma: f32, [column, row]: Texel) -> f32 {
    #[expect(clippy::cast_possible_truncation, reason = "the window has at most 65 texels a side")]
    let reach = (4.0 * sigma).ceil() as isize;
    let [mut sum, mut weights, mut values, mut count] = [0.0; 4];
    for dy in -reach..=reach {
        for dx in -reach..=reach {
            let value = colors.at([column + dx, row + dy]).dot(INTENSITY);
            #[expect(clippy::cast_precision_loss, reason = "at most 32")]
            let by = weight(dx as f32, dy as f32, sigma);
            sum += by * value;
            weights += by;
            values += value;
            count += 1.0;
        }
    }
    sum - weights * values / count
}

/// The largest step to a neighbor of the other sign, or 0 without one. An edge reaches a threshold.
#[must_use]
pub fn zero_crossing(second_derivative: &Image<f32>, at: Texel) -> f32 {
    let center = second_derivative.at(at);
    let steps = second_derivative.around(at, CROSS).map(|other| match center * other < 0.0 {
        true => (center - other).abs(),
        false => 0.0,
    });
    steps.into_iter().fold(0.0, f32::max)
}
