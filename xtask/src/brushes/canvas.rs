//! Ink on paper with several samples per pixel, for smooth rims.

use image::{GrayAlphaImage, LumaA};

use super::{INK, to_byte};

/// Samples per pixel along each side.
const SAMPLES: u32 = 4;

/// A point in pixels of the picture, x to the right and y down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Point {
    pub(super) x: f64,
    pub(super) y: f64,
}

impl Point {
    pub(super) fn new(x: f64, y: f64) -> Self {
        Self { x, y }
    }

    pub(super) fn mix(self, other: Self, part: f64) -> Self {
        Self::new(self.x + (other.x - self.x) * part, self.y + (other.y - self.y) * part)
    }
}

/// A sheet of paper; ink beyond its sides is cut off.
#[derive(Debug)]
pub(super) struct Canvas {
    width: u32,
    height: u32,
    /// Whether there is ink, sample by sample and row by row.
    ink: Vec<bool>,
}

impl Canvas {
    pub(super) fn new(width_px: u32, height_px: u32) -> Self {
        let (width, height) = (width_px * SAMPLES, height_px * SAMPLES);
        Self { width, height, ink: vec![false; width as usize * height as usize] }
    }

    /// Wipes all ink off a polygon.
    pub(super) fn wipe(&mut self, outline: &[Point]) {
        let next = outline.iter().cycle().skip(1);
        let sides: Vec<(Point, Point)> = outline.iter().copied().zip(next.copied()).collect();
        self.set(outline, 0.0, false, |at| {
            let crosses = |&&(a, b): &&(Point, Point)| {
                (a.y > at.y) != (b.y > at.y)
                    && at.x < a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x)
            };
            sides.iter().filter(crosses).count() % 2 == 1
        });
    }

    /// Draws a line along points; its radius changes linearly from `start_px` to `end_px`.
    pub(super) fn line(&mut self, points: &[Point], start_px: f64, end_px: f64) {
        let count = (points.len().max(2) - 1) as f64;
        for (index, pair) in points.windows(2).enumerate() {
            let radius = |index: usize| start_px + (end_px - start_px) * (index as f64 / count);
            let (from_px, to_px) = (radius(index), radius(index + 1));
            self.set(pair, from_px.max(to_px), true, |at| {
                let (distance, along) = distance_to_segment(at, pair[0], pair[1]);
                distance <= from_px + (to_px - from_px) * along
            });
        }
    }

    /// Fills from a line along the top, given by its height at each x, down to
    /// `bottom_px`.
    pub(super) fn band(&mut self, top_px: impl Fn(f64) -> f64, bottom_px: f64) {
        let width_px = f64::from(self.width / SAMPLES);
        let corners = [Point::new(0.0, 0.0), Point::new(width_px, bottom_px)];
        self.set(&corners, 0.0, true, |at| at.y >= top_px(at.x) && at.y < bottom_px);
    }

    /// Sets the samples near some points for which `inside` holds.
    fn set(&mut self, near: &[Point], by_px: f64, ink: bool, inside: impl Fn(Point) -> bool) {
        let columns = samples(near.iter().map(|point| point.x), by_px, self.width);
        let rows = samples(near.iter().map(|point| point.y), by_px, self.height);
        for row in rows {
            for column in columns.clone() {
                let center = |index: u32| (f64::from(index) + 0.5) / f64::from(SAMPLES);
                if inside(Point::new(center(column), center(row))) {
                    self.ink[(row * self.width + column) as usize] = ink;
                }
            }
        }
    }

    /// The picture; alpha is the share of a pixel's samples that have ink.
    pub(super) fn picture(&self) -> GrayAlphaImage {
        GrayAlphaImage::from_fn(self.width / SAMPLES, self.height / SAMPLES, |x, y| {
            let rows = y * SAMPLES..(y + 1) * SAMPLES;
            let inked: usize = rows
                .map(|row| {
                    let start = (row * self.width + x * SAMPLES) as usize;
                    let samples = &self.ink[start..start + SAMPLES as usize];
                    samples.iter().filter(|&&ink| ink).count()
                })
                .sum();
            LumaA([INK, to_byte(inked as f64 / f64::from(SAMPLES * SAMPLES))])
        })
    }
}

/// The samples between the smallest and the largest place, and some pixels more.
fn samples(places: impl Iterator<Item = f64>, by_px: f64, count: u32) -> std::ops::Range<u32> {
    let (low, high) =
        places.fold((f64::MAX, f64::MIN), |(low, high), at| (low.min(at), high.max(at)));
    let sample = |at_px: f64| {
        #[expect(clippy::cast_possible_truncation, reason = "clamped to the canvas")]
        let index = (at_px * f64::from(SAMPLES)).clamp(0.0, f64::from(count)) as u32;
        index
    };
    sample(low - by_px)..sample(high + by_px + 1.0)
}

/// The distance of a point from a segment, and the nearest place on it, from 0 to 1.
fn distance_to_segment(at: Point, from: Point, to: Point) -> (f64, f64) {
    let (dx, dy) = (to.x - from.x, to.y - from.y);
    let square = dx * dx + dy * dy;
    let along = ((at.x - from.x) * dx + (at.y - from.y) * dy) / square.max(1e-9);
    let along = along.clamp(0.0, 1.0);
    let (ex, ey) = (at.x - from.x - dx * along, at.y - from.y - dy * along);
    ((ex * ex + ey * ey).sqrt(), along)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_leaves_its_width_and_a_wiped_square_is_paper() {
        let mut canvas = Canvas::new(16, 16);
        canvas.line(&[Point::new(-4.0, 8.0), Point::new(20.0, 8.0)], 2.0, 2.0);
        let column = |canvas: &Canvas| -> Vec<u8> {
            let picture = canvas.picture();
            (0..16).map(|y| picture.get_pixel(8, y).0[1]).collect()
        };
        let drawn = column(&canvas);
        assert_eq!(drawn[5..11], [0, 255, 255, 255, 255, 0]);
        let square = [(0.0, 0.0), (16.0, 0.0), (16.0, 7.5), (0.0, 7.5)];
        canvas.wipe(&square.map(|(x, y)| Point::new(x, y)));
        assert_eq!(column(&canvas)[5..11], [0, 0, 128, 255, 255, 0]);
    }
}
