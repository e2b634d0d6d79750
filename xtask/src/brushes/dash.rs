//! A plain dash with round ends, for dashed lines.
//!
//! It is solid up to both rims, like a stroke without a brush, so that its rims are those
//! of the quad.
//!
//! ```text
//!   v = 0    ___________
//!           /           \
//!          (             )          empty up to the next dash
//!   v = 1   \___________/
//! ```

use image::GrayAlphaImage;

use super::noise::smooth_step;
use super::paint;

const WIDTH_PX: u32 = 512;
const HEIGHT_PX: u32 = 64;
/// The fraction of the length that is drawn, including the round ends.
const PART_ON: f64 = 0.6;

pub(super) fn picture() -> GrayAlphaImage {
    paint(WIDTH_PX, HEIGHT_PX, 1, coverage)
}

/// Everything within half a height of the middle line of the dash. The dash lies in the
/// middle of the picture, so that the seam lies in the gap.
fn coverage(u: f64, v: f64) -> f64 {
    let (width_px, height_px) = (f64::from(WIDTH_PX), f64::from(HEIGHT_PX));
    // Half a pixel more than half the height, so that the first and the last row
    // are solid.
    let radius_px = 0.5 * height_px + 0.5;
    let half_line_px = 0.5 * PART_ON * width_px - radius_px;
    let past_line_px = ((u - 0.5).abs() * width_px - half_line_px).max(0.0);
    let off_line_px = (v - 0.5) * height_px;
    let distance_px = (past_line_px * past_line_px + off_line_px * off_line_px).sqrt();
    smooth_step(-0.75, 0.75, radius_px - distance_px)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_dash_is_on_for_its_part_of_the_length() {
        let dash = picture();
        let row: Vec<u8> = (0..WIDTH_PX).map(|x| dash.get_pixel(x, HEIGHT_PX / 2).0[1]).collect();
        let on: f64 = row.iter().map(|&alpha| f64::from(alpha) / 255.0).sum();
        let wanted = PART_ON * f64::from(WIDTH_PX);
        assert!((on - wanted).abs() < 1.0, "on for {on} of {wanted} pixels");
        assert_eq!(dash.get_pixel(WIDTH_PX / 2, 0).0[1], 255, "solid up to the rim");
        assert_eq!((row[0], row[row.len() - 1]), (0, 0), "the seam lies in the gap");
    }
}
