//! Cartoon fur: tufts of pointed locks, drawn with a pen.
//!
//! Each lock is two curves from the ground to its tip, filled with paper, so that it hides
//! what was drawn before. Locks are drawn from right to left, past both sides of the
//! picture and in the same order everywhere, so that the picture repeats.
//!
//! ```text
//!   v = 0           _-=         tips lean along the stroke
//!               _-=' /    _-=
//!             ,' / ,'_-=,' /
//!            / / //,' // //     some hatches inside
//!   v = 1   =================   the ground
//! ```

use image::GrayAlphaImage;

use super::canvas::{Canvas, Point};
use super::noise::{hash, mix, noise};

const WIDTH_PX: u32 = 512;
const HEIGHT_PX: u32 = 128;

/// The height at which locks begin, and the rim of the line that they stand on.
const GROUND_PX: f64 = 119.0;
const GROUND_END_PX: f64 = 126.5;

const TUFTS: u32 = 4;

/// The locks of a tuft from right to left: place of the foot, width, height and lean, in
/// pixels; a large one in the middle of smaller ones.
const TUFT: [Lock; 5] = [
    Lock { foot_px: 34.0, width_px: 24.0, height_px: 36.0, lean_px: 46.0 },
    Lock { foot_px: 16.0, width_px: 28.0, height_px: 66.0, lean_px: 74.0 },
    Lock { foot_px: -4.0, width_px: 32.0, height_px: 98.0, lean_px: 92.0 },
    Lock { foot_px: -24.0, width_px: 28.0, height_px: 86.0, lean_px: 52.0 },
    Lock { foot_px: -40.0, width_px: 22.0, height_px: 46.0, lean_px: 22.0 },
];

#[derive(Debug, Clone, Copy)]
struct Lock {
    foot_px: f64,
    width_px: f64,
    height_px: f64,
    lean_px: f64,
}

pub(super) fn picture() -> GrayAlphaImage {
    let mut canvas = Canvas::new(WIDTH_PX, HEIGHT_PX);
    // One tuft more on each side than the picture shows, from right to left.
    for place in (0..TUFTS + 2).rev() {
        let start_px = (f64::from(place) - 1.0) * f64::from(WIDTH_PX) / f64::from(TUFTS);
        for (index, lock) in (0..).zip(TUFT) {
            draw(&mut canvas, &varied(lock, place % TUFTS, index), start_px);
        }
    }
    let width_px = f64::from(WIDTH_PX);
    canvas.band(|x| GROUND_PX + 1.5 * noise(x / width_px, 0.0, 23, 5), GROUND_END_PX);
    canvas.picture()
}

/// A lock as a hand draws it, a little different each time.
fn varied(lock: Lock, tuft: u32, index: u32) -> Lock {
    let between = |low: f64, high: f64, seed: u32| mix(low, high, hash(tuft, index, seed));
    // All locks of a tuft grow and lean together.
    let growth = mix(0.72, 1.1, hash(tuft, 0, 91));
    let height_px = lock.height_px * growth * between(0.88, 1.12, 92);
    Lock {
        foot_px: lock.foot_px + between(-4.0, 4.0, 93),
        width_px: lock.width_px * between(0.9, 1.15, 94),
        height_px: height_px.min(GROUND_PX - 6.0),
        lean_px: lock.lean_px * growth * between(0.8, 1.2, 95),
    }
}

fn draw(canvas: &mut Canvas, lock: &Lock, start_px: f64) {
    let x = start_px + lock.foot_px;
    let half_px = 0.5 * lock.width_px;
    let at = |dx: f64, up: f64| Point::new(x + dx, GROUND_PX + 1.0 - up * lock.height_px);
    let lean_px = lock.lean_px;
    let tip = at(lean_px, 0.94);
    let back = [at(-half_px, 0.0), at(-half_px, 0.62), at(0.34 * lean_px, 1.12), tip];
    let front = [at(half_px, 0.0), at(half_px, 0.3), at(0.5 * half_px + 0.36 * lean_px, 0.8), tip];

    let (back_line, front_line) = (curve(&back, 1.0), curve(&front, 1.0));
    let outline: Vec<Point> = back_line.iter().chain(front_line.iter().rev()).copied().collect();
    canvas.wipe(&outline);
    // A narrow lock has room for only one hatch.
    let hatches =
        if lock.width_px < 25.0 { &[(0.6, 0.6)][..] } else { &[(0.36, 0.45), (0.7, 0.66)] };
    for &(part, length) in hatches {
        let hatch: [Point; 4] = std::array::from_fn(|index| back[index].mix(front[index], part));
        canvas.line(&curve(&hatch, length), 1.7, 0.4);
    }
    canvas.line(&back_line, 3.5, 1.5);
    canvas.line(&front_line, 2.4, 1.2);
}

/// Points along the first `length` of a cubic curve, as a fraction.
fn curve(corners: &[Point; 4], length: f64) -> Vec<Point> {
    const STEPS: u32 = 20;
    let [a, b, c, d] = *corners;
    (0..=STEPS)
        .map(|step| {
            let t = length * f64::from(step) / f64::from(STEPS);
            let (ab, bc, cd) = (a.mix(b, t), b.mix(c, t), c.mix(d, t));
            ab.mix(bc, t).mix(bc.mix(cd, t), t)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::mean_of_row;
    use super::*;

    #[test]
    fn hair_thins_out_above_a_solid_ground() {
        let fur = picture();
        let [ground, low, high, top] = [123, 100, 40, 0].map(|y| mean_of_row(&fur, y));
        assert_eq!(ground, 1.0, "the ground is closed");
        assert!(low > high && high > 0.02, "{low} below, {high} above");
        assert!(low < 0.6, "more paper than ink between the strands: {low}");
        assert_eq!(top, 0.0, "no tip is cut off");
    }
}
