//! Tonal art maps: six tones of hatching, each with mip levels whose strokes are as wide
//! as those of the largest (Praun, Hoppe, Webb and Finkelstein, *Real-Time Hatching*,
//! 2001, section 3).
//!
//! Strokes are nested: those of a tone are in every darker one, and those of a mip level
//! in every finer one, so that no ink vanishes when the eye comes nearer or the light
//! fades. Each stroke is the one of many random candidates that lies where least ink is.
//!
//! ```text
//!            tone 1   2   3   4   5   6        a file: red, green, blue are three tones
//!   coarse     .  ->  .  ->  ...               +--------+----+
//!              |      |                        | level 0| 1  |
//!              v      v                        |        +--+-+
//!   fine       .  ->  .  ->  ...               |        |2 |
//!                                              +--------+--+   below it 3, 4 ...
//! ```
//!
//! Rejected: averaging mip levels, which fades strokes to gray instead of thinning them out.

use image::{Rgb, RgbImage};

use super::{hash, noise, to_byte};

/// Texels per side of the largest level.
const SIDE: u32 = 256;
/// The smallest level with strokes; those below are even tones.
const LEAST_SIDE: u32 = 16;
const TONES: usize = 6;
/// Candidates for each stroke.
const CANDIDATES: u32 = 200;
/// Cells per side of the grid that records where ink is.
const GRID: u32 = 64;

/// A drawing tool.
struct Tool {
    name: &'static str,
    width_px: f64,
    /// The share of the ink that the grain removes.
    grain: f64,
    seed: u32,
}

const TOOLS: [Tool; 2] = [
    Tool { name: "charcoal", width_px: 3.4, grain: 0.6, seed: 900 },
    Tool { name: "pen", width_px: 1.9, grain: 0.0, seed: 100 },
];

/// A stroke, in parts of the tile.
#[derive(Debug, Clone, Copy)]
struct Stroke {
    u: f64,
    v: f64,
    length: f64,
    slant: f64,
    bow: f64,
    is_across: bool,
    ink: f64,
    /// The number of its grain: strokes over each other fill their gaps.
    tooth: u32,
}

/// Every map by its name: tones 1 to 3, and 4 to 6.
pub(super) fn pictures() -> Vec<(String, RgbImage)> {
    let mut pictures = Vec::new();
    for tool in &TOOLS {
        let levels = levels(tool);
        for (first, which) in [(0, "123"), (3, "456")] {
            pictures.push((format!("{}_{which}", tool.name), atlas(&levels, first)));
        }
    }
    pictures
}

/// How dark a tone is, from 0 to 1.
fn target(tone: usize) -> f64 {
    (tone + 1) as f64 / 7.0
}

/// Darkness of the texels of a square, row by row.
#[derive(Debug, Clone)]
struct Sheet {
    side: u32,
    ink: Vec<f64>,
}

impl Sheet {
    fn new(side: u32) -> Self {
        Self { side, ink: vec![0.0; (side * side) as usize] }
    }

    fn mean(&self) -> f64 {
        self.ink.iter().sum::<f64>() / self.ink.len() as f64
    }

    fn even(side: u32, ink: f64) -> Self {
        Self { side, ink: vec![ink; (side * side) as usize] }
    }

    /// Draws a stroke as wide as its tool, whatever the size of the sheet.
    fn draw(&mut self, stroke: &Stroke, tool: &Tool) {
        let side = f64::from(self.side);
        let steps = (stroke.length * side * 2.0).ceil().max(2.0);
        let mut step = 0.0;
        while step <= steps {
            let t = step / steps;
            step += 1.0;
            let (u, v) = stroke.place(t);
            // Thin at both ends.
            let taper = (8.0 * t).min(8.0 * (1.0 - t)).clamp(0.0, 1.0).sqrt();
            self.dab(u * side, v * side, 0.5 * tool.width_px * (0.35 + 0.65 * taper), stroke, tool);
        }
    }

    /// Draws a round dab of ink, wrapped around the rims of the tile.
    fn dab(&mut self, x: f64, y: f64, radius: f64, stroke: &Stroke, tool: &Tool) {
        #[expect(clippy::cast_possible_truncation, reason = "texels around a dab")]
        let range =
            |at: f64| ((at - radius - 1.0).floor() as i64, (at + radius + 1.0).ceil() as i64);
        let ((left, right), (top, bottom)) = (range(x), range(y));
        for row in top..=bottom {
            for column in left..=right {
                let (dx, dy) = (column as f64 + 0.5 - x, row as f64 + 0.5 - y);
                let inside = (radius + 0.5 - (dx * dx + dy * dy).sqrt()).clamp(0.0, 1.0);
                let (column, row) = (wrapped(column, self.side), wrapped(row, self.side));
                let grain = 1.0 - tool.grain * self.grain(column, row, tool.seed + stroke.tooth);
                let texel = &mut self.ink[(row * self.side + column) as usize];
                *texel = texel.max(inside * stroke.ink * grain);
            }
        }
    }

    /// How much the tooth of the paper repels ink, 0 to 1.
    fn grain(&self, column: u32, row: u32, seed: u32) -> f64 {
        let chance = hash(column, row, seed + self.side);
        let [u, v] = [column, row].map(|at| f64::from(at) / f64::from(self.side));
        let soft = noise(u, v, (self.side / 3).max(2), seed + 1);
        (chance * soft * 2.2).min(1.0)
    }
}

/// A place of a tile that repeats.
fn wrapped(at: i64, side: u32) -> u32 {
    u32::try_from(at.rem_euclid(i64::from(side))).unwrap_or_default()
}

impl Stroke {
    /// A random stroke.
    fn by_chance(number: u32, is_across: bool, seed: u32) -> Self {
        let at = |what: u32| hash(number, what, seed);
        Self {
            u: at(0),
            v: at(1),
            length: 0.3 + 0.55 * at(2),
            slant: 0.06 * (at(3) - 0.5),
            bow: 0.012 * (at(4) - 0.5),
            is_across,
            ink: 0.82 + 0.18 * at(5),
            tooth: number % 5 * 7,
        }
    }

    /// The place of a part of it.
    fn place(&self, t: f64) -> (f64, f64) {
        let along = self.length * (t - 0.5);
        let beside = self.slant * along + self.bow * 4.0 * t * (1.0 - t);
        match self.is_across {
            true => (self.u + beside, self.v + along),
            false => (self.u + along, self.v + beside),
        }
    }
}

/// The density of the strokes of one direction.
struct Density {
    cells: Vec<f64>,
    /// The reach of a stroke, in cells.
    reach: i64,
}

impl Density {
    fn new(side: u32) -> Self {
        // At least a texel of the sheet.
        let reach = i64::from((GRID * 4 / side).clamp(2, 12));
        Self { cells: vec![0.0; (GRID * GRID) as usize], reach }
    }

    fn cells_of(stroke: &Stroke) -> impl Iterator<Item = (i64, i64)> {
        let stroke = *stroke;
        (0..=32).map(move |step| {
            let (u, v) = stroke.place(f64::from(step) / 32.0);
            #[expect(clippy::cast_possible_truncation, reason = "cells of a grid")]
            let cell = |at: f64| (at * f64::from(GRID)).floor() as i64;
            (cell(u), cell(v))
        })
    }

    fn index(column: i64, row: i64) -> usize {
        (wrapped(row, GRID) * GRID + wrapped(column, GRID)) as usize
    }

    fn add(&mut self, stroke: &Stroke) {
        for (column, row) in Self::cells_of(stroke) {
            for away in -self.reach..=self.reach {
                let weight = 1.0 / (1.0 + (away * away) as f64);
                let (column, row) = match stroke.is_across {
                    true => (column + away, row),
                    false => (column, row + away),
                };
                self.cells[Self::index(column, row)] += weight;
            }
        }
    }

    fn along(&self, stroke: &Stroke) -> f64 {
        Self::cells_of(stroke).map(|(c, r)| self.cells[Self::index(c, r)]).sum()
    }
}

/// All levels, the largest first, each with its tones.
fn levels(tool: &Tool) -> Vec<Vec<Sheet>> {
    let mut strokes: Vec<Vec<Stroke>> = vec![Vec::new(); TONES];
    let mut number = 0;
    let mut levels = Vec::new();
    let mut side = LEAST_SIDE;
    while side <= SIDE {
        levels.push(tones(tool, side, &mut strokes, &mut number));
        side *= 2;
    }
    levels.reverse();
    let means: Vec<f64> = levels[levels.len() - 1].iter().map(Sheet::mean).collect();
    let mut side = LEAST_SIDE / 2;
    while side > 0 {
        levels.push(means.iter().map(|&mean| Sheet::even(side, mean)).collect());
        side /= 2;
    }
    levels
}

/// The tones of a level: the strokes so far, and more until each is dark enough.
fn tones(tool: &Tool, side: u32, strokes: &mut [Vec<Stroke>], number: &mut u32) -> Vec<Sheet> {
    let mut sheets: Vec<Sheet> = Vec::new();
    let mut densities = [Density::new(side), Density::new(side)];
    let mut sheet = Sheet::new(side);
    for (tone, strokes) in strokes.iter_mut().enumerate() {
        // Darker tones have the strokes of this one, which are in the sheet already.
        for stroke in strokes.iter() {
            sheet.draw(stroke, tool);
            densities[usize::from(stroke.is_across)].add(stroke);
        }
        let mut tries = 0;
        while sheet.mean() < target(tone) && tries < 1500 {
            tries += 1;
            let is_across = tone >= 3 && !(*number).is_multiple_of(4);
            let density = &densities[usize::from(is_across)];
            let candidates = (0..CANDIDATES).map(|_| {
                *number += 1;
                Stroke::by_chance(*number, is_across, tool.seed)
            });
            let score = |stroke: &Stroke| density.along(stroke) / (0.4 + stroke.length);
            let best = candidates.min_by(|a, b| score(a).total_cmp(&score(b)));
            let Some(best) = best else { break };
            densities[usize::from(is_across)].add(&best);
            sheet.draw(&best, tool);
            strokes.push(best);
            *number += 1;
        }
        sheets.push(sheet.clone());
    }
    sheets
}

/// Three tones of all levels in one picture.
fn atlas(levels: &[Vec<Sheet>], first: usize) -> RgbImage {
    let mut picture = RgbImage::from_pixel(SIDE + SIDE / 2, SIDE, Rgb([255; 3]));
    let (mut left, mut top) = (0, 0);
    for (at, level) in levels.iter().enumerate() {
        let side = level[0].side;
        for (row, column) in (0..side).flat_map(|row| (0..side).map(move |column| (row, column))) {
            let ink = |tone: usize| level[first + tone].ink[(row * side + column) as usize];
            // Few grays make a small file and are enough for ink.
            let color = [0, 1, 2].map(|tone| to_byte(1.0 - (ink(tone) * 24.0).round() / 24.0));
            picture.put_pixel(left + column, top + row, Rgb(color));
        }
        if at == 0 {
            left = side;
        } else {
            top += side;
        }
    }
    picture
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strokes_are_nested_in_tones_and_in_levels() {
        for tool in &TOOLS {
            let levels = levels(tool);
            for level in &levels {
                for pair in level.windows(2) {
                    let is_nested = pair[0].ink.iter().zip(&pair[1].ink).all(|(a, b)| a <= b);
                    assert!(is_nested, "{}: a darker tone has all ink of a lighter one", tool.name);
                }
            }
            for (fine, coarse) in levels.iter().zip(&levels[1..]) {
                let side = coarse[0].side;
                if side < LEAST_SIDE {
                    continue;
                }
                for tone in 0..TONES {
                    let dark = |sheet: &Sheet, x: u32, y: u32| {
                        sheet.ink[((y % sheet.side) * sheet.side + x % sheet.side) as usize] > 0.3
                    };
                    let mut lost = 0;
                    for (x, y) in (0..side).flat_map(|y| (0..side).map(move |x| (x, y))) {
                        // Its strokes are half as wide there, within two texels.
                        let near = (0..6).flat_map(|dy| (0..6).map(move |dx| (dx, dy)));
                        let mut near = near
                            .map(|(dx, dy)| (2 * x + 2 * side - 2 + dx, 2 * y + 2 * side - 2 + dy));
                        let is_kept = near.any(|(x, y)| dark(&fine[tone], x, y));
                        lost += usize::from(dark(&coarse[tone], x, y) && !is_kept);
                    }
                    assert_eq!(lost, 0, "{}: tone {tone} at {side}", tool.name);
                }
            }
        }
    }

    #[test]
    fn tones_grow_dark_evenly_at_every_level() {
        for tool in &TOOLS {
            for level in levels(tool) {
                for (tone, sheet) in level.iter().enumerate() {
                    let (mean, wanted) = (sheet.mean(), target(tone));
                    let what = format!("{} {} tone {tone}: {mean:.3}", tool.name, sheet.side);
                    assert!((mean - wanted).abs() < 0.12, "{what}, not {wanted:.3}");
                }
            }
        }
    }
}
