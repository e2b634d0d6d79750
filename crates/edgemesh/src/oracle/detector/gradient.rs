//! Edges as maxima of the first derivative: the Sobel operator (NPRView thesis, section
//! 3.2, Equations 3.1 to 3.3).

use glam::{Vec2, Vec4};

use super::{INTENSITY, Image, Texel};

/// The gradient of each channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gradient {
    /// Derivative to the right.
    pub x: Vec4,
    /// Derivative downward.
    pub y: Vec4,
}

/// The Sobel operator (Figure 3.2).
#[must_use]
pub fn sobel(image: &Image<Vec4>, [column, row]: Texel) -> Gradient {
    let mut gradient = Gradient { x: Vec4::ZERO, y: Vec4::ZERO };
    for (dy, across, down) in [(-1, 1.0, -1.0), (0, 2.0, 0.0), (1, 1.0, 1.0)] {
        let value = |dx: isize| image.at([column + dx, row + dy]);
        gradient.x += across * (value(1) - value(-1));
        gradient.y += down * (value(-1) + 2.0 * value(0) + value(1));
    }
    gradient
}

/// The norm of a gradient.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Magnitude {
    /// Equation 3.1: the Euclidean norm.
    Root,
    /// Equation 3.2: the sum of absolute values.
    Sum,
}

impl Magnitude {
    /// The norm of `gradient`.
    #[must_use]
    pub fn of(self, gradient: Vec2) -> f32 {
        match self {
            Self::Root => gradient.length(),
            Self::Sum => gradient.x.abs() + gradient.y.abs(),
        }
    }
}

/// The gradient of the intensity of colors. Its orientation is Equation 3.3.
#[must_use]
pub fn of_intensity(gradient: &Gradient) -> Vec2 {
    let of = |channels: Vec4| channels.truncate().dot(INTENSITY);
    Vec2::new(of(gradient.x), of(gradient.y))
}

/// The largest gradient of the three color channels; the first one of equal gradients.
#[must_use]
pub fn of_largest_channel(gradient: &Gradient, magnitude: Magnitude) -> Vec2 {
    let channel = |at: usize| Vec2::new(gradient.x[at], gradient.y[at]);
    (1..3).map(channel).fold(channel(0), |largest, other| {
        match magnitude.of(other) > magnitude.of(largest) {
            true => other,
            false => largest,
        }
    })
}
