//! From clip space to the screen.

use glam::{Vec2, Vec4};

/// The distance of the guard band from the middle of the picture, in half sizes of the picture: far
/// enough out that clipped ends of strokes stay invisible.
pub const GUARD_BAND: f32 = 4.0;

/// The guard band of a whole picture: left, right, bottom and top, in clip space at w = 1.
pub const WHOLE_BAND: Vec4 = Vec4::new(-GUARD_BAND, GUARD_BAND, -GUARD_BAND, GUARD_BAND);

/// Converts a point in clip space, in front of the eye, to pixels from the middle of the picture,
/// y up.
#[must_use]
pub fn to_pixels(clip: Vec4, viewport_px: Vec2) -> Vec2 {
    clip.truncate().truncate() / clip.w * (viewport_px * 0.5)
}
