//! Tiles: parts of a picture that is too large for one texture, drawn one by one.
//!
//! The clip space of a tile is a cut of that of the whole picture. Lengths in pixels are the
//! same in both; places are counted from the middle of the tile. Lines that leave the tile are
//! clipped where the whole picture clips them, so strokes begin, end and measure their length
//! alike in all tiles.

use edgemesh::view::{GUARD_BAND, View};
use glam::{DMat4, DVec2, Vec2};

/// A tile of a picture, or the whole. Sizes must not be zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tile {
    /// Size of the whole picture.
    pub picture_px: Vec2,
    /// The upper left corner of the tile, from that of the picture.
    pub corner_px: Vec2,
    /// Size of the tile.
    pub size_px: Vec2,
}

impl Tile {
    /// The whole picture as one tile.
    #[must_use]
    pub const fn whole(picture_px: Vec2) -> Self {
        Self { picture_px, corner_px: Vec2::ZERO, size_px: picture_px }
    }

    /// The view of the tile, if `view` sees the whole picture.
    pub(crate) fn view(&self, view: &View) -> View {
        if self.size_px == self.picture_px {
            return *view;
        }
        let (scale, middle) = (self.scale(), self.middle());
        // Moves the middle of the tile to 0, and enlarges the tile to the whole clip space.
        let mut tile_from_whole = DMat4::from_diagonal(scale.extend(1.0).extend(1.0));
        tile_from_whole.w_axis = (-scale * middle).extend(0.0).extend(1.0);
        let clip_from_world = tile_from_whole * view.clip_from_world.as_dmat4();
        View { clip_from_world: clip_from_world.as_mat4(), ..*view }
    }

    /// Where edges are clipped: left, right, bottom and top, in the clip space of the tile at
    /// w = 1.
    pub(crate) fn guard_band(&self) -> [f32; 4] {
        let (scale, middle) = (self.scale(), self.middle());
        let side = |axis: usize, side: f32| {
            #[expect(clippy::cast_possible_truncation, reason = "as the shader has it")]
            let side = ((f64::from(side) - middle[axis]) * scale[axis]) as f32;
            side
        };
        [side(0, -GUARD_BAND), side(0, GUARD_BAND), side(1, -GUARD_BAND), side(1, GUARD_BAND)]
    }

    /// By how much the tile's clip space enlarges that of the whole.
    fn scale(&self) -> DVec2 {
        self.picture_px.as_dvec2() / self.size_px.as_dvec2()
    }

    /// The middle of the tile in the clip space of the whole, at w = 1.
    fn middle(&self) -> DVec2 {
        let picture = self.picture_px.as_dvec2();
        let middle_px = self.corner_px.as_dvec2() + self.size_px.as_dvec2() / 2.0;
        (2.0 * middle_px / picture - 1.0) * DVec2::new(1.0, -1.0)
    }

    /// The middle of the tile, in pixels from the middle of the picture, y up.
    pub(crate) fn middle_px(&self) -> Vec2 {
        let from_corner = self.corner_px + (self.size_px - self.picture_px) / 2.0;
        from_corner * Vec2::new(1.0, -1.0)
    }
}

#[cfg(test)]
mod tests {
    use edgemesh::edge_mesh::Bounds;
    use edgemesh::view::{Camera, to_pixels};
    use glam::Vec4;

    use super::*;

    const PICTURE_PX: Vec2 = Vec2::new(3000.0, 2000.0);

    #[test]
    fn a_point_is_at_the_same_pixel_in_the_part_and_in_the_whole() {
        let bounds = Bounds { min: [-1.0, -2.0, -3.0], max: [3.0, 2.0, 1.0] };
        let part = Tile {
            picture_px: PICTURE_PX,
            corner_px: Vec2::new(1024.0, 640.0),
            size_px: Vec2::new(700.0, 900.0),
        };
        for is_orthographic in [false, true] {
            let camera = Camera { is_orthographic, ..Camera::default_view(&bounds) };
            let whole = camera.view(&bounds, 1.5);
            let seen = part.view(&whole);
            for point in [Vec4::W, Vec4::new(2.0, -1.0, -2.5, 1.0)] {
                let want = to_pixels(whole.clip_from_world * point, PICTURE_PX);
                let got = to_pixels(seen.clip_from_world * point, part.size_px);
                let got = got + part.middle_px();
                assert!((got - want).length() < 2e-3, "{got} for {want}");
            }
        }
    }

    #[test]
    fn the_whole_is_a_part_that_changes_nothing() {
        let whole = Tile::whole(PICTURE_PX);
        let camera = Camera::default_view(&Bounds::default());
        let view = camera.view(&Bounds::default(), 1.5);
        assert_eq!(whole.view(&view), view);
        assert_eq!(whole.guard_band(), [-GUARD_BAND, GUARD_BAND, -GUARD_BAND, GUARD_BAND]);
        assert_eq!(whole.middle_px(), Vec2::ZERO);
    }

    #[test]
    fn the_guard_band_is_that_of_the_picture() {
        let part =
            Tile { picture_px: PICTURE_PX, corner_px: Vec2::ZERO, size_px: PICTURE_PX / 2.0 };
        // The upper left quarter: its middle is at -0.5, 0.5 of the whole.
        assert_eq!(part.guard_band(), [-7.0, 9.0, -9.0, 7.0]);
    }
}
