//! Papers: light grain that tiles in both directions without a seam.

use image::{Rgb, RgbImage};

use super::{hash, noise, to_byte};

/// Texels per side.
const SIDE: u32 = 256;

/// The number of grays: fewer make smaller files, and nobody sees it in grain.
const GRAYS: f64 = 64.0;

/// Every paper by its name.
pub(super) fn pictures() -> Vec<(&'static str, RgbImage)> {
    vec![("canvas", sheet(canvas)), ("laid", sheet(laid)), ("rough", sheet(rough))]
}

fn sheet(light: impl Fn(f64, f64) -> f64) -> RgbImage {
    RgbImage::from_fn(SIDE, SIDE, |x, y| {
        let place = |texel: u32| (f64::from(texel) + 0.5) / f64::from(SIDE);
        // Rounded up or down at random, so that no bands show.
        let chance = hash(x, y, 77) - 0.5;
        let value = (light(place(x), place(y)) * GRAYS + chance).round() / GRAYS;
        Rgb([to_byte(value.min(1.0)); 3])
    })
}

/// Cold-pressed watercolor paper: pits of several sizes, lit from the upper left.
fn rough(u: f64, v: f64) -> f64 {
    let height = |u: f64, v: f64| {
        let wrap = |at: f64| at - at.floor();
        let (u, v) = (wrap(u), wrap(v));
        // Warped, so that the lattice does not show.
        let bend = 0.02 * noise(u, v, 7, 3);
        let at = |cells, seed| noise(wrap(u + bend), wrap(v + 2.0 * bend), cells, seed);
        at(24, 11) + 0.6 * at(47, 12) + 0.35 * at(89, 13)
    };
    let step = 1.0 / f64::from(SIDE);
    let slope = height(u, v) - height(u - step, v - step);
    0.93 + 0.45 * slope
}

/// Laid paper: fine wires close together, chain lines far apart, and cloudy pulp.
fn laid(u: f64, v: f64) -> f64 {
    let wave = |at: f64| {
        // A parabola in each period, as smooth as is needed.
        let t = at - at.floor();
        1.0 - 8.0 * (t - 0.5) * (t - 0.5)
    };
    let sway = 0.15 * noise(u, v, 4, 21);
    let wires = wave(32.0 * v + sway);
    let chain = u * 4.0 + 0.05 * noise(u, v, 9, 22);
    let beside = (chain - chain.floor() - 0.5).abs();
    let chains = (1.0 - beside * 40.0).max(0.0);
    let pulp = noise(u, v, 12, 23) + 0.5 * noise(u, v, 37, 24) - 0.75;
    0.935 + 0.014 * wires - 0.035 * chains + 0.03 * pulp + 0.015 * (hash_of(u, v) - 0.5)
}

/// A weave: threads over and under each other.
fn canvas(u: f64, v: f64) -> f64 {
    const THREADS: f64 = 32.0;
    let (across, along) = (u * THREADS, v * THREADS);
    let round = |at: f64| {
        let t = at - at.floor() - 0.5;
        1.0 - 4.0 * t * t
    };
    // Each crossing shows the one thread or the other.
    let is_weft = (across.floor() + along.floor()) % 2.0 < 1.0;
    let (thread, length) = if is_weft { (along, across) } else { (across, along) };
    let lift = 0.6 * round(thread) + 0.4 * round(length);
    let wear = noise(u, v, 16, 31) - 0.5 + 0.5 * (noise(u, v, 61, 32) - 0.5);
    0.88 + 0.1 * lift + 0.04 * wear
}

/// A random number per texel, 0 to 1.
fn hash_of(u: f64, v: f64) -> f64 {
    #[expect(clippy::cast_possible_truncation, reason = "places within a sheet")]
    let texel = |at: f64| (at * f64::from(SIDE)) as u32;
    hash(texel(u), texel(v), 55)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The mean difference of two columns, or of two rows of a rotated picture.
    fn step(picture: &RgbImage, left: u32, right: u32, is_turned: bool) -> f64 {
        let value = |at: u32, row: u32| match is_turned {
            true => picture.get_pixel(row, at).0[0],
            false => picture.get_pixel(at, row).0[0],
        };
        let sum: f64 =
            (0..SIDE).map(|row| f64::from(value(left, row).abs_diff(value(right, row)))).sum();
        sum / f64::from(SIDE)
    }

    #[test]
    fn no_seam_shows_and_papers_are_light() {
        for (name, picture) in pictures() {
            for is_turned in [false, true] {
                let seam = step(&picture, SIDE - 1, 0, is_turned);
                let inside = (1..SIDE).map(|at| step(&picture, at - 1, at, is_turned));
                let most = inside.fold(0.0, f64::max);
                assert!(seam <= most, "{name}: {seam:.2} at the seam, {most:.2} inside");
            }
            let sum: f64 = picture.pixels().map(|pixel| f64::from(pixel.0[0])).sum();
            let mean = sum / f64::from(SIDE * SIDE) / 255.0;
            assert!((0.88..0.97).contains(&mean), "{name}: {mean:.3}");
        }
    }
}
