//! The rounding of coordinates: how far a vertex may lie from where it was meant to be.
//!
//! Idea: a file of 6 decimals has moved every coordinate by up to half of a millionth, and a mesh
//! in 32 bits moves it by up to 2^-24 of its size. What is smaller than that is no shape: the
//! height of a needle, the gap of a seam, the last part of an angle. The digits of a file are
//! found from its numbers, because they are all whole multiples of a power of ten, or all have no
//! more than a few significant digits.
//!
//! Rejected: counting digits while reading, which only text has; a tolerance that the user states,
//! which none would know.

use std::collections::BTreeSet;

use glam::DVec3;

use crate::edge_mesh::MeshFrame;
use crate::model::Model;

/// Vertices whose digits are looked at. If all of these are rounded, the file is.
const SAMPLED_VERTICES: usize = 4096;

/// Half of the distance of neighboring 32-bit numbers, as a fraction of the number.
const HALF_STEP_32: f64 = f32::EPSILON as f64 / 2.0;

/// The largest number of digits that are looked for; more do not matter in 32 bits.
const MOST_DIGITS: i32 = 9;

/// The largest rounding by digits, as a fraction of the model's diagonal. A model with fewer digits
/// than that is not rounded, but was made of round numbers, such as a cube from 0 to 1.
const COARSEST: f64 = 2e-4;

/// With so few different numbers, it is chance that none has many digits.
const FEW_NUMBERS: usize = 30;

/// How coordinates of a mesh are rounded. All lengths are in units of the mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rounding {
    /// Half of the last decimal of the file, or 0.
    decimal: f64,
    /// The significant digits of the file, or 0 if it has more than [`MOST_DIGITS`].
    digits: i32,
    /// The distance from the origin of the file to that of the mesh.
    offset: f64,
    /// The scale of the mesh frame.
    scale: f64,
}

impl Rounding {
    /// The rounding of `model` in a mesh of `frame`, whose used vertices lie between `low` and
    /// `high` in units of the file.
    pub(crate) fn of(model: &Model, frame: &MeshFrame, (low, high): (DVec3, DVec3)) -> Self {
        let stride = model.positions.len().div_ceil(SAMPLED_VERTICES).max(1);
        let sample: Vec<f64> =
            model.positions.iter().step_by(stride).flatten().copied().filter(is_number).collect();
        let coarsest = COARSEST * (high - low).length();
        let reach = low.abs().max(high.abs()).max_element();
        let decimals = (0..=MOST_DIGITS).find(|&count| have_decimals(&sample, count));
        let half_decimal = decimals.map_or(0.0, half_unit);
        let largest = largest_numbers(&sample);
        let digits = (1..=MOST_DIGITS)
            .find(|&count| largest > FEW_NUMBERS && have_digits(&sample, count))
            .filter(|&count| half_unit_at(reach, count) <= coarsest);
        Self {
            decimal: if half_decimal <= coarsest { half_decimal * frame.scale } else { 0.0 },
            digits: digits.unwrap_or(0),
            offset: frame.origin.abs().max_element() * frame.scale,
            scale: frame.scale,
        }
    }

    /// How far a coordinate may have been moved, at points whose coordinates are at most `reach`.
    pub(crate) fn at(&self, reach: f64) -> f64 {
        let of_digits = match self.digits {
            0 => 0.0,
            digits => half_unit_at((reach + self.offset) / self.scale, digits) * self.scale,
        };
        (reach * HALF_STEP_32).max(self.decimal).max(of_digits)
    }
}

fn is_number(coordinate: &f64) -> bool {
    coordinate.is_finite()
}

/// Half of the last of `decimals` decimals.
fn half_unit(decimals: i32) -> f64 {
    0.5 * 10_f64.powi(-decimals)
}

/// Half of the last of `digits` significant digits of a number.
fn half_unit_at(number: f64, digits: i32) -> f64 {
    if number > 0.0 { half_unit(digits - 1 - exponent(number)) } else { 0.0 }
}

/// The power of ten of the first digit.
#[expect(clippy::cast_possible_truncation, reason = "-324 to 308")]
fn exponent(number: f64) -> i32 {
    number.abs().max(f64::MIN_POSITIVE).log10().floor() as i32
}

/// Whether all numbers are whole multiples of a power of ten, up to their own rounding: numbers of
/// 32 bits are as good as those that they were rounded from.
fn have_decimals(numbers: &[f64], decimals: i32) -> bool {
    let scale = 10_f64.powi(decimals);
    numbers.iter().all(|number| is_whole(number * scale))
}

/// Whether no number has more significant digits.
fn have_digits(numbers: &[f64], digits: i32) -> bool {
    let is_short = |number: &f64| {
        *number == 0.0 || is_whole(number * 10_f64.powi(digits - 1 - exponent(*number)))
    };
    numbers.iter().all(is_short)
}

/// How many different numbers there are whose first digit is at the largest power of ten.
fn largest_numbers(numbers: &[f64]) -> usize {
    let largest = numbers.iter().fold(0.0, |largest: f64, number| largest.max(number.abs()));
    let least = 10_f64.powi(exponent(largest));
    let large = numbers.iter().map(|number| number.abs()).filter(|number| *number >= least);
    large.map(f64::to_bits).collect::<BTreeSet<u64>>().len()
}

fn is_whole(number: f64) -> bool {
    (number - number.round()).abs() <= number.abs() * (HALF_STEP_32 + f64::EPSILON)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The rounding at coordinates of `reach` of a mesh with irrational positions up to 20 units
    /// that `round` has rounded.
    fn rounding(round: impl Fn(f64) -> f64) -> Rounding {
        let number = |k: u32| round((f64::from(k) * 1.234_567_890_123).sin() * 20.0);
        let positions = (0..900).map(|k| [number(3 * k), number(3 * k + 1), number(3 * k + 2)]);
        let model = Model { positions: positions.collect(), ..Model::default() };
        let corner = DVec3::splat(20.0);
        Rounding::of(&model, &MeshFrame::default(), (-corner, corner))
    }

    fn is_near(found: f64, expected: f64) -> bool {
        (found / expected - 1.0).abs() < 1e-6
    }

    #[expect(clippy::cast_possible_truncation, reason = "rounds")]
    fn in_32_bits(x: f64) -> f64 {
        f64::from(x as f32)
    }

    #[test]
    fn the_decimals_of_a_file_are_found() {
        for decimals in 3..=6 {
            let scale = 10_f64.powi(decimals);
            let found = rounding(|x| (x * scale).round() / scale).at(1.0);
            assert!(is_near(found, 0.5 / scale), "{decimals}: {found}");
        }
    }

    #[test]
    fn numbers_of_32_bits_show_the_decimals_that_they_were_rounded_from() {
        let found = rounding(|x| in_32_bits((x * 1e3).round() / 1e3)).at(1.0);
        assert!(is_near(found, 5e-4), "{found}");
        let found = rounding(in_32_bits).at(16.0);
        assert!(is_near(found, 16.0 / 16_777_216.0), "{found}");
    }

    #[test]
    fn significant_digits_are_finer_near_the_origin() {
        let six = |x: f64| format!("{x:.5e}").parse().unwrap();
        let rounding = rounding(six);
        assert!(is_near(rounding.at(15.0), 5e-5), "{}", rounding.at(15.0));
        assert!(is_near(rounding.at(0.15), 5e-7), "{}", rounding.at(0.15));
    }

    #[test]
    fn round_numbers_are_not_rounded() {
        let cube = [0.0, 1.0].map(|x| [x, 1.0 - x, 0.5]);
        let model = Model { positions: cube.to_vec(), ..Model::default() };
        let rounding = Rounding::of(&model, &MeshFrame::default(), (DVec3::ZERO, DVec3::ONE));
        assert!(is_near(rounding.at(1.0), 1.0 / 16_777_216.0));
        // A plan in whole millimeters is.
        let plan: Vec<[f64; 3]> = (0..99).map(|k| [f64::from(k * 577 % 9973); 3]).collect();
        let model = Model { positions: plan, ..Model::default() };
        let rounding =
            Rounding::of(&model, &MeshFrame::default(), (DVec3::ZERO, DVec3::splat(9973.0)));
        assert!(is_near(rounding.at(1.0), 0.5));
    }
}
