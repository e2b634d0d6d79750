//! Vectors for the generators.

use std::f64::consts::TAU;

/// A point or a direction: x, y (up), z.
pub(crate) type Point = [f64; 3];

pub(crate) fn add(a: Point, b: Point) -> Point {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(crate) fn scale(a: Point, factor: f64) -> Point {
    a.map(|coordinate| coordinate * factor)
}

pub(crate) fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The vector at length 1; the zero vector stays as it is.
pub(crate) fn unit(a: Point) -> Point {
    let length = dot(a, a).sqrt();
    if length > 0.0 { scale(a, 1.0 / length) } else { a }
}

/// Sine and cosine of `step` of `steps` parts of a turn. Step `steps` equals step 0 to the
/// last bit.
pub(crate) fn turn(step: u32, steps: u32) -> (f64, f64) {
    (TAU * f64::from(step % steps) / f64::from(steps)).sin_cos()
}
