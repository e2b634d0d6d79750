//! Golden images: compares a picture with one that a person has approved.
//!
//! Two numbers measure the difference of two pictures:
//!
//! 1. `wrong_pixels`: the pixels with a channel that differs by more than a tolerance.
//! 2. `ink_distance_px`: the largest distance from ink in one picture to the nearest
//!    ink in the other, both ways (the Hausdorff distance). It measures line art as
//!    the eye does: all strokes may move a little, but a lost stroke counts by its
//!    distance from the other strokes.
//!
//! ```text
//!    golden   picture
//!    |   |    |   .      the stroke on the right is lost: few pixels are wrong,
//!    |   |    |   .      but its ink is 4 px from any other
//! ```
//!
//! Rejected: a mean over the picture (FLIP, SSIM), which hides a line 1 px wide;
//! ignoring antialiased pixels, since thin strokes consist mostly of them.

use std::path::{Path, PathBuf};
use std::{env, fs};

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder as _, Rgba, RgbaImage};

use crate::locate::tests_root;

/// The largest width and height of a golden in pixels: larger ones show nothing more
/// and fill the repository.
pub const MAX_GOLDEN_SIDE_PX: u32 = 256;

/// The largest file of a golden in bytes.
pub const MAX_GOLDEN_BYTES: usize = 64 << 10;

/// Ink has a luminance below this.
const INK_LUMINANCE: u32 = 128;

/// The difference of two pictures of one size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Difference {
    /// The pixels with a channel that differs by more than the tolerance.
    pub wrong_pixels: usize,
    /// The largest distance from ink in one picture to ink in the other;
    /// infinite if only one of them has ink.
    pub ink_distance_px: f64,
}

/// The bounds of a picture's difference from its golden. Only [`Golden::lines`] and
/// [`Golden::shaded`] make one, so that no test invents its own bounds.
#[derive(Debug, Clone, Copy)]
pub struct Golden {
    tolerance: u8,
    wrong_pixels: WrongPixels,
    ink_distance_px: f64,
}

/// The largest number of wrong pixels.
#[derive(Debug, Clone, Copy)]
enum WrongPixels {
    Count(usize),
    PerMyriad(usize),
}

/// Strokes on the pinned software driver (owner: the stroke passes). The same
/// driver draws the same bytes but for the rounding of the CPU, which flips a few
/// samples. More would hide a stroke's missing cap.
const LINES_PINNED: Golden =
    Golden { tolerance: 2, wrong_pixels: WrongPixels::Count(10), ink_distance_px: 1.0 };

/// Strokes on any other adapter (owner: the stroke passes). Sample positions and
/// rounding differ, so the rim of a stroke may move by a pixel's diagonal. More
/// would hide a stroke on the wrong side of its edge.
const LINES_ANYWHERE: Golden =
    Golden { tolerance: 16, wrong_pixels: WrongPixels::PerMyriad(4), ink_distance_px: 1.5 };

/// Fills and image passes on the pinned software driver (owner: the fill
/// passes). As for strokes; more would hide a shading band that moved.
const SHADED_PINNED: Golden =
    Golden { tolerance: 2, wrong_pixels: WrongPixels::Count(10), ink_distance_px: 1.0 };

/// Fills and image passes on any other adapter (owner: the fill passes).
/// Interpolation and texture filtering differ in the last bits. More would hide
/// a wrong light or a texture that lost its top level.
const SHADED_ANYWHERE: Golden =
    Golden { tolerance: 16, wrong_pixels: WrongPixels::PerMyriad(4), ink_distance_px: 1.5 };

impl Golden {
    /// For pictures of strokes.
    #[must_use]
    pub const fn lines(is_pinned_driver: bool) -> Self {
        if is_pinned_driver { LINES_PINNED } else { LINES_ANYWHERE }
    }

    /// For pictures with shading, textures or image passes.
    #[must_use]
    pub const fn shaded(is_pinned_driver: bool) -> Self {
        if is_pinned_driver { SHADED_PINNED } else { SHADED_ANYWHERE }
    }

    /// Compares `picture` with `golden/NAME.png`. If the environment has
    /// `UPDATE_GOLDEN=NAME` (names separated by commas, or `all`), writes the golden
    /// instead.
    ///
    /// # Panics
    /// If the golden is missing or too large, or the picture differs too much; then
    /// `NAME.new.png` and `NAME.diff.png` lie beside the golden.
    pub fn check(&self, name: &str, picture: &RgbaImage) {
        let folder = tests_root().join("golden");
        let wanted = env::var("UPDATE_GOLDEN").unwrap_or_default();
        let is_update = wanted.split(',').any(|word| word == name || word == "all");
        let result = if is_update {
            update_golden(&folder, name, picture)
        } else {
            self.compare_in(&folder, name, picture)
        };
        if let Err(message) = result {
            panic!("{message}");
        }
    }

    fn compare_in(&self, folder: &Path, name: &str, picture: &RgbaImage) -> Result<(), String> {
        let paths = Paths::of(folder, name);
        let golden = match load_golden(&paths.golden) {
            Ok(golden) => golden,
            Err(why) => {
                save(&paths.new, picture)?;
                return Err(format!(
                    "{why}; look at {}, and if it is right run again with UPDATE_GOLDEN={name}",
                    paths.new.display()
                ));
            }
        };
        match self.judge(&golden, picture) {
            Ok(()) => {
                paths.remove_traces();
                Ok(())
            }
            Err(why) => {
                save(&paths.new, picture)?;
                save(&paths.diff, &difference_image(&golden, picture, self.tolerance))?;
                Err(format!(
                    "{name}: {why}\n  golden: {}\n  now:    {}\n  differences: {}",
                    paths.golden.display(),
                    paths.new.display(),
                    paths.diff.display()
                ))
            }
        }
    }

    /// Describes a difference beyond the bounds.
    fn judge(&self, golden: &RgbaImage, picture: &RgbaImage) -> Result<(), String> {
        if golden.dimensions() != picture.dimensions() {
            let (expected, got) = (golden.dimensions(), picture.dimensions());
            return Err(format!("the size is {got:?}, that of the golden {expected:?}"));
        }
        let found = difference(golden, picture, self.tolerance);
        let limit = match self.wrong_pixels {
            WrongPixels::Count(count) => count,
            WrongPixels::PerMyriad(share) => golden.pixels().len() * share / 10_000,
        };
        if found.wrong_pixels <= limit && found.ink_distance_px <= self.ink_distance_px {
            return Ok(());
        }
        Err(format!(
            "{} pixels differ by more than {} (at most {limit} may), ink lies up to {:.2} px \
             from ink (at most {:.2} px)",
            found.wrong_pixels, self.tolerance, found.ink_distance_px, self.ink_distance_px
        ))
    }
}

/// The files of a golden and of a failed comparison.
struct Paths {
    golden: PathBuf,
    new: PathBuf,
    diff: PathBuf,
}

impl Paths {
    fn of(folder: &Path, name: &str) -> Self {
        Self {
            golden: folder.join(format!("{name}.png")),
            new: folder.join(format!("{name}.new.png")),
            diff: folder.join(format!("{name}.diff.png")),
        }
    }

    /// Removes the files of an earlier failure, if any.
    fn remove_traces(&self) {
        let _ = fs::remove_file(&self.new);
        let _ = fs::remove_file(&self.diff);
    }
}

/// Compares two pictures of the same size.
///
/// # Panics
/// If the sizes differ.
#[must_use]
pub fn difference(golden: &RgbaImage, picture: &RgbaImage, tolerance: u8) -> Difference {
    assert_eq!(golden.dimensions(), picture.dimensions(), "pictures of different sizes");
    let pairs = golden.pixels().zip(picture.pixels());
    Difference {
        wrong_pixels: pairs.filter(|(a, b)| differs(a, b, tolerance)).count(),
        ink_distance_px: ink_distance_px(golden, picture),
    }
}

fn differs(a: &Rgba<u8>, b: &Rgba<u8>, tolerance: u8) -> bool {
    a.0.iter().zip(b.0).any(|(&a, b)| a.abs_diff(b) > tolerance)
}

fn ink_distance_px(a: &RgbaImage, b: &RgbaImage) -> f64 {
    let (a, b) = (InkMask::of(a), InkMask::of(b));
    a.farthest_from(&b).max(b.farthest_from(&a))
}

/// The pixels that are ink, row by row.
struct InkMask {
    width: usize,
    is_ink: Vec<bool>,
}

impl InkMask {
    fn of(picture: &RgbaImage) -> Self {
        Self { width: picture.width() as usize, is_ink: picture.pixels().map(is_ink).collect() }
    }

    /// The largest distance from ink here to the nearest ink in `other`.
    ///
    /// Exact: the nearest ink in each column, then the nearest of all columns.
    fn farthest_from(&self, other: &Self) -> f64 {
        let column_distance = other.distances_in_columns();
        let inked = (0..self.is_ink.len()).filter(|&at| self.is_ink[at]);
        let squared = inked.map(|at| {
            let (x, row) = (at % self.width, at - at % self.width);
            (0..self.width)
                .map(|column| squared_length(column.abs_diff(x), column_distance[row + column]))
                .fold(f64::INFINITY, f64::min)
        });
        squared.fold(0.0, f64::max).sqrt()
    }

    /// The distance of each pixel from the nearest ink in its column.
    fn distances_in_columns(&self) -> Vec<Option<usize>> {
        let mut distance = vec![None; self.is_ink.len()];
        let height = self.is_ink.len() / self.width.max(1);
        for column in 0..self.width {
            let downwards: Vec<usize> = (0..height).map(|y| y * self.width + column).collect();
            for pixels in [downwards.clone(), downwards.into_iter().rev().collect()] {
                let mut since_ink = None;
                for at in pixels {
                    since_ink =
                        if self.is_ink[at] { Some(0) } else { since_ink.map(|steps| steps + 1) };
                    distance[at] = [distance[at], since_ink].into_iter().flatten().min();
                }
            }
        }
        distance
    }
}

fn squared_length(across: usize, along: Option<usize>) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "pictures are far smaller than 2^26 pixels")]
    along.map_or(f64::INFINITY, |along| (across * across + along * along) as f64)
}

/// Whether a pixel over white paper is dark, by the luma weights of Rec. 709.
fn is_ink(pixel: &Rgba<u8>) -> bool {
    let [r, g, b, a] = pixel.0.map(u32::from);
    let over_white = |channel: u32| (channel * a + 255 * (255 - a)) / 255;
    let luminance = (2126 * over_white(r) + 7152 * over_white(g) + 722 * over_white(b)) / 10_000;
    luminance < INK_LUMINANCE
}

/// The wrong pixels in red over the faded golden.
fn difference_image(golden: &RgbaImage, picture: &RgbaImage, tolerance: u8) -> RgbaImage {
    let (width, height) = golden.dimensions();
    RgbaImage::from_fn(width.max(picture.width()), height.max(picture.height()), |x, y| {
        match (golden.get_pixel_checked(x, y), picture.get_pixel_checked(x, y)) {
            (Some(a), Some(b)) if !differs(a, b, tolerance) => {
                let [r, g, b, _] = a.0.map(|channel| 192 + channel / 4);
                Rgba([r, g, b, 255])
            }
            _ => Rgba([255, 0, 0, 255]),
        }
    })
}

fn load_golden(path: &Path) -> Result<RgbaImage, String> {
    let bytes = fs::read(path).map_err(|error| format!("{}: {error}", path.display()))?;
    let picture = image::load_from_memory(&bytes)
        .map_err(|error| format!("{}: {error}", path.display()))?
        .to_rgba8();
    check_limits(path, &picture, bytes.len())?;
    Ok(picture)
}

fn update_golden(folder: &Path, name: &str, picture: &RgbaImage) -> Result<(), String> {
    let paths = Paths::of(folder, name);
    check_limits(&paths.golden, picture, encode(picture)?.len())?;
    save(&paths.golden, picture)?;
    paths.remove_traces();
    eprintln!("{}: updated; look at it before you commit it", paths.golden.display());
    Ok(())
}

fn check_limits(path: &Path, picture: &RgbaImage, bytes: usize) -> Result<(), String> {
    let (width, height) = picture.dimensions();
    if width.max(height) > MAX_GOLDEN_SIDE_PX || bytes > MAX_GOLDEN_BYTES {
        return Err(format!(
            "{}: {width} x {height} pixels, {bytes} bytes: a golden has at most \
             {MAX_GOLDEN_SIDE_PX} x {MAX_GOLDEN_SIDE_PX} and {MAX_GOLDEN_BYTES}",
            path.display()
        ));
    }
    Ok(())
}

fn encode(picture: &RgbaImage) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let (width, height) = picture.dimensions();
    PngEncoder::new_with_quality(&mut bytes, CompressionType::Best, FilterType::Adaptive)
        .write_image(picture.as_raw(), width, height, ExtendedColorType::Rgba8)
        .map_err(|error| error.to_string())?;
    Ok(bytes)
}

fn save(path: &Path, picture: &RgbaImage) -> Result<(), String> {
    let written = match path.parent() {
        Some(folder) => fs::create_dir_all(folder),
        None => Ok(()),
    };
    let bytes = encode(picture)?;
    written
        .and_then(|()| fs::write(path, bytes))
        .map_err(|error| format!("cannot write {}: {error}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    const BLACK: [u8; 4] = [0, 0, 0, 255];
    const RED: [u8; 4] = [200, 0, 0, 255];
    const BLUE: [u8; 4] = [0, 0, 200, 255];

    fn every_kind() -> [Golden; 4] {
        [true, false]
            .map(|pinned| [Golden::lines(pinned), Golden::shaded(pinned)])
            .concat()
            .try_into()
            .unwrap()
    }

    /// White paper with strokes: x, y, width, height, color.
    fn drawing(strokes: &[(u32, u32, u32, u32, [u8; 4])]) -> RgbaImage {
        let mut picture = RgbaImage::from_pixel(256, 256, Rgba([255; 4]));
        for &(left, top, width, height, color) in strokes {
            for (x, y) in
                (top..top + height).flat_map(|y| (left..left + width).map(move |x| (x, y)))
            {
                picture.put_pixel(x, y, Rgba(color));
            }
        }
        picture
    }

    fn passes(golden: &RgbaImage, picture: &RgbaImage) -> [bool; 4] {
        every_kind().map(|kind| kind.judge(golden, picture).is_ok())
    }

    #[test]
    fn the_same_picture_and_noise_of_one_level_pass() {
        let golden = drawing(&[(20, 20, 200, 2, BLACK), (40, 60, 2, 150, RED)]);
        assert_eq!(passes(&golden, &golden), [true; 4]);
        let mut noisy = golden.clone();
        for (index, pixel) in noisy.pixels_mut().enumerate() {
            for channel in &mut pixel.0 {
                *channel = if index % 3 == 0 {
                    channel.saturating_sub(1)
                } else {
                    channel.saturating_add(1)
                };
            }
        }
        assert_ne!(noisy, golden);
        assert_eq!(passes(&golden, &noisy), [true; 4]);
    }

    #[test]
    fn a_removed_stroke_fails() {
        let golden = drawing(&[(20, 20, 200, 2, BLACK), (40, 60, 2, 150, BLACK)]);
        let picture = drawing(&[(20, 20, 200, 2, BLACK)]);
        assert_eq!(passes(&golden, &picture), [false; 4]);
        assert_eq!(passes(&picture, &golden), [false; 4], "an added one too");
    }

    #[test]
    fn a_removed_stroke_of_six_pixels_fails_by_its_ink_alone() {
        let golden = drawing(&[(20, 20, 200, 2, BLACK), (40, 30, 2, 3, BLACK)]);
        let picture = drawing(&[(20, 20, 200, 2, BLACK)]);
        let found = difference(&golden, &picture, 2);
        assert_eq!(found, Difference { wrong_pixels: 6, ink_distance_px: 11.0 });
        assert_eq!(passes(&golden, &picture), [false; 4]);
    }

    #[test]
    fn a_shift_of_two_pixels_fails() {
        // So few pixels that only the ink distance fails, and then many.
        for length in [5, 200] {
            let golden = drawing(&[(20, 20, length, 1, BLACK)]);
            let picture = drawing(&[(20, 22, length, 1, BLACK)]);
            assert!((difference(&golden, &picture, 2).ink_distance_px - 2.0).abs() < 1e-12);
            assert_eq!(passes(&golden, &picture), [false; 4]);
        }
    }

    #[test]
    fn two_swapped_colors_fail() {
        let strokes = |a, b| drawing(&[(20, 20, 200, 2, a), (20, 60, 200, 2, b)]);
        let (golden, picture) = (strokes(RED, BLUE), strokes(BLUE, RED));
        assert!(difference(&golden, &picture, 2).ink_distance_px <= 0.0, "both are ink");
        assert_eq!(passes(&golden, &picture), [false; 4]);
    }

    #[test]
    fn ink_distances_are_euclidean_and_infinite_to_nothing() {
        let one = |x, y| drawing(&[(x, y, 1, 1, BLACK)]);
        assert!((ink_distance_px(&one(10, 10), &one(13, 14)) - 5.0).abs() < 1e-12);
        let two = drawing(&[(10, 10, 1, 1, BLACK), (10, 200, 1, 1, BLACK)]);
        assert!((ink_distance_px(&one(10, 10), &two) - 190.0).abs() < 1e-12, "both ways");
        let paper = drawing(&[]);
        assert!(ink_distance_px(&one(0, 0), &paper).is_infinite());
        assert!(ink_distance_px(&paper, &paper) <= 0.0);
        let see_through = drawing(&[(10, 10, 1, 1, [0, 0, 0, 100])]);
        assert!(ink_distance_px(&see_through, &paper) <= 0.0, "over white paper it is light");
    }

    #[test]
    fn a_missing_golden_fails_and_an_update_mends_it() {
        let folder = tempfile::tempdir().unwrap();
        let picture = drawing(&[(20, 20, 200, 2, BLACK)]);
        let golden = Golden::lines(true);
        let message = golden.compare_in(folder.path(), "line", &picture).unwrap_err();
        assert!(message.contains("UPDATE_GOLDEN=line"), "{message}");
        assert!(!folder.path().join("line.png").exists(), "never written by itself");

        update_golden(folder.path(), "line", &picture).unwrap();
        golden.compare_in(folder.path(), "line", &picture).unwrap();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "no traces are left");

        let message = golden.compare_in(folder.path(), "line", &drawing(&[])).unwrap_err();
        for ending in ["new", "diff"] {
            let path = folder.path().join(format!("line.{ending}.png"));
            assert!(path.is_file() && message.contains(path.to_str().unwrap()), "{message}");
        }
        let small = RgbaImage::new(8, 8);
        assert!(golden.compare_in(folder.path(), "line", &small).unwrap_err().contains("(8, 8)"));
    }

    #[test]
    fn goldens_stay_small() {
        let folder = tempfile::tempdir().unwrap();
        let wide = RgbaImage::new(257, 4);
        assert!(update_golden(folder.path(), "wide", &wide).unwrap_err().contains("257 x 4"));
        // A generator of noise, which no compression makes small.
        let mut state = 1_u32;
        let noise = RgbaImage::from_fn(256, 256, |_, _| {
            state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
            Rgba((state ^ (state >> 15)).to_be_bytes())
        });
        assert!(update_golden(folder.path(), "noise", &noise).unwrap_err().contains("at most"));
        fs::write(folder.path().join("noise.png"), encode(&noise).unwrap()).unwrap();
        let golden = Golden::shaded(true);
        assert!(golden.compare_in(folder.path(), "noise", &noise).is_err(), "nor is it read");
    }
}
