//! Toon maps: factors of the diffuse color by the intensity of the light, from left to
//! right (NPRView thesis, section 4.2, figures 4.3 to 4.5).

use image::{Rgb, RgbImage};

use super::to_byte;

/// Texels along a map, and rows, which are all alike.
const WIDTH: u32 = 256;
const HEIGHT: u32 = 4;

/// Every map by its name.
pub(super) fn pictures() -> Vec<(&'static str, RgbImage)> {
    vec![
        ("two_steps", map(|light| gray(if light < 0.35 { 0.45 } else { 1.0 }))),
        ("three_steps", map(three_steps)),
        ("gradient", map(|light| gray(0.2 + 0.8 * light))),
        ("metallic", map(metallic)),
        ("spectrum", map(spectrum)),
    ]
}

fn map(color: impl Fn(f64) -> [f64; 3]) -> RgbImage {
    RgbImage::from_fn(WIDTH, HEIGHT, |x, _| {
        Rgb(color((f64::from(x) + 0.5) / f64::from(WIDTH)).map(to_byte))
    })
}

fn gray(value: f64) -> [f64; 3] {
    [value; 3]
}

/// Shadow, lit, highlight.
fn three_steps(light: f64) -> [f64; 3] {
    gray(match light {
        ..0.3 => 0.4,
        ..0.8 => 0.75,
        _ => 1.0,
    })
}

/// Bright and dark bands that flow into each other, like reflections in polished metal.
fn metallic(light: f64) -> [f64; 3] {
    const BANDS: [(f64, f64); 8] = [
        (0.0, 0.18),
        (0.18, 0.55),
        (0.32, 0.28),
        (0.5, 0.8),
        (0.62, 0.5),
        (0.8, 0.95),
        (0.9, 0.85),
        (1.0, 1.0),
    ];
    let next = BANDS.iter().position(|band| light <= band.0).unwrap_or(BANDS.len() - 1).max(1);
    let ((start, from), (end, to)) = (BANDS[next - 1], BANDS[next]);
    let t = (light - start) / (end - start);
    let value = from + (to - from) * t * t * (3.0 - 2.0 * t);
    // The dark bands are a little blue.
    [value, value, value + 0.04 * (1.0 - value)]
}

/// The colors of the rainbow, from violet to red.
fn spectrum(light: f64) -> [f64; 3] {
    const COLORS: [[f64; 3]; 7] = [
        [0.45, 0.0, 0.75],
        [0.0, 0.1, 1.0],
        [0.0, 0.85, 0.95],
        [0.0, 0.85, 0.1],
        [1.0, 0.95, 0.0],
        [1.0, 0.5, 0.0],
        [1.0, 0.0, 0.0],
    ];
    let place = light * (COLORS.len() - 1) as f64;
    let from = (0..COLORS.len() - 2).rev().find(|&at| at as f64 <= place).unwrap_or(0);
    let t = place - from as f64;
    std::array::from_fn(|channel| {
        COLORS[from][channel] + (COLORS[from + 1][channel] - COLORS[from][channel]) * t
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn colors_of(name: &str) -> Vec<[u8; 3]> {
        let picture = pictures().into_iter().find(|(known, _)| *known == name).unwrap().1;
        (0..WIDTH).map(|x| picture.get_pixel(x, 1).0).collect()
    }

    #[test]
    fn stepped_maps_have_their_steps_and_smooth_ones_none() {
        for (name, count) in [("two_steps", 2), ("three_steps", 3)] {
            let mut colors = colors_of(name);
            colors.dedup();
            assert_eq!(colors.len(), count, "{name}");
            assert!(colors.is_sorted(), "{name} grows brighter with the light");
        }
        for name in ["gradient", "metallic", "spectrum"] {
            let colors = colors_of(name);
            let steps = colors
                .windows(2)
                .flat_map(|pair| (0..3).map(|channel| pair[0][channel].abs_diff(pair[1][channel])));
            assert!(steps.max().unwrap() < 10, "{name} is smooth");
        }
    }
}
