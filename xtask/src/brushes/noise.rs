//! Noise that repeats along u.

/// Smooth noise from 0 to 1 that repeats along u after `cells` periods of its lattice, and
/// does not repeat along v.
pub(super) fn noise(u: f64, v: f64, cells: u32, seed: u32) -> f64 {
    let (column, across) = cell_of(u * f64::from(cells));
    let (row, down) = cell_of(v);
    let at = |c: u32, r: u32| hash(c % cells, r, seed);
    let top = mix(at(column, row), at(column + 1, row), across);
    let bottom = mix(at(column, row + 1), at(column + 1, row + 1), across);
    mix(top, bottom, down)
}

/// Noise for the grain of paper, in a picture eight times as long as high: its cells are
/// square, and slanted and warped so that the lattice does not show.
pub(super) fn grain(u: f64, v: f64, cells: u32, seed: u32) -> f64 {
    let rows = f64::from(cells) / 8.0;
    let slant = if seed.is_multiple_of(2) { v } else { 1.0 - v };
    let bend = 1.2 * noise(u, v * rows * 0.37, cells * 2 / 5, seed + 100);
    noise(u + 0.06 * slant, v * rows + bend, cells, seed)
}

/// The lattice cell and where in it, eased so that cells join without a kink.
fn cell_of(position: f64) -> (u32, f64) {
    #[expect(clippy::cast_possible_truncation, reason = "positions are small")]
    let cell = position.max(0.0) as u32;
    (cell, smooth_step(0.0, 1.0, position - f64::from(cell)))
}

/// A pseudorandom number from 0 to 1.
pub(super) fn hash(column: u32, row: u32, seed: u32) -> f64 {
    let mut bits = column.wrapping_mul(0x9E37_79B1);
    for word in [row, seed] {
        bits = (bits ^ word).wrapping_mul(0x85EB_CA6B);
        bits = (bits ^ (bits >> 15)).wrapping_mul(0xC2B2_AE35);
        bits ^= bits >> 13;
    }
    f64::from(bits) / f64::from(u32::MAX)
}

pub(super) fn mix(a: f64, b: f64, part: f64) -> f64 {
    a + (b - a) * part
}

/// 0 below `low`, 1 above `high`, a smooth slope between.
pub(super) fn smooth_step(low: f64, high: f64, value: f64) -> f64 {
    let t = ((value - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points all over a brush.
    fn places() -> impl Iterator<Item = (f64, f64)> {
        (0..1024).map(|step| (f64::from(step % 64) / 64.0, f64::from(step / 64) / 16.0))
    }

    #[test]
    fn noise_repeats_along_u_only() {
        for (u, v) in places() {
            let difference = noise(u, v * 5.0, 7, 3) - noise(u + 1.0, v * 5.0, 7, 3);
            assert!(difference.abs() < 1e-9, "{difference} at {u}, {v}");
        }
        assert!((noise(0.2, 0.0, 7, 3) - noise(0.2, 7.0, 7, 3)).abs() > 0.01);
    }

    #[test]
    fn grain_repeats_along_u() {
        for (u, v) in places() {
            let difference = grain(u, v, 113, 4) - grain(u + 1.0, v, 113, 4);
            assert!(difference.abs() < 1e-9, "{difference} at {u}, {v}");
        }
    }
}
