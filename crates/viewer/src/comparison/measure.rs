//! Measures of the lines of frames.
//!
//! | measure | meaning |
//! |---|---|
//! | stretch | mean absolute binary logarithm of the length of a repeat, relative to the brush |
//! | breaks | places per 1000 px of line where the brush jumps by more than a sixteenth of itself |
//! | strokes | pieces without a break, per 1000 px of line |
//! | slide | pixels per frame by which the brush moves over the surface, jumps excluded |
//! | pops | pixels of 1000 whose brush jumps by more than a quarter of itself between frames |
//! | changed | pixels of 1000 whose edge is not in the frame before |

use super::samples::{FrameLines, Stretch, Track};

/// The smallest visible jump along a line, in repeats of the brush.
const BREAK: f32 = 1.0 / 16.0;

/// The smallest jump between frames that is not sliding, in repeats of the brush.
const POP: f32 = 0.25;

/// Sums over frames, from which the measures are computed.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Sums {
    /// Length of all lines in pixels.
    pub(crate) length_px: f64,
    breaks: f64,
    strokes: f64,
    stretch: f64,
    tracked_px: f64,
    slid_px: f64,
    held_px: f64,
    popped_px: f64,
    changed_px: f64,
    second_px: f64,
}

/// The distance between two phases of the brush, at most a half.
fn phase_distance(a: f32, b: f32) -> f32 {
    let apart = (a - b).rem_euclid(1.0);
    apart.min(1.0 - apart)
}

impl Sums {
    /// Adds one frame. `texture_px` is the length of the brush in pixels.
    pub(crate) fn add_frame(&mut self, lines: &FrameLines, layer: usize, texture_px: f32) {
        let mut is_joined = false;
        let mut of_layer = lines.stretches.iter().peekable();
        while let Some(stretch) = of_layer.next() {
            let next = of_layer.peek();
            if stretch.layer != layer {
                is_joined = false;
                continue;
            }
            self.length_px += f64::from(stretch.length_px);
            self.strokes += f64::from(u8::from(!is_joined));
            let repeats = (stretch.u[1] - stretch.u[0]).abs() * texture_px;
            if repeats > 0.0 && stretch.length_px > 0.0 {
                let ratio = (repeats / stretch.length_px).log2().abs();
                self.stretch += f64::from(ratio.min(8.0) * stretch.length_px);
            } else {
                self.stretch += f64::from(8.0 * stretch.length_px);
            }
            is_joined = stretch.is_followed;
            if let Some(next) = next.filter(|_| stretch.is_followed) {
                let is_break = is_break(stretch, next);
                self.breaks += f64::from(u8::from(is_break));
                is_joined = !is_break;
            }
        }
    }

    /// Adds the changes between two frames.
    pub(crate) fn add_step(
        &mut self,
        before: &FrameLines,
        lines: &FrameLines,
        layer: usize,
        texture_px: f32,
    ) {
        let mut known = before.tracks.iter().peekable();
        for track in lines.tracks.iter().filter(|track| track.layer == layer) {
            let length_px = f64::from(track.length_px);
            self.second_px += length_px;
            while known.next_if(|other| other.edge < track.edge).is_some() {}
            let same: Option<&&Track> = known.peek().filter(|other| other.edge == track.edge);
            let Some(same) = same else {
                self.changed_px += length_px;
                continue;
            };
            self.tracked_px += length_px;
            let moved = phase_distance(track.u, same.u);
            if moved > POP {
                self.popped_px += length_px;
            } else {
                self.held_px += length_px;
                self.slid_px += length_px * f64::from(moved * texture_px);
            }
        }
    }

    /// Adds the sums of other frames.
    pub(crate) fn add(&mut self, other: &Self) {
        self.length_px += other.length_px;
        self.breaks += other.breaks;
        self.strokes += other.strokes;
        self.stretch += other.stretch;
        self.tracked_px += other.tracked_px;
        self.slid_px += other.slid_px;
        self.held_px += other.held_px;
        self.popped_px += other.popped_px;
        self.changed_px += other.changed_px;
        self.second_px += other.second_px;
    }

    /// Breaks per 1000 px of lines.
    #[must_use]
    pub(crate) fn breaks(&self) -> f64 {
        share(1000.0 * self.breaks, self.length_px)
    }

    /// Pieces without a break, per 1000 px.
    #[must_use]
    pub(crate) fn strokes(&self) -> f64 {
        share(1000.0 * self.strokes, self.length_px)
    }

    /// Mean stretch, in powers of two.
    #[must_use]
    pub(crate) fn stretch(&self) -> f64 {
        share(self.stretch, self.length_px)
    }

    /// Pixels per frame by which the brush slides over the surface.
    #[must_use]
    pub(crate) fn slide(&self) -> f64 {
        share(self.slid_px, self.held_px)
    }

    /// Pixels that jump, of 1000 px that are in both frames.
    #[must_use]
    pub(crate) fn pops(&self) -> f64 {
        share(1000.0 * self.popped_px, self.tracked_px)
    }

    /// Pixels that are new, of 1000 px.
    #[must_use]
    pub(crate) fn changed(&self) -> f64 {
        share(1000.0 * self.changed_px, self.second_px)
    }
}

fn share(part: f64, whole: f64) -> f64 {
    if whole > 0.0 { part / whole } else { 0.0 }
}

/// Whether the brush jumps from one stretch to the next, or changes direction.
fn is_break(stretch: &Stretch, next: &Stretch) -> bool {
    let [run, next_run] = [stretch, next].map(|stretch| stretch.u[1] - stretch.u[0]);
    phase_distance(stretch.u[1], next.u[0]) > BREAK || run * next_run < 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stretch(u: [f32; 2], is_followed: bool) -> Stretch {
        Stretch { length_px: 10.0, u, layer: 0, is_followed }
    }

    fn measured(stretches: Vec<Stretch>) -> Sums {
        let mut sums = Sums::default();
        sums.add_frame(&FrameLines { stretches, tracks: Vec::new() }, 0, 20.0);
        sums
    }

    #[test]
    fn a_whole_line_has_no_break_and_no_stretch() {
        let sums = measured(vec![
            stretch([0.0, 0.5], true),
            stretch([0.5, 1.0], true),
            stretch([0.0, 0.5], false),
        ]);
        assert_eq!((sums.breaks(), sums.stretch()), (0.0, 0.0), "repeats are no breaks");
        assert!((sums.strokes() - 1000.0 / 30.0).abs() < 1e-9, "one stroke of 30 px");
    }

    #[test]
    fn jumps_and_turns_are_breaks() {
        let sums = measured(vec![
            stretch([0.0, 0.5], true),
            stretch([0.7, 1.2], true),
            stretch([1.2, 0.7], false),
        ]);
        assert!((sums.breaks() - 2000.0 / 30.0).abs() < 1e-9, "{}", sums.breaks());
        assert!((sums.strokes() - 3000.0 / 30.0).abs() < 1e-9, "{}", sums.strokes());
    }

    #[test]
    fn a_brush_that_is_twice_too_long_is_stretched_by_one() {
        assert!((measured(vec![stretch([0.0, 0.25], false)]).stretch() - 1.0).abs() < 1e-6);
        assert!((measured(vec![stretch([0.0, 1.0], false)]).stretch() - 1.0).abs() < 1e-6);
    }

    #[test]
    fn what_moves_little_slides_and_what_moves_much_pops() {
        let frame = |us: &[(u32, f32)]| FrameLines {
            stretches: Vec::new(),
            tracks: us
                .iter()
                .map(|&(edge, u)| Track { edge, layer: 0, length_px: 10.0, u })
                .collect(),
        };
        let before = frame(&[(1, 0.1), (2, 0.9), (3, 0.0), (5, 0.0)]);
        let after = frame(&[(1, 0.2), (2, 1.0), (3, 0.5), (4, 0.0)]);
        let mut sums = Sums::default();
        sums.add_step(&before, &after, 0, 20.0);
        assert!((sums.slide() - 2.0).abs() < 1e-5, "{}", sums.slide());
        assert!((sums.pops() - 1000.0 / 3.0).abs() < 1e-9, "one of three");
        assert!((sums.changed() - 250.0).abs() < 1e-9, "one of four");
    }
}
