//! From clip space to the screen.

use glam::{Vec2, Vec4};

/// The sides of the picture are clipped at this many times its half size: far
/// enough out that no cut end of a stroke can be seen.
pub const GUARD_BAND: f32 = 4.0;

/// The guard band of a whole picture: left, right, bottom and top, at w = 1.
pub const WHOLE_BAND: Vec4 = Vec4::new(-GUARD_BAND, GUARD_BAND, -GUARD_BAND, GUARD_BAND);

/// A clip-space point in front of the eye, in pixels from the middle, y up.
#[must_use]
pub fn to_pixels(clip: Vec4, viewport_px: Vec2) -> Vec2 {
    clip.truncate().truncate() / clip.w * (viewport_px * 0.5)
}
